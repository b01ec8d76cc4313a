// Renders the references that the charts compare with: one of each scene.
#include <bit>
#include <cstdio>

#include "common/base/error.h"
#include "common/scene/prepare.h"
#include "tests/measure/measure.h"

namespace {

/// The mean of all runs; how far they lie apart says how sure it is.
Reference make_reference(const NamedMethod& method, Scene& scene, const MeasureOptions& o,
                         const std::string& file, const std::string& command) {
    int spp = o.spp;
    if (spp == 0)  // a power of two
        spp = static_cast<int>(std::bit_floor(
            static_cast<unsigned>(samples_in(o.seconds / o.runs, method, scene, o))));
    Spread spread;
    for (int run = 1; run <= o.runs; run++)
        spread.add(render_once(method, scene, o, spp, static_cast<uint32_t>(run)).film.image());
    double rmse = std::sqrt(spread.mse() / o.runs);
    if (!(rmse < INFINITY)) throw InputError(file + ": error: samples were not finite");
    write_image(file, spread.mean(), command);
    std::printf("%s  %d spp, rmse %.2g\n", file.c_str(), o.runs * spp, rmse);
    std::fflush(stdout);
    return {method.name, o.runs * spp, scene.max_depth, rmse};
}

void write_table(const std::map<std::string, Reference>& references) {
    Table table{{"scene", "method", "spp", "max_depth", "rmse"}, {}};
    for (const auto& [scene, r] : references)
        table.rows.push_back({scene, r.method, std::to_string(r.spp), std::to_string(r.max_depth),
                              short_number(r.rmse)});
    write_file_atomically(reference_table, tab_separated(table));
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "[SCENE...]",
            "Renders the references of the charts, by the methods of the last ones or by the one "
            "that --methods names, in --runs runs that take --seconds together.",
            {.spp = 0,
             .runs = 8,
             .width = 64,
             .height = 64,
             .sampler = SamplerType::sobol,
             .seconds = 60});
        if (o.words.empty()) o.words = own_scenes();
        Work work("references of " + std::to_string(o.words.size()) + " scenes",
                  static_cast<double>(o.words.size()));
        std::map<std::string, Reference> references = read_references();
        for (const std::string& word : o.words) {
            work.next(word);
            Scene scene = load_scene_for(find_scene(word), o);
            std::string name = file_name(scene_name(scene.origin->file));
            Reference& reference = references[name];
            if (!o.methods.empty()) reference.method = o.methods[0];
            NamedMethod method = methods_named({reference.method}).at(0);
            refuse(method, scene);
            reference = make_reference(method, scene, o, reference_folder + name + ".pfm",
                                       command_line(argc, argv));
            write_table(references);
        }
        return 0;
    });
}
