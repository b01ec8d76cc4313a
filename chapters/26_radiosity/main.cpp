// Chapter 26 as a program: reads options, loads a scene, solves it, writes the picture.
#include "chapters/26_radiosity/run.h"
#include "common/program/render.h"
#include "common/scene/diffuse_meshes.h"

int main(int argc, char** argv) {
    return run_program([&] {
        ch26::Settings s;
        auto number = [](const char* name, auto& value, int64_t most) {
            return [&value, name, most](const std::string& text) {
                value = static_cast<uint64_t>(parse_integer(name, text, 1, most));
            };
        };
        auto choice = [](const char* name, auto& kind, std::vector<std::string> words) {
            return [&kind, name, words](const std::string& text) {
                kind = std::remove_reference_t<decltype(kind)>(parse_choice(name, text, words));
            };
        };
        std::vector<Option> own = {
            {"patches", "N", "at least so many, beside those of spheres and disks (default 5000)",
             number("patches", s.patches, 16000), "5000"},
            {"solver", "KIND", "southwell (default: progressive), gauss-seidel or jacobi",
             choice("solver", s.solver, {"southwell", "gauss-seidel", "jacobi"}), "southwell"},
            {"show", "HOW", "constant patches, or smooth (default)",
             choice("show", s.show, {"constant", "smooth"}), "smooth"},
            {"shots", "N", "at most so many (default: until patches wait for 0.1 % of their light)",
             number("shots", s.shots, 1 << 30), "enough"}};
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
        return ch26::run(scene, options, s);
    });
}
