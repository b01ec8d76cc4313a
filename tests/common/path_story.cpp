// What --explain tells of a path: its figures must be those of one path, whatever the scene.
#include "common/recording/path_story.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <sstream>

#include "chapters/14_mis/estimator.h"
#include "tests/support/scenes.h"

namespace {

/// Three numbers of a line, behind `word`, or one.
bool read(const std::string& line, const std::string& word, Vec3d& v) {
    size_t at = line.find(word);
    return at != std::string::npos && std::sscanf(line.c_str() + at + word.size(),
                                                  " (%lf, %lf, %lf)", &v[0], &v[1], &v[2]) == 3;
}
bool read(const std::string& line, const std::string& word, double& x) {
    size_t at = line.find(word);
    return at != std::string::npos && std::sscanf(line.c_str() + at + word.size(), " %lf", &x) == 1;
}

/// The figures of one story, each checked against those before it.
struct Checked {
    int edges = 0, survivals = 0, lights = 0, met = 0;

    void check(const std::string& story) {
        auto is = [](double x) { return doctest::Approx(x).epsilon(1e-4).scale(0); };
        Vec3d p = {}, n = {}, wi = {}, beta = {1, 1, 1}, v, f;
        double x = 0, pdf_l = 0, pdf_b = 0, pdf_w = 0;
        bool first = true, aimed = false;
        std::istringstream lines(story);
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with("vertex ")) {
                Vec3d before = p;
                REQUIRE((read(line, " at", p) && read(line, ", n", n)));
                REQUIRE(read(line, "distance", x));
                CHECK(length(n) == is(1));
                // It lies along the direction in which the path went on.
                CHECK((first || length(before + x * wi - p) < 1e-4 * (x + length(p))));
                edges += !first, first = false;
            } else if (line.find("samples a light") != std::string::npos) {
                REQUIRE(read(line, "along wi", v));
                REQUIRE((read(line, "pdf_l", pdf_l) && read(line, "pdf_b", pdf_b)));
                CHECK(length(v) == is(1));
                aimed = true;
            } else if (line.find(": adds ") != std::string::npos) {
                REQUIRE(read(line, ", mis", x));
                CHECK(x <= 1);
                bool of_light = line.find("light sampled") != std::string::npos;
                if (of_light && aimed) {  // the power heuristic
                    CHECK(x == is(pdf_l * pdf_l / (pdf_l * pdf_l + pdf_b * pdf_b)));
                    lights++;
                }
                met += !of_light;
            } else if (line.find("goes on along") != std::string::npos) {
                REQUIRE((read(line, "along wi", wi) && read(line, ": f", f)));
                REQUIRE((read(line, "pdf_w", pdf_w) && read(line, ", beta", v)));
                CHECK(length(wi) == is(1));
                double cos = std::abs(dot(wi, n));
                for (size_t k = 0; k < 3; k++) {
                    double expected = beta[k] * f[k] * cos / pdf_w;
                    CHECK(std::abs(v[k] - expected) < (1e-4 + 1e-5 / cos) * expected + 1e-12);
                }
                beta = v, aimed = false;
            } else if (line.find("survives roulette") != std::string::npos) {
                REQUIRE((read(line, ", q", x) && read(line, ", beta", v)));
                CHECK(x > 0);
                for (size_t k = 0; k < 3; k++) CHECK(v[k] == is(beta[k] / x));
                beta = v, survivals++;
            }
        }
    }
};

}  // namespace

TEST_SUITE("path story") {
    TEST_CASE("identity: in a path's story each figure follows from those before it") {
        for (const char* name : {"veach-mis", "cornell-spheres", "cornell"}) {
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + std::string(name) + ".pbrt", 16, 30);
            ch14::Lights lights = ch14::prepare(scene);
            CameraView view = camera_view(scene.camera, 16, 16);
            Sampler sampler(SamplerType::independent, 1, 1);
            Checked checked;
            for (uint32_t i = 0; i < 1000; i++) {
                sampler.start(0, i);
                Vec2 u = sampler.u2();
                PathStory story(scene.max_depth, false);
                Recorder recorder(true, &story);
                ch14::trace(scene, lights, camera_ray(view, {16 * u.x, 16 * u.y}), sampler,
                            recorder);
                story.ends();
                checked.check(story.text());
            }
            CHECK(checked.edges > 100);
            CHECK(checked.lights > 100);
            CHECK(checked.met > 10);
            if (name == std::string("cornell")) CHECK(checked.survivals > 100);
        }
    }
}
