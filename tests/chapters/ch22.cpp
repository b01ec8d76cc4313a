// Chapter 22: the weights of 21 in constant time, and more samples of what only chance can find.
// What holds for both chapters is in ch21.cpp.
#include <doctest/doctest.h>

#include "chapters/15_mis_ris/estimator.h"
#include "chapters/21_bidirectional/estimator.h"
#include "chapters/22_fast_bidirectional/estimator.h"
#include "tests/support/light_paths.h"

namespace {

/// What one path brought: by strategy, what was added, and its weight.
std::vector<Contribution> parts_of(const Scene& scene, const Method& trace, uint32_t i) {
    Sampler sampler(SamplerType::independent, 1, 1);
    sampler.start(0, i);
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Vec2 u = sampler.u2();
    Vec2 film = {u.x * static_cast<float>(scene.width), u.y * static_cast<float>(scene.height)};
    Recorder recorder(true);
    Splats splats;
    trace.trace(scene, camera_ray(view, film), splats, sampler, recorder);
    return recorder.contributions();
}

/// |a - b|, relative to the larger one.
double relative(Rgb a, Rgb b) {
    auto largest = [](Rgb c) { return static_cast<double>(std::max({c.r, c.g, c.b})); };
    Rgb d = {std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)};
    return largest(d) / std::max({largest(a), largest(b), 1e-20});
}

Method by_21(const Scene& scene) { return method_of<ch21::trace>(endpoints_of(scene)); }
Method by_22(const Scene& scene, int samples) {
    return method_of<ch22::trace>(ch22::prepare(scene, samples));
}

}  // namespace

TEST_SUITE("ch22 fast bidirectional") {
    TEST_CASE("identity: extra samples replace only paths that no connection can make" *
              doctest::skip()) {
        Scene scene = scene_from("scenes/cornell-spheres.pbrt", 32, 8);
        Method without = by_22(scene, 0), with = by_22(scene, 16);
        int replaced = 0, added = 0, others = 0;
        for (uint32_t i = 0; i < 150000; i++) {
            std::vector<Contribution> kept;
            for (const Contribution& part : parts_of(scene, with, i)) {
                bool is_extra = part.mis == 1 / 16.0f && part.way.starts_with("s 0");
                if (!is_extra) kept.push_back(part);
                added += is_extra;
            }
            size_t k = 0;
            for (const Contribution& part : parts_of(scene, without, i)) {
                bool is_kept =
                    k < kept.size() && kept[k].way == part.way && relative(kept[k].L, part.L) == 0;
                k += is_kept;
                replaced += !is_kept;
                others += !is_kept && (part.mis != 1 || !part.way.starts_with("s 0"));
            }
            others += k != kept.size();
        }
        CHECK(others == 0);
        CHECK(replaced > 3);
        CHECK(added > 100);
    }

    TEST_CASE("variance: direct light has the error of chapter 15" * doctest::skip()) {
        // In chapter 21 it would have three times as much with splats of direct light.
        for (std::string name : {"cornell-spheres", "thousand-lights", "near-light"}) {
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 4);
            auto error_of = [&](const Method& method) {
                return blocks_of(scene, method, 16, 16, 1, "LDE").variance();
            };
            double fifteen = error_of(method_of<ch15::trace>(ch15::prepare(scene)));
            CHECK(error_of(by_22(scene, 16)) < 1.3 * fifteen);
            if (name == "cornell-spheres") CHECK(error_of(by_21(scene)) < 2 * fifteen);
        }
    }

    TEST_CASE("variance: sixteen samples leave a sixteenth of the variance of their paths" *
              doctest::skip()) {
        // Light through glass, seen through glass or a mirror: only random hits find it.
        Scene scene = scene_from("scenes/cornell-spheres.pbrt", 32, 8);
        auto by_samples = [&](int samples, uint32_t seed) {
            return census_of(scene, by_22(scene, samples), 400000, seed, {"LS+DS+E"})
                .measured("all LS+DS+E");
        };
        Measured one = by_samples(0, 1), many = by_samples(16, 2);
        CHECK(z_between(one, many) < 5);
        CHECK(many.se < 0.5 * one.se);
        CHECK(many.se > 0.2 * one.se);
    }
}
