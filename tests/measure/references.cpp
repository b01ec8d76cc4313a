// Renders the references: each of a scene by two methods, in parts with seeds of their own.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/json.h"
#include "common/rendering/film_keeping.h"
#include "tests/measure/measure.h"
#include "tests/measure/reference.h"
#include "tests/support/work.h"

namespace {

std::string part_path(const NamedMethod& method, const Scene& scene, const MeasureOptions& o,
                      int seed) {
    std::filesystem::path name = reference_path(scene_name(scene.file), method.name);
    return o.out + "/" + name.filename().string() + "." + std::to_string(seed) + film_ending;
}

/// One part, from the folder when it was rendered before.
LabeledFilm render_part(const NamedMethod& method, const Scene& scene, const MeasureOptions& o,
                        int seed) {
    RenderOptions options;
    options.name = method.name;
    options.threads = o.threads;
    options.sampler = o.sampler;
    options.seed = static_cast<uint32_t>(seed);
    options.quiet = true;
    options.film = part_path(method, scene, o, seed);
    Rendering r = render(method, scene, options);
    save_film(scene, options, r);
    if (r.stats.interrupted) throw InputError("error: interrupted; run it again to go on");
    return read_film(options.film);
}

/// How many samples a part takes: a power of two, as the parts before it, or what o.seconds allow.
int part_samples(const NamedMethod& method, Scene scene, const MeasureOptions& o, int first_seed) {
    std::string first = part_path(method, scene, o, first_seed);
    if (std::filesystem::exists(first)) return static_cast<int>(read_film(first).film.spp());
    constexpr int trial = 16;
    double seconds = render_once(method, scene, o, trial, 0).stats.seconds / trial;
    return std::max(
        1, static_cast<int>(std::bit_floor(static_cast<unsigned>(o.seconds / o.runs / seconds))));
}

/// The two methods whose references of this scene are there.
std::vector<std::string> made_for(const std::string& scene) {
    std::vector<std::string> names;
    for (const NamedMethod& method : all_methods())
        if (std::filesystem::exists(reference_path(scene, method.name) + ".pfm"))
            names.push_back(method.name);
    if (names.empty())
        throw UsageError("error: " + scene + " has no references; choose two by --methods");
    return names;
}

/// Merges the parts; how far they lie apart says how sure the whole is.
///
/// first_seed  other for each method: the same numbers would make the same errors
void make_reference(const NamedMethod& method, const Scene& scene, const MeasureOptions& o,
                    const std::string& command, int first_seed) {
    LabeledFilm sum = render_part(method, scene, o, first_seed);
    Spread spread;
    spread.add(sum.film.image());
    for (int seed = first_seed + 1; seed < first_seed + o.runs; seed++) {
        LabeledFilm part = render_part(method, scene, o, seed);
        add_film(sum, part_path(method, scene, o, seed), part);
        spread.add(part.film.image());
    }
    Image image = sum.film.image();
    double rel_mse = spread.rel_mse(image) / o.runs, rmse = std::sqrt(spread.mse() / o.runs);
    std::string path = reference_path(scene_name(scene.file), method.name);
    if (!(rmse < INFINITY)) throw InputError(path + ".pfm: error: samples were not finite");
    JsonObject stats;
    stats.add("scene", scene.file);
    stats.add("chapter", method.name);
    stats.add("spp", sum.film.spp());
    stats.add("max_depth", scene.max_depth);
    stats.add("first_seed", first_seed);
    stats.add("mean", sum.film.mean());
    stats.add("standard_error", sum.film.standard_error());
    stats.add("rmse", rmse);
    stats.add("rel_mse", rel_mse);
    std::filesystem::create_directories(reference_folder);
    write_image(path + ".pfm", image, command);
    write_file_atomically(path + ".json", stats.text());
    std::printf("%s.pfm  %d spp, rmse %.2g, relMSE %.2g\n", path.c_str(), o.runs * scene.spp, rmse,
                rel_mse);
    std::fflush(stdout);
}

/// Those of methods that were chosen some other time.
void remove_references(const std::string& scene) {
    for (const NamedMethod& method : all_methods()) {
        for (const char* ending : {".pfm", ".json"}) {
            std::filesystem::remove(reference_path(scene, method.name) + ending);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "[SCENE...]",
            "Renders the references of the charts by two methods, so that each method has one that "
            "another has made, in --runs parts that take --seconds together. Parts that are in "
            "--out already are not rendered again: those of other machines can be put there.",
            {.spp = 0,
             .runs = 8,
             .width = 64,
             .height = 64,
             .sampler = SamplerType::sobol,
             .seconds = 60,
             .out = "out/references"});
        std::filesystem::create_directories(o.out);
        if (o.words.empty()) o.words = own_scenes();
        Work work("references: two for each of " + std::to_string(o.words.size()) + " scenes",
                  static_cast<double>(o.words.size()));
        for (const std::string& word : o.words) {
            work.next(word);
            Scene scene = load_scene_for(find_scene(word), o);
            std::vector<std::string> names =
                o.methods.empty() ? made_for(scene_name(scene.file)) : o.methods;
            remove_references(scene_name(scene.file));
            int first_seed = 1;
            for (const NamedMethod& method : methods_named(names)) {
                refuse(method, scene);
                scene.spp = o.spp > 0 ? o.spp : part_samples(method, scene, o, first_seed);
                make_reference(method, scene, o, command_line(argc, argv), first_seed);
                first_seed += 1000;
            }
        }
        return 0;
    });
}
