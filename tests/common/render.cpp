// The loop that all chapters render in, with stand-ins for their trace().
#include "common/program/render.h"

#include <doctest/doctest.h>

#include <atomic>
#include <csignal>
#include <cstring>

#include "common/scene/camera.h"
#include "tests/support/process.h"
#include "tests/support/scenes.h"

namespace {

Scene empty_scene(int width, int height, int spp) {
    Scene scene = scene_of(
        "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"
        "Shape \"sphere\"\n");
    scene.width = width;
    scene.height = height;
    scene.spp = spp;
    return scene;
}

RenderOptions quiet_options(int threads = 2) {
    RenderOptions options;
    options.name = "stand_in";
    options.command = "build/stand_in --spp 4";
    options.threads = threads;
    options.quiet = true;
    return options;
}

/// Depends on the ray and on the random numbers.
Rgb noise(const Scene&, Ray ray, Sampler& sampler, PathLog&) {
    Rgb u = {sampler.u1(), sampler.u1(), sampler.u1()};
    return u + Rgb{ray.d.x, ray.d.y, ray.d.z};
}

/// Not finite for about one sample in a hundred.
Rgb sometimes_not_finite(const Scene& scene, Ray ray, Sampler& sampler, PathLog& log) {
    float u = sampler.u1();
    if (u < 0.005f) return {1, infinity, 1};
    if (u < 0.01f) return {std::nanf(""), 1, 1};
    return noise(scene, ray, sampler, log);
}

/// A few paths of random classes: each scattering is D or S, each with 1/4 ends the path.
Rgb random_classes(const Scene&, Ray, Sampler& sampler, PathLog& log) {
    Rgb L;
    for (int depth = 0; depth < 20; depth++) {
        L += log.emitted({sampler.u1(), sampler.u1(), sampler.u1()});
        if (sampler.u1() < 0.25f) break;
        log.scatter({0, 0, 1}, {1, 1, 1}, 1, sampler.u1() < 0.5f, {1, 1, 1});
    }
    return L;
}

bool same_bits(const Image& a, const Image& b) {
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Rgb)) == 0;
}

/// One sample of one pixel, as the loop must take it.
Rgb sample_of(const Scene& scene, const RenderOptions& options, Trace trace, int x, int y, int s) {
    Sampler sampler(options.sampler, options.seed, static_cast<uint32_t>(scene.spp));
    sampler.start(static_cast<uint32_t>(y * scene.width + x), static_cast<uint32_t>(s));
    Vec2 u = sampler.u2();
    PathLog log;
    Vec2 film = {static_cast<float>(x) + u.x, static_cast<float>(y) + u.y};
    Ray ray = camera_ray(camera_view(scene.camera, scene.width, scene.height), film);
    return trace(scene, ray, sampler, log);
}

std::atomic<int> calls = 0;

Rgb counting(const Scene&, Ray, Sampler&, PathLog&) {
    calls++;
    return {1, 1, 1};
}

Rgb interrupting(const Scene&, Ray, Sampler&, PathLog&) {
    if (calls++ == 0) std::raise(SIGINT);
    return {1, 1, 1};
}

Rgb throwing(const Scene&, Ray, Sampler&, PathLog&) { throw std::bad_alloc(); }

constexpr SamplerType samplers[] = {SamplerType::independent, SamplerType::stratified,
                                    SamplerType::sobol};

}  // namespace

TEST_SUITE("render loop") {
    TEST_CASE("identity: the same bits for any number of threads and each sampler") {
        Scene scene = empty_scene(53, 37, 3);
        for (SamplerType type : samplers) {
            RenderOptions options = quiet_options(1);
            options.sampler = type;
            Rendering one = render_film(scene, options, noise);
            for (int threads : {2, 3, 7, 1000}) {
                options.threads = threads;
                Rendering many = render_film(scene, options, noise);
                CHECK(same_bits(many.film.image(), one.film.image()));
                CHECK(many.film.standard_error() == one.film.standard_error());
            }
        }
    }

    TEST_CASE("identity: each sample is the function of seed, pixel and number that it should be") {
        Scene scene = empty_scene(21, 18, 3);
        for (SamplerType type : samplers) {
            for (uint32_t seed : {0u, 5u}) {
                RenderOptions options = quiet_options();
                options.sampler = type;
                options.seed = seed;
                Image image = render_film(scene, options, noise).film.image();
                for (auto [x, y] : {std::pair(0, 0), std::pair(20, 0), std::pair(17, 16)}) {
                    double r = 0;
                    for (int s = 0; s < 3; s++) {
                        r += static_cast<double>(sample_of(scene, options, noise, x, y, s).r);
                    }
                    CHECK(image.at(x, y).r == static_cast<float>(r / 3));
                }
            }
        }
    }

    TEST_CASE("identity: every pixel gets every sample once, whatever the shape of the picture") {
        struct {
            int width, height, spp;
        } cases[] = {{1, 1, 100000}, {300, 5, 3}, {1, 70, 7}, {16, 16, 257}, {17, 33, 1}};
        for (auto c : cases) {
            calls = 0;
            Rendering r =
                render_film(empty_scene(c.width, c.height, c.spp), quiet_options(3), counting);
            CHECK(calls == c.width * c.height * c.spp);
            CHECK(r.film.spp == static_cast<uint64_t>(c.spp));
            for (Rgb p : r.film.image().pixels) CHECK(p == Rgb{1, 1, 1});
        }
    }

    TEST_CASE("truth: the time ends it after a whole pass, or the samples do") {
        Scene scene = empty_scene(600, 600, 1 << 20);
        RenderOptions options = quiet_options();
        options.time = 0.05;
        calls = 0;
        Rendering r = render_film(scene, options, counting);
        CHECK(r.stats.seconds >= 0.05);
        CHECK(r.film.spp >= 1);
        CHECK(static_cast<uint64_t>(calls) == 600 * 600 * r.film.spp);
        options.time = 1e-9;
        CHECK(render_film(scene, options, counting).film.spp == 1);
        options.time = 1000;
        options.spp = 2;
        CHECK(render_film(scene, options, counting).film.spp == 2);
    }

    TEST_CASE("truth: an interrupt ends it after the pass, which is whole") {
        calls = 0;
        Rendering r = render_film(empty_scene(600, 600, 1000), quiet_options(), interrupting);
        CHECK(r.stats.interrupted);
        CHECK(r.film.spp == 1);
        CHECK(calls == 600 * 600);
        CHECK(r.film.mean() == 1);
        CHECK_FALSE(render_film(empty_scene(2, 2, 1), quiet_options(), counting).stats.interrupted);
    }

    TEST_CASE("truth: a second interrupt ends the program") {
        Finished end = Process([] {
                           render_film(empty_scene(300, 300, 1000), quiet_options(1),
                                       [](const Scene&, Ray, Sampler&, PathLog&) {
                                           std::raise(SIGINT);
                                           return Rgb{};
                                       });
                           return 0;
                       }).wait();
        CHECK(end.signal == SIGINT);
    }

    TEST_CASE("files: what a thread throws reaches the caller") {
        for (int threads : {1, 4}) {
            CHECK_THROWS_AS(render_film(empty_scene(99, 99, 1), quiet_options(threads), throwing),
                            std::bad_alloc);
        }
    }

    TEST_CASE("identity: the classes of a split sum to the whole") {
        Scene scene = empty_scene(40, 30, 4);
        RenderOptions options = quiet_options();
        options.split = "unused";
        Rendering r = render_film(scene, options, random_classes);
        CHECK(r.classes.size() == 128);  // 2^0 + ... + 2^6 letters D or S, and the longer ones
        CHECK(r.classes.contains("longer"));
        CHECK(r.classes.contains("LSDSDDSE"));
        Image whole = r.film.image();
        double mean = 0;
        for (const auto& [name, film] : r.classes) mean += film.mean();
        CHECK(mean == doctest::Approx(r.film.mean()).epsilon(1e-6).scale(0));
        for (size_t i = 0; i < whole.pixels.size(); i++) {
            double sum = 0;
            for (const auto& [name, film] : r.classes) sum += film.pixels()[i].g / 4;
            // trace() sums in float: half a unit in the last place for each of its 20 additions.
            CHECK(std::abs(sum - static_cast<double>(whole.pixels[i].g)) < 20 * 0x1p-24 * sum);
        }
        options.threads = 1;
        Rendering one = render_film(scene, options, random_classes);
        for (const auto& [name, film] : r.classes) {
            CHECK(same_bits(film.image(), one.classes.at(name).image()));
        }
    }

    TEST_CASE("identity: a filter and its opposite sum to the whole") {
        Scene scene = empty_scene(40, 30, 4);
        RenderOptions options = quiet_options();
        double whole = render_film(scene, options, random_classes).film.mean();
        options.paths = "LD.*E";
        double diffuse_first = render_film(scene, options, random_classes).film.mean();
        options.paths = "L(S.*|)E";
        double others = render_film(scene, options, random_classes).film.mean();
        CHECK(diffuse_first > 0.1);
        CHECK(others > 0.1);
        CHECK(diffuse_first + others == doctest::Approx(whole).epsilon(1e-6).scale(0));
    }

    TEST_CASE("failure: samples that are not finite are counted, and none is painted black") {
        Scene scene = empty_scene(40, 30, 4);
        for (int threads : {1, 5}) {
            RenderOptions options = quiet_options(threads);
            Rendering r = render_film(scene, options, sometimes_not_finite);
            uint64_t count = 0;
            Image image = r.film.image();
            for (int y = 0; y < 30; y++) {
                for (int x = 0; x < 40; x++) {
                    uint64_t bad = 0;
                    for (int s = 0; s < 4; s++) {
                        bad += !is_finite(sample_of(scene, options, sometimes_not_finite, x, y, s));
                    }
                    count += bad;
                    CHECK(is_finite(image.at(x, y)) == (bad == 0));
                }
            }
            CHECK(count > 10);
            CHECK(r.stats.not_finite == count);
            CHECK(std::isfinite(r.stats.largest));
            Rgb named = sample_of(scene, options, sometimes_not_finite, r.stats.bad_x,
                                  r.stats.bad_y, r.stats.bad_sample);
            CHECK_FALSE(is_finite(named));
        }
    }

    TEST_CASE(
        "failure: a sample that is not finite fails the program, with the command to see it") {
        TemporaryFolder folder;
        Finished end = Process([&] {
                           Scene scene = empty_scene(8, 8, 4);
                           scene.file = "a.pbrt";
                           RenderOptions options = quiet_options();
                           options.out = {folder / "a.pfm", folder / "a.ppm"};
                           options.stats = folder / "s.json";
                           Rendering r{Film(8, 8), {}, {}};
                           for (size_t i = 0; i < 64; i++) r.film.add(i, 0, {1, 1, 1});
                           r.film.add(9, 1, {1, std::nanf(""), 1});
                           r.film.spp = 2;
                           r.stats.not_finite = 1;
                           r.stats.bad_x = r.stats.bad_y = 1;
                           r.stats.bad_sample = 3;
                           return write_results(scene, options, r);
                       }).wait();
        CHECK(end.code == 1);
        CHECK(end.out == "");
        CHECK(end.err ==
              "error: 1 samples were not finite; to see one: build/stand_in --spp 4 "
              "--explain 1,1,3\n");
        CHECK(std::isnan(read_image(folder / "a.pfm").at(1, 1).g));
        CHECK(read_image(folder / "a.ppm").at(1, 1) == Rgb{1, 0, 1});
        std::string json = read_file(folder / "s.json");
        CHECK(json.find("\"samples_not_finite\": 1,") != std::string::npos);
        CHECK(json.find("\"mean\": null,") != std::string::npos);
    }
}
