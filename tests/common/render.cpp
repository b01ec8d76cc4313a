// The loop that all chapters render in, with stand-ins for their trace().
#include "common/render/render.h"

#include <doctest/doctest.h>

#include <atomic>
#include <csignal>

#include "common/base/system.h"
#include "tests/support/stand_ins.h"

namespace {

/// Depends on the ray and on the random numbers.
Rgb noise(const Scene&, Ray ray, Sampler& sampler, Recorder&) {
    Rgb u = {sampler.u1(), sampler.u1(), sampler.u1()};
    return u + Rgb{ray.d.x, ray.d.y, ray.d.z};
}

/// Not finite for about one sample in a hundred.
Rgb sometimes_not_finite(const Scene& scene, Ray ray, Sampler& sampler, Recorder& recorder) {
    float u = sampler.u1();
    if (u < 0.005f) return {1, infinity, 1};
    if (u < 0.01f) return {std::nanf(""), 1, 1};
    return noise(scene, ray, sampler, recorder);
}

/// A few paths of random classes: each scattering is D or S, each with 1/4 ends the path.
Rgb random_classes(const Scene&, Ray, Sampler& sampler, Recorder& recorder) {
    Rgb L;
    for (int depth = 0; depth < 20; depth++) {
        Rgb Le = {sampler.u1(), sampler.u1(), sampler.u1()};
        L += Le;
        recorder.emitted(Le);
        if (sampler.u1() < 0.25f) break;
        recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, sampler.u1() < 0.5f, {1, 1, 1});
    }
    return L;
}

/// Light of two classes: one part for the own pixel, one for another.
Rgb random_splats(const Scene& scene, const Ray&, Splats& splats, Sampler& sampler,
                  Recorder& recorder) {
    Rgb L = {sampler.u1(), sampler.u1(), sampler.u1()};
    auto pixels = static_cast<float>(scene.width * scene.height);
    size_t pixel = static_cast<size_t>(sampler.u1() * pixels);
    recorder.start_at_light({});
    recorder.connected(L, 2, 1, 1, pixel);
    splats.push_back({pixel, L});
    recorder.start_at_eye();
    recorder.emitted(L);
    return L;
}

/// One sample of one pixel, as the loop must take it.
Rgb sample_of(const Scene& scene, const RenderOptions& options, const Method& trace, int x, int y,
              int s) {
    Sampler sampler(options.sampler, options.seed, static_cast<uint32_t>(scene.spp));
    sampler.start(static_cast<uint32_t>(y * scene.width + x), static_cast<uint32_t>(s));
    Recorder recorder;
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Ray ray = camera_ray(view, film_point(x, y, sampler));
    return trace(scene, ray, sampler, recorder);
}

std::atomic<int> calls = 0;

Rgb counting(const Scene&, Ray, Sampler&, Recorder&) {
    calls++;
    return {1, 1, 1};
}

/// Noise; call number `at` raises a signal.
Method noise_with_signal(int signal, int at) {
    calls = 0;
    std::signal(signal, SIG_DFL);
    return [=](const Scene& scene, Ray ray, Sampler& sampler, Recorder& recorder) {
        if (++calls == at) std::raise(signal);
        return noise(scene, ray, sampler, recorder);
    };
}

}  // namespace

TEST_SUITE("render loop") {
    TEST_CASE("truth: the time ends it, or the samples do") {
        Scene scene = empty_scene(600, 600, 1 << 20);
        RenderOptions options = stand_in_options();
        options.time = 0.05;
        calls = 0;
        Rendering r = render_film(scene, options, counting);
        CHECK(r.stats.seconds >= 0.05);
        CHECK_FALSE(r.stats.interrupted);
        CHECK(calls > 0);
        CHECK(static_cast<uint64_t>(calls) == r.film.samples());
        options.time = 1e-9;
        CHECK(render_film(scene, options, counting).film.samples() < 600 * 600);
        options.time = 1000;
        options.spp = 2;
        CHECK(render_film(scene, options, counting).film.spp() == 2);
    }

    TEST_CASE("truth: a signal ends it at once, and each pixel has the mean of its own samples") {
        Scene scene = empty_scene(300, 200, 1000);
        int at[] = {1000, 5 * 60000 + 300, 7 * 60000};
        for (size_t k : {0u, 1u, 2u}) {
            Rendering r =
                render_film(scene, stand_in_options(1), noise_with_signal(stop_signals[k], at[k]));
            CHECK(r.stats.interrupted);
            CHECK(static_cast<uint64_t>(calls) == r.film.samples());
            CHECK(calls >= at[k]);
            CHECK(calls < at[k] + 10000);
            Image image = r.film.image();
            for (auto [x, y] : {std::pair(0, 0), std::pair(299, 0), std::pair(150, 199)}) {
                uint64_t n = r.film.pixels()[static_cast<size_t>(y * 300 + x)].n;
                double sum = 0;
                for (uint64_t j = 0; j < n; j++)
                    sum += double{
                        sample_of(scene, stand_in_options(), noise, x, y, static_cast<int>(j)).r};
                CHECK(image.at(x, y).r ==
                      static_cast<float>(sum / static_cast<double>(std::max<uint64_t>(n, 1))));
            }
        }
    }

    TEST_CASE("identity: the classes of a split sum to the whole") {
        Scene scene = empty_scene(40, 30, 4);
        RenderOptions options = stand_in_options();
        options.split = "unused";
        Rendering r = render_film(scene, options, random_classes);
        CHECK(r.classes.size() == 128);  // 2^0 + ... + 2^6 letters D or S, and the longer ones
        CHECK(r.classes.contains("longer"));
        CHECK(r.classes.contains("LSDSDDSE"));
        Image whole = r.film.image();
        for (size_t i = 0; i < whole.pixels.size(); i++) {
            double sum = 0;
            for (const auto& [name, film] : r.classes) sum += film.pixels()[i].g() / 4;
            // trace() sums in float: half a unit in the last place for each of its 20 additions.
            CHECK(std::abs(sum - static_cast<double>(whole.pixels[i].g)) < 20 * 0x1p-24 * sum);
        }
        RenderOptions alone = options;
        alone.split.clear(), alone.paths = "LDE";
        CHECK(render_film(scene, alone, random_classes).film.image().pixels ==
              r.classes.at("LDE").image().pixels);
        options.threads = 1;
        Rendering one = render_film(scene, options, random_classes);
        for (const auto& [name, film] : r.classes)
            CHECK(film.image().pixels == one.classes.at(name).image().pixels);
        // Those with light for other pixels.
        r = render_film(scene, options, method_of<random_splats>());
        Image own = r.classes.at("LE").image(), others = r.classes.at("LDE").image();
        whole = r.film.image();
        for (size_t i = 0; i < whole.pixels.size(); i++) {
            float sum = own.pixels[i].g + others.pixels[i].g;
            CHECK(std::abs(sum - whole.pixels[i].g) <= 1e-6f * sum);
        }
    }

    TEST_CASE("failure: samples that are not finite are counted, and none is painted black") {
        Scene scene = empty_scene(40, 30, 4);
        for (int threads : {1, 5}) {
            RenderOptions options = stand_in_options(threads);
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
            SampleAt bad = r.stats.bad;
            Rgb named = sample_of(scene, options, sometimes_not_finite, bad.x, bad.y, bad.number);
            CHECK_FALSE(is_finite(named));
        }
    }
}
