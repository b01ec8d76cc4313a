// What programs print beside pictures: statistics, explained paths, and the reasons why a film does
// not fit.
#include <doctest/doctest.h>

#include "common/render/render.h"
#include "common/scene/prepare.h"
#include "tests/support/process.h"
#include "tests/support/stand_ins.h"

namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

/// A scene of 10 x 10 pixels, with a depth limit of 7.
Scene small_scene() {
    Scene scene = empty_scene(10, 10, 4);
    scene.origin = std::make_shared<Origin>(Origin{"a folder/b.pbrt", {}, 0xabc, {}});
    scene.max_depth = 7;
    return scene;
}
RenderOptions options_of(const std::string& folder) {
    RenderOptions options;
    options.name = "07_x";
    options.command = "build/07_x --spp 4";
    options.threads = 3;
    options.seed = 5;
    options.out = {folder + "/a.pfm"};
    return options;
}

/// 4 samples in each pixel: 1 +- 0.1 in red, twice that in green, nothing in blue.
Rendering rendering_of() {
    Rendering r{Film(10, 10), {}, {}};
    for (size_t i = 0; i < 100; i++) {
        for (int s = 0; s < 4; s++) {
            float L = s % 2 == 0 ? 0.9f : 1.1f;
            r.film.add(i, {L, 2 * L, 0});
        }
    }
    r.stats.seconds = 2, r.stats.rays = 9'000'000, r.stats.rays_before = 1'000'000;
    r.stats.samples_before = 200;
    r.stats.largest = 1.1;
    return r;
}

}  // namespace

TEST_SUITE("printed") {
    TEST_CASE("truth: the command to see a sample that is not finite is told") {
        TemporaryFolder folder;
        RenderOptions options = options_of(folder.path());
        Rendering r = rendering_of();
        r.film.add(3, {inf, 1, 1});
        r.stats.not_finite = 2, r.stats.bad = {5, 4, 3, 6};
        r.stats.interrupted = true;
        Finished end = captured([&] { return write_results(small_scene(), options, r); });
        CHECK(end.code == 1);
        CHECK(end.out.find("\nmean unknown: not all samples are finite\n") != std::string::npos);
        CHECK(end.err.ends_with(": build/07_x --spp 4 --explain 3,4,6\n"));
    }

    TEST_CASE("truth: an explained sample is that of its pixel") {
        TemporaryFolder folder;
        Scene scene = world_of("LightSource \"point\" Shape \"sphere\"", 4);
        scene.spp = 8;
        RenderOptions options = options_of(folder.path());
        options.explain = {0, 2, 1, 5};
        Rgb met = {0.5f, 0.25f, 0};
        float random = 0;
        Method method = [&](const Scene&, Ray, Sampler& sampler, Recorder& recorder) {
            random = sampler.u1();
            recorder.emitted(met);
            return met;
        };
        auto explained = [&] { return captured([&] { return explain(scene, options, method); }); };
        CHECK(explained().code == 0);
        Sampler sampler(options.sampler, options.seed, 8);
        sampler.start(9, 5);
        sampler.u2();  // the point on the film
        CHECK(random == sampler.u1());
        method.allocation.pilot = 1, options.explain->number = 7;  // halves share numbers
        explained();
        start_sample(sampler, 9, 1, 3);
        sampler.u2();
        CHECK(random == sampler.u1());
        // A sample that is not finite fails, where it counts.
        met = {inf, 0, 0};
        CHECK(explained().code == 1);
        options.paths = "LDE";
        CHECK(explained().code == 0);
    }

    TEST_CASE("truth: a film goes on where its samples begin what is wanted, and says why not") {
        TemporaryFolder folder;
        Scene scene = small_scene();
        RenderOptions options = options_of(folder.path());
        options.film = folder / "a.film";
        Rendering r = rendering_of();
        save_film(scene, options, r);
        auto label = [&] { return read_film(options.film).label; };
        CHECK(label().samples == std::vector<SampleRange>{{5, 0, 4, {4}}});
        auto goes_on = [&](int spp, int part, int parts) {
            RenderOptions with = options;
            with.part = part, with.parts = parts, scene.spp = spp;
            Rendering next{Film(10, 10), {}, {}};
            std::string error = error_of([&] { continue_film(scene, with, next); });
            bool is_named = error.starts_with(options.film + ": error: it holds samples 0 to 3 of");
            CHECK(is_named == !error.empty());
            CHECK(next.film.samples() == (error.empty() ? 400 : 0));
            CHECK(next.begun == (error.empty() ? 4 : 0));
            CHECK(next.stats.samples_before == next.film.samples());
            CHECK(next.stats.rays_before == (error.empty() ? 9'000'000 : 0));
            CHECK(next.stats.rays == next.stats.rays_before);
            CHECK(next.stats.largest == (error.empty() ? 1.1 : 0));
            return error.empty();
        };
        CHECK(goes_on(4, 1, 1));
        CHECK(goes_on(9, 1, 1));
        CHECK_FALSE(goes_on(9, 2, 2));
        CHECK_FALSE(goes_on(3, 1, 1));
        options.seed = 6;
        CHECK_FALSE(goes_on(9, 1, 1));
        options.seed = 5;
        // What is to come is in the film's goal; with --time alone nothing is.
        scene.spp = 9;
        save_film(scene, options, r);
        CHECK(label().samples[0].goal == Goal{9, 1});
        options.time = 3;
        save_film(scene, options, r);
        CHECK(label().samples[0].goal == Goal{});
    }
}
