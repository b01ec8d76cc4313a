// Chapter 07: path tracing: furnaces, closed enclosures, light found by chance, and teeth.
#include <doctest/doctest.h>

#include <array>

#include "chapters/07_path_tracing/estimator.h"
#include "common/base/error.h"
#include "tests/support/gates.h"
#include "tests/support/scenes.h"

namespace {

constexpr double pi_exact = std::numbers::pi;

/// The green channel of chapter 07 along one ray, over and over.
RunningStats repeat(const Scene& scene, const Ray& ray, int paths, uint32_t seed = 1) {
    RunningStats stats;
    Sampler sampler(SamplerType::independent, seed, 1);
    Recorder recorder;
    for (int i = 0; i < paths; i++) {
        sampler.start(0, static_cast<uint32_t>(i));
        stats.add(static_cast<double>(ch07::trace(scene, ray, sampler, recorder).g));
    }
    return stats;
}

/// The inside of a ball whose wall emits 1 and reflects the share a.
Scene closed_sphere(double a, int max_depth) {
    std::string albedo = std::to_string(a);
    Scene scene = world_of(
        "ReverseOrientation AreaLightSource \"diffuse\"\n"
        "Material \"diffuse\" \"rgb reflectance\" [" +
        albedo + " " + albedo + " " + albedo + "] Shape \"sphere\"");
    scene.camera.o = {0, 0, 0};
    scene.max_depth = max_depth;
    return scene;
}
const Ray from_inside = {{0, 0, 0}, {0, 0, 1}};

/// |mean - truth| in known standard errors; the largest over the pixels that the ball covers.
double worst_pixel(const Film& film, const std::array<double, 3>& albedo, double radius) {
    double worst = 0, n = film.spp();
    for (int y = 0; y < film.height; y++)
        for (int x = 0; x < film.width; x++) {
            if (std::hypot(x + 0.5 - film.width / 2.0, y + 0.5 - film.height / 2.0) > radius)
                continue;
            const PixelSum& p = film.pixels()[static_cast<size_t>(y * film.width + x)];
            std::array<double, 3> sums = {p.r(), p.g(), p.b()};
            for (size_t c = 0; c < 3; c++) {
                double se = albedo[c] / std::sqrt(3 * n);  // one path: variance a^2 / 3
                worst = std::max(worst, std::abs(sums[c] / n - albedo[c]) / se);
            }
        }
    return worst;
}

/// The Cornell box, camera and all, with all lengths multiplied.
Scene cornell_in_units(double unit) {
    auto times = [&](std::initializer_list<double> numbers) {
        std::string text;
        for (double x : numbers) text += std::to_string(x * unit) + " ";
        return text;
    };
    std::string text = read_file("scenes/cornell.pbrt"), scale = std::to_string(unit) + " ";
    text.replace(text.find("278 273 -800  278 273 0"), 23, times({278, 273, -800, 278, 273, 0}));
    text.replace(text.find("WorldBegin"), 10, "WorldBegin Scale " + scale + scale + scale);
    Scene scene = scene_of(text);
    scene.width = scene.height = 32;
    return scene;
}

}  // namespace

TEST_SUITE("ch07 bsdf") {
    TEST_CASE("identity: cylindrical coordinates") {
        for (int i = 0; i <= 4096; i++) {
            double u = i / 4096.0, phi = 2 * std::numbers::pi * u;
            Vec3 p = from_cylindrical(2, static_cast<float>(u), 3);
            CHECK(std::abs(static_cast<double>(p.x) - 2 * std::cos(phi)) < 2.4e-7);
            CHECK(std::abs(static_cast<double>(p.y) - 2 * std::sin(phi)) < 2.4e-7);
            CHECK(p.z == 3);
        }
        CHECK(from_cylindrical(1, 0, 0) == Vec3{1, 0, 0});
        CHECK(from_cylindrical(1, 0.75f, 0) == Vec3{0, -1, 0});
    }

    TEST_CASE("density: uniform hemisphere") {
        std::array<double, 100> counts{};
        RunningStats z, z2, x2;
        Sampler random = random_numbers(1);
        for (int i = 0; i < 100000; i++) {
            Vec2 u = random.u2();
            Vec3 w = ch07::sample_uniform_hemisphere(u);
            z.add(static_cast<double>(w.z));
            z2.add(static_cast<double>(w.z) * w.z);
            x2.add(static_cast<double>(w.x) * w.x);
            double phi = std::atan2(static_cast<double>(w.y), static_cast<double>(w.x));
            counts[std::min(static_cast<size_t>(w.z * 10), size_t{9}) * 10 +
                   static_cast<size_t>((phi / pi_exact + 1) * 4.9999999)]++;
            Vec2 again = ch07::invert_uniform_hemisphere(w);
            CHECK(std::abs(again.x - u.x) < 1e-6f);
            if (u.x > 1e-3f) CHECK(std::abs(again.y - u.y) < 1e-5f);
        }
        check_mean(z, 0.5, 1.0 / 12, 0.01);
        check_mean(z2, 1.0 / 3, 4.0 / 45, 0.01);
        check_mean(x2, 1.0 / 3, 4.0 / 45, 0.01);
        CHECK(chi_square_tail(chi_square(counts), 99) > 1e-6);
        CHECK(static_cast<double>(ch07::pdf_uniform_hemisphere()) ==
              doctest::Approx(1 / (2 * pi_exact)).epsilon(1e-7).scale(0));
        for (float u : {0.0f, 0x1.fffffep-1f}) CHECK(ch07::sample_uniform_hemisphere({u, u}).z > 0);
    }

    TEST_CASE("consistency: samples, densities and values of every material agree") {
        for (const char* material :
             {"\"diffuse\" \"rgb reflectance\" [0.7 0.5 0.3]", "\"conductor\"", "\"dielectric\""}) {
            Scene scene = world_of("LightSource \"infinite\" Material " + std::string(material) +
                                   " Shape \"sphere\"");
            Sampler random = random_numbers(1);
            for (int i = 0; i < 2000; i++) {
                Hit x = *intersect(scene, {1.01f * uniform_direction(random.u2()), {0, 0, 0}});
                x = *intersect(scene, {{0, 0, 0}, uniform_direction(random.u2())});
                Vec3 wo = -normalize(x.p);
                if (i % 2 == 0) {  // from outside
                    Vec3 from = 3 * uniform_direction(random.u2());
                    wo = normalize(from);
                    x = *intersect(scene, {from, -wo});
                }
                float u1 = random.u1();
                auto s = ch07::sample_bsdf(x, wo, u1, random.u2());
                REQUIRE(s.pdf_w > 0);
                CHECK(std::abs(length(s.wi) - 1) < 1e-6f);
                Rgb f = ch07::eval_bsdf(x, wo, s.wi);
                float pdf_w = ch07::pdf_bsdf(x, wo, s.wi);
                CHECK(f == (s.specular ? Rgb{} : s.f));
                CHECK(pdf_w == (s.specular ? 0 : s.pdf_w));
                CHECK(f == ch07::eval_bsdf(x, s.wi, wo));
                CHECK(is_black(ch07::eval_bsdf(x, wo, -x.n)));
                CHECK(ch07::pdf_bsdf(x, wo, -x.n) == 0);
                // No path gains: f cos / pdf_w is at most 2 (uniform), 1, or 1 / eta^2.
                float weight = max_component(s.f) * std::abs(dot(s.wi, x.n)) / s.pdf_w;
                float most = !s.specular          ? 2 * 0.7f
                             : dot(s.wi, x.n) > 0 ? 1
                             : x.front            ? 1 / 2.25f
                                                  : 2.25f;
                CHECK(weight <= most * 1.00001f);
            }
        }
    }
}

TEST_SUITE("ch07 path tracing") {
    TEST_CASE("truth: a diffuse ball in a white sky: mean a, variance a^2 / 3") {
        Scene scene = world_of("LightSource \"infinite\" Shape \"sphere\"");  // albedo 0.5
        RunningStats s = repeat(scene, {{0, 0, -4}, {0, 0, 1}}, 400000);
        check_mean(s, 0.5, 0.25 / 3, 0.005);
        check_variance(s, 0.25 / 3, 1.8);  // evenly spread on [0, 2a]
    }

    TEST_CASE("furnace: every pixel of a convex diffuse ball is its albedo") {
        Scene scene = world_of(
            "LightSource \"infinite\" Material \"diffuse\" \"rgb reflectance\" [0.8 0.5 0.2]\n"
            "Shape \"sphere\"");
        Rendering r = film_of(scene, ch07::trace, 256);
        CHECK(worst_pixel(r.film, {0.8, 0.5, 0.2}, 10.5) < 5);  // the ball's radius is 11.35 pixels
        for (int corner : {0, 31}) {
            const PixelSum& p = r.film.pixels()[static_cast<size_t>(corner)];
            CHECK(p.mean() == 1);  // beside it there is sky
        }
    }

    TEST_CASE("truth: closed sphere, cut off: every length of path brings a^k, no more, no less") {
        for (double a : {0.5, 0.8}) {
            constexpr int longest = 5;
            PathCensus census = census_of(closed_sphere(a, longest), ch07::trace, 100000, 1);
            CHECK(census.by_length.rbegin()->first == longest);
            double sum = 0, power = 1;
            for (size_t k = 0; k <= longest; k++, power *= a) {
                Measured part = census.by_length[k].measured(census.paths);
                CAPTURE(k);
                CHECK(std::abs(part.mean - power) <= 5 * part.se + 1e-6);
                CHECK(part.se < 0.015 * power);
                sum += power;
            }
            CHECK(sum == doctest::Approx((1 - power) / (1 - a)).epsilon(1e-12).scale(0));
            Measured all = census.all.measured(census.paths);
            CHECK(std::abs(all.mean - sum) < 5 * all.se);
        }
    }

    TEST_CASE("furnace: every pixel of the closed sphere is Le / (1 - a)") {
        Film film = film_of(closed_sphere(0.5, 25), ch07::trace, 64).film;
        double worst = 0;
        for (const PixelSum& p : film.pixels()) {
            worst = std::max(worst, std::abs(p.mean() - 2) / std::sqrt(0.5 / 64));
        }
        CHECK(worst < 5.5);  // kurtosis 4, 1024 pixels
    }

    TEST_CASE("truth: a ball inside a ball: 10/9 and 2/9") {
        Scene scene = world_of(
            "AttributeBegin AreaLightSource \"diffuse\" Shape \"sphere\" AttributeEnd\n"
            "ReverseOrientation Shape \"sphere\" \"float radius\" 2");
        scene.max_depth = 25;
        for (auto [ray, L] : {std::pair{Ray{{0, 0, -1.5f}, {0, 0, 1}}, 10.0 / 9},
                              {Ray{{0, 0, -1.5f}, {0, 0, -1}}, 2.0 / 9}}) {
            RunningStats s = repeat(scene, ray, 50000);
            CHECK(std::abs(s.mean() - L) < 5 * s.standard_error());
            CHECK(s.standard_error() < 0.01 * L);
        }
    }

    TEST_CASE("identity: emission is one-sided unless the file says otherwise") {
        for (bool two_sided : {false, true}) {
            Scene scene = world_of("AreaLightSource \"diffuse\" \"bool twosided\" " +
                                   std::string(two_sided ? "true " : "false ") + square(0, true));
            scene.max_depth = 0;
            CHECK(repeat(scene, {{0, 1, 0}, {0, -1, 0}}, 1).mean() == 1);
            CHECK(repeat(scene, {{0, -1, 0}, {0, 1, 0}}, 1).mean() == (two_sided ? 1 : 0));
        }
    }

    TEST_CASE("truth: a scene without light is black, one without things is sky: exactly") {
        Scene scene;
        prepare(scene, 1);
        CHECK(repeat(scene, from_inside, 10).mean() == 0);
        scene.lights.emplace_back();
        scene.lights[0].type = LightType::infinite;
        scene.lights[0].L = {0.5f, 0.75f, 2};
        prepare(scene, 1);
        CHECK(repeat(scene, from_inside, 10).mean() == 0.75);
        Scene black = closed_sphere(0.5, 50);
        black.lights.clear();
        black.shapes[0].light = -1;
        CHECK(repeat(black, from_inside, 100).mean() == 0);
        Scene dark = closed_sphere(0, 50);  // black paint: the path ends after one surface
        RunningStats s = repeat(dark, from_inside, 100);
        CHECK(s.mean() == 1);
        CHECK(s.variance() == 0);
    }

    TEST_CASE("failure: without roulette a closed scene never ends by itself: all paths are cut") {
        Rendering r = film_of(closed_sphere(0.9, 100), ch07::trace, 4);
        CHECK(r.stats.paths_cut == 4 * 32 * 32);
        double lost = std::pow(0.9, 101);  // the share that the limit takes
        CHECK(r.film.mean() > 0);
        CHECK(lost < 3e-5);
    }
}

TEST_SUITE("ch07 pictures") {
    TEST_CASE("agreement: the picture does not depend on the unit of length") {
        // The same seeds, so that only what rounding does to a path can make a difference.
        Film film = film_of(cornell_in_units(1), ch07::trace, 128).film;
        for (double unit : {0.001, 1000.0}) {
            Agreement a =
                hold_against(film_of(cornell_in_units(unit), ch07::trace, 128).film, film);
            CAPTURE(unit);
            CHECK(a.agrees());
            CHECK(a.relative < 0.002);
        }
    }
}
