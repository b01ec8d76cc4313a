// Chapter 26 as a program: reads options, loads a scene, solves it, writes the picture.
#include "chapters/26_radiosity/run.h"
#include "common/path/radiosity.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        ch26::Settings s;
        std::vector<Option> own = {
            whole_option("patches", "N", "at least so many", 1, 16000, s.patches),
            choice_option("solver", "KIND",
                          "southwell (default: progressive), gauss-seidel or jacobi",
                          {"southwell", "gauss-seidel", "jacobi"}, s.solver),
            choice_option("show", "HOW", "constant patches, or smooth (default)",
                          {"constant", "smooth"}, s.show),
            whole_option("shots", "N",
                         "at most so many (default: until patches wait for 0.1 % of their light)",
                         1, 1 << 30, s.shots)};
        own.back().value = "enough";
        RenderOptions options =
            parse_render_options(argc, argv, "26_radiosity", {"scenes/cornell.pbrt", 0}, own,
                                 {"spp", "time", "size", "seed", "threads", "sampler", "out",
                                  "stats", "stand-in", "quiet"});
        if (s.shots > 0 && s.solver != ch26::Solver::southwell)
            throw UsageError("error: --shots is of shots: it needs --solver southwell");
        Scene scene = load(options, features_of(26));
        if (options.spp == 0) scene.spp = std::min(scene.spp, 16);  // for edges alone
        refuse(scene);
        return ch26::run(scene, options, s);
    });
}
