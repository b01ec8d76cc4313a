#include "chapters/05_bvh/estimator.h"
#include "common/picture/heat_map.h"
#include "common/program/render.h"
#include "common/program/table.h"

static std::vector<std::string> measure(const Scene& scene, const std::string& name, size_t step) {
    Stopwatch watch;
    ch05::Finder finder = make_finder(scene, static_cast<ch05::Step>(step));
    double build = watch.seconds();
    ch05::Work work;
    int stride = step == 0 ? 1 + static_cast<int>(scene.geometry.size() / 100) : 1;  // a slow scan
    volatile float t = 0;  // or else the compiler leaves out what nobody asks for
    auto trace = [&](const Ray& ray) { t = find(finder, scene.geometry, ray, work).t; };
    double n = for_pixels(scene, stride, trace), seconds = watch.seconds() - build;
    auto per_ray = [&](uint64_t count) { return digits(static_cast<double>(count) / n, 4); };
    std::string nodes = std::to_string(nodes_of(finder));
    std::string cost = digits(sah_cost(finder.hierarchy), 4), speed = digits(n / seconds / 1e6, 3);
    return {name, digits(build, 3), nodes, cost, per_ray(work.boxes), per_ray(work.prims), speed};
}

int main(int argc, char** argv) {
    return run_program([&] {
        const auto& names = ch05::step_names;
        size_t step = 3;
        Option which{"step", "STEP", "drawn: linear, median, sah, ordered (default) or wide",
                     [&](const std::string& text) { step = parse_choice("step", text, names); }};
        auto o = parse_render_options(argc, argv, "05_bvh", "scenes/knot.pbrt", {which});
        check_outputs(o);
        Scene scene = load(o);
        Table table{{"step", "build s", "nodes", "SAH", "boxes/ray", "prims/ray", "M rays/s"}, {}};
        for (size_t i = 0; i < names.size() && !o.quiet; i++)
            table.rows.push_back(measure(scene, names[i], i));
        auto finder = make_finder(scene, static_cast<ch05::Step>(step));
        auto work = [&](const Ray& ray) { return work_of(finder, scene.geometry, ray); };
        write_results({o.name, o.command, 0, 0, o.out, o.quiet}, table,
                      "white: 200 boxes and primitives for one ray\n", heat_map(scene, 200, work));
        return 0;
    });
}
