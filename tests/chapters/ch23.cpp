// Chapter 23: photons, those near to a point, and the estimate of its light.
#include <doctest/doctest.h>

#include <set>

#include "chapters/15_mis_ris/estimator.h"
#include "chapters/22_fast_bidirectional/estimator.h"
#include "chapters/23_photon_mapping/estimator.h"
#include "tests/support/light_paths.h"

namespace {

using ch23::PhotonSettings;

/// Points on the sides of a unit cube: as photons lie, on surfaces.
std::vector<Photon> on_a_cube(size_t n, Sampler& random) {
    std::vector<Photon> photons(n);
    for (Photon& photon : photons) {
        Vec2 u = random.u2();
        int side = static_cast<int>(6 * random.u1());
        photon.p = {u.x, u.y, random.u1()};
        photon.p[side % 3] = side < 3 ? 0 : 1;
    }
    return photons;
}

/// Flux 1 / n each, spread evenly over the unit square y = 0, seen from above.
std::vector<Photon> on_a_square(int n, Sampler& random, float flux) {
    std::vector<Photon> photons;
    for (int i = 0; i < n; i++) {
        Vec2 u = random.u2();
        photons.push_back({{u.x, 0, u.y}, {0, 1, 0}, {flux, flux, flux}, 1});
    }
    return photons;
}

/// A point of a white floor, whose radiance is its irradiance / pi.
Hit floor_at(float x, float z) {
    static Material white;
    white.reflectance = {1, 1, 1};
    Hit hit;
    hit.p = {x, 0, z}, hit.n = hit.ng = {0, 1, 0}, hit.material = &white;
    return hit;
}

/// The irradiance at a point, estimated from photons within this radius.
double irradiance_at(const Hit& x, const std::vector<Photon>& photons, float radius) {
    Recorder recorder;
    return pi_exact * double{ch23::gather({}, PhotonMap(photons, radius), x, 9, recorder).g};
}

Method by_15(const Scene& scene) { return method_of<ch15::trace>(ch15::prepare(scene)); }
Method by_22(const Scene& scene) { return method_of<ch22::trace>(ch22::prepare(scene)); }

/// The mean is that of the truth, but for 5 standard errors and a bias; both know it well.
void check_near(const Measured& m, const Measured& truth, double bias, double relative_se) {
    double se = std::hypot(m.se, truth.se);
    CHECK(std::abs(m.mean - truth.mean) < 5 * se + bias * truth.mean);
    CHECK(se < relative_se * truth.mean);
}

}  // namespace

TEST_SUITE("ch23 photon map") {
    TEST_CASE("brute: photons near a point are those that a search through all finds") {
        Sampler random = random_numbers(1);
        for (size_t n : {0u, 1u, 2u, 16u, 17u, 33u, 100u, 1000u, 4099u}) {
            for (int shape = 0; shape < 3; shape++) {
                float unit = shape == 1 ? 1 : n % 2 == 0 ? 1e-3f : 1e4f;
                std::vector<Photon> photons = on_a_cube(n, random);
                for (Photon& photon : photons) {
                    if (shape == 1) photon.p = {0.5f, 0.5f, 0.5f};  // all at one point
                    if (shape == 2) photon.p.y = photon.p.z = 0;    // on a line
                    if (shape == 2) photon.p.x = std::round(8 * photon.p.x) / 8;  // and equal ones
                }
                for (Photon& photon : photons) photon.p = unit * (photon.p - Vec3{1, 1, 1} / 3);
                for (int i = 0; i < 50; i++) {
                    float radius = 0.5f * unit * random.u1();
                    Vec3 p = unit * (on_a_cube(1, random)[0].p - Vec3{1, 1, 1} / 3);
                    if (i % 3 == 0 && n > 0) p = photons[static_cast<size_t>(i) % n].p;
                    PhotonMap map(photons, radius);
                    REQUIRE(map.size() == n);
                    std::multiset<float> found, expected;
                    map.for_each_near(p, [&](const Photon&, Vec3 v) { found.insert(dot(v, v)); });
                    for (const Photon& photon : photons) {
                        float d2 = length_squared(photon.p - p);
                        if (d2 < radius * radius) expected.insert(d2);
                    }
                    CHECK(found == expected);
                }
            }
        }
    }
}

TEST_SUITE("ch23 density of photons") {
    TEST_CASE("truth: light at an edge and in a corner") {
        // The share that is found at the distance t r from the edge (TRUTHS G2 to G4).
        constexpr int n = 2000, repeats = 200;
        constexpr float r = 0.1f;
        for (auto [t, share] : {std::pair{0.0f, 0.5},
                                {0.25f, 0.7056377759552},
                                {0.5f, 0.8734150024498},
                                {0.75f, 0.9739092997715},
                                {1, 1}}) {
            RunningStats edge, corner;
            Sampler random = random_numbers(1);
            for (int repeat = 0; repeat < repeats; repeat++) {
                auto photons = on_a_square(n, random, 1.0f / n);
                edge.add(irradiance_at(floor_at(t * r, 0.5f), photons, r));
                corner.add(irradiance_at(floor_at(0, 0), photons, r));
            }
            check_bounded(edge, share, 0.03);
            check_bounded(corner, 0.25, 0.04);
        }
    }

    TEST_CASE("truth: the mean over the disk blurs what is not even") {
        // Irradiance a + b |x|^2 around the middle: too bright by c r^2 laplacian = 4 b c r^2 (G6).
        constexpr int n = 2000, repeats = 200;
        constexpr float r = 0.4f;
        RunningStats stats;
        Sampler random = random_numbers(1);
        for (int repeat = 0; repeat < repeats; repeat++) {
            auto photons = on_a_square(n, random, 1.0f / n);
            for (Photon& photon : photons) {
                float x = photon.p.x - 0.5f, z = photon.p.z - 0.5f;
                photon.flux = (1 + 8 * (x * x + z * z)) * photon.flux;
            }
            stats.add(irradiance_at(floor_at(0.5f, 0.5f), photons, r));
        }
        check_bounded(stats, 1 + 32 / 12.0 * 0.16, 0.01);
    }

    TEST_CASE("failure: no light leaks through a thin wall, round a corner, or between sheets") {
        Sampler random = random_numbers(1);
        auto photons = on_a_square(1000, random, 0.001f);
        Hit x = floor_at(0.5f, 0.5f);
        CHECK(irradiance_at(x, photons, 0.1f) > 0.3);
        Hit behind = x;  // the other side of the same wall
        behind.n = behind.ng = {0, -1, 0};
        CHECK(irradiance_at(behind, photons, 0.1f) == 0);
        Hit wall = x;  // stands on the floor
        wall.n = wall.ng = {1, 0, 0};
        CHECK(irradiance_at(wall, photons, 0.1f) == 0);
        Hit below = x;  // a second floor, r / 2 deeper
        below.p.y = -0.05f;
        CHECK(irradiance_at(below, photons, 0.1f) == 0);
    }
}

TEST_SUITE("ch23 photon mapping") {
    TEST_CASE("failure: with one radius the error stops falling, where light is not even" *
              doctest::skip()) {
        Scene scene = bulb_over_a_floor();
        Film exact = film_of(scene, by_15(scene), 10000).film;
        auto error = [&](int spp) {
            RunningStats mse;
            for (uint32_t seed = 1; seed <= 6; seed++) {
                Method method = ch23::photon_passes(
                    scene,
                    {.seed = seed, .light_paths = 1000, .final_gathering = false, .radius = 0.4f});
                mse.add(mean_squared_error(film_of(scene, method, spp, seed).film, exact));
            }
            return mse.mean();
        };
        double few = error(128), many = error(1024);
        CHECK(many == nearly(few, 0.1));
        CHECK(many > 0.005);
    }

    TEST_CASE("agreement: glossy metal, mirrors and glass with chapters 15 and 21" *
              doctest::skip()) {
        for (std::string name : {"veach-mis", "cornell-spheres"}) {
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 5);
            const std::string classes = name == "veach-mis" ? "LDD+E" : "L(D|S)+E";
            Method method =
                ch23::photon_passes(scene, {.light_paths = 5000, .radius = 0.01f * scene.radius});
            Measured m = picture_of(scene, method, 128, classes);
            Measured truth = picture_of(scene, by_22(scene), 256, classes);
            check_near(m, truth, 0.01, 0.015);
        }
    }

    TEST_CASE("agreement: smoothed normals with chapter 15") {
        // A flat sheet that pretends to lean, on the left towards the sun, on the right away from
        // it, so that no light is reflected: photons alone, at small radii.
        Scene scene = world_of(
            "LightSource \"distant\" \"point3 from\" [3 4 -5]\n"
            "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-1.6 -1.6 0 "
            "-1.6 1.6 0 1.6 1.6 0 1.6 -1.6 0] \"normal N\" [0 1 -1 0 1 -1 0 -5 -2 0 -5 -2]\n",
            16);
        scene.max_depth = 1;
        Method method = ch23::photon_passes(
            scene, {.light_paths = 40000, .final_gathering = false, .radius = 0.05f});
        check_near(picture_of(scene, method, 32), picture_of(scene, by_15(scene), 256), 0.01, 0.01);
    }
}

TEST_SUITE("ch23 first radius") {
    /// Photons around each of 20,000 points, `n` within the radius 1: their flux is 1 + c d^2.
    std::vector<Photon> around_points(int n, float c, std::vector<SeenPoint>& points) {
        Sampler random(SamplerType::independent, 1, 1);
        std::vector<Photon> photons;
        for (int i = 0; i < 20000; i++) {
            Vec3 p = 10 * Vec3{static_cast<float>(i % 100), 0, static_cast<float>(i / 100)};
            points.push_back({p, {0, 1, 0}, 1 / pi, 1 / 6.0f});
            for (int j = 0; j < n; j++) {
                float d = std::sqrt(random.u1()), phi = 2 * pi * random.u1();
                float flux = (1 + c * d * d) / static_cast<float>(n);
                Vec3 at = p + d * Vec3{std::cos(phi), 0, std::sin(phi)};
                photons.push_back({at, {0, 1, 0}, {flux, flux, flux}});
            }
        }
        return photons;
    }

    /// The mean of d is that of e times c r^2 / 4 (c r^2 / 3 with the radius, c r^2 / 12 with
    /// half). The mean of e^2: integral of 4 (1 - q)^2 (1 + c r^2 q)^2 over q. Pairs of n photons:
    /// n (n - 1).
    double expected_ratio(int n, double c, double r) {
        double a = c * r * r, e2 = 4 * (1.0 / 3 + a / 6 + a * a / 30);
        return (n - 1) * r * r * a * a / 16 / e2;
    }

    TEST_CASE("truth: blur and variance of light that grows with the distance") {
        for (float c : {0.0f, 1.0f, 4.0f}) {
            for (int n : {3, 10}) {
                std::vector<SeenPoint> points;
                auto photons = around_points(n, c, points);
                double ratio = blur_to_noise(points, PhotonMap(photons, 1));
                CHECK(std::abs(ratio - expected_ratio(n, double{c}, 1)) < 0.1);
            }
        }
        // A point with the radiance L counts 1 / (L^2 + 0.01).
        std::vector<SeenPoint> points;
        auto photons = around_points(10, 4, points);
        double even = blur_to_noise(points, PhotonMap(photons, 1));
        for (size_t i = 0; i < photons.size() / 2; i++)
            photons[i].flux = 3.0f * photons[i].flux, points[i / 10].L = std::sqrt(0.08);
        CHECK(blur_to_noise(points, PhotonMap(photons, 1)) == nearly(even, 1e-3));
        CHECK(blur_to_noise({}, {}) == 0);
    }

    TEST_CASE("truth: the first radius is where light of a known profile blurs that much") {
        // Even light does not blur: six pixels. With c = 4 the ratio is above 1 at first.
        for (float c : {0.0f, 1.5f, 4.0f}) {
            std::vector<SeenPoint> points;
            auto photons = around_points(20, c, points);
            for (double share : {1.0, 0.5}) {
                double r = 1, ratio = expected_ratio(20, double{c}, r) / share;
                while (ratio > 1) {
                    r /= std::numbers::sqrt2;
                    ratio = expected_ratio(20, double{c}, r) / share;
                }
                r *= std::pow(0.04 / std::max(ratio, 0.04), 0.25);
                CHECK(double{first_radius(points, {}, photons, share)} == nearly(r, 0.05));
            }
        }
    }

    TEST_CASE("truth: the width of a pixel on a floor") {
        // A floor 1 m below a camera of 60 degrees. The median ray is 1.1 times as long as the
        // one in the middle. A picture with fewer than 128x128 pixels counts as one with as many.
        auto width_of = [](int pixels) {
            Scene scene = bulb_over_a_floor();
            scene.width = scene.height = pixels;
            return double{pixel_width(seen_points(scene))};
        };
        double width = 1.1 * 2 * std::tan(pi_exact / 6) / 128;
        CHECK(width_of(128) == nearly(width, 0.03));
        CHECK(width_of(32) == nearly(width_of(128), 1e-4));
        CHECK(width_of(256) == nearly(width_of(128) / 2, 1e-4));
    }
}
