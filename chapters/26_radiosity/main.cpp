// Chapter 26 as a program: reads options, loads a scene, solves it, writes the picture.
#include "chapters/26_radiosity/run.h"
#include "common/program/render.h"
#include "common/results/outputs.h"
#include "common/scene/diffuse_meshes.h"

int main(int argc, char** argv) {
    return run_program([&] {
        ch26::Settings s;
        std::vector<Option> own = {
            {"patches", "N", "at least so many, beside those of spheres and disks (default 5000)",
             [&](const auto& text) {
                 s.patches = static_cast<size_t>(parse_integer("patches", text, 1, 16000));
             },
             "5000"},
            {"solver", "KIND", "southwell (default: progressive), gauss-seidel or jacobi",
             [&](const auto& text) {
                 s.solver = static_cast<ch26::Solver>(
                     parse_choice("solver", text, {"southwell", "gauss-seidel", "jacobi"}));
             },
             "southwell"},
            {"show", "HOW", "constant patches, or smooth (default)",
             [&](const auto& text) {
                 s.show =
                     static_cast<ch26::Show>(parse_choice("show", text, {"constant", "smooth"}));
             },
             "smooth"},
            {"shots", "N", "at most so many (default: until patches wait for 0.1 % of their light)",
             [&](const auto& text) {
                 s.shots = static_cast<uint64_t>(parse_integer("shots", text, 1, 1 << 30));
             },
             "enough"}};
        RenderOptions options =
            parse_render_options(argc, argv, "26_radiosity", "scenes/cornell.pbrt", own,
                                 {"spp", "time", "size", "seed", "threads", "sampler", "out",
                                  "stats", "stand-in", "quiet"});
        if (s.shots > 0 && s.solver != ch26::Solver::southwell)
            throw UsageError("error: --shots is of shots: it needs --solver southwell");
        Scene scene = load(options);
        if (options.spp == 0) scene.spp = std::min(scene.spp, 16);  // for edges alone
        refuse(scene);
        s.patches += tessellate(scene, options.threads);
        check_outputs(scene, options);
        return ch26::run(scene, options, s);
    });
}
