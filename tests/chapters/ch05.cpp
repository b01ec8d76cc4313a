// Chapter 05: Whitted's ray tracing: exact where it sees, and blind to the rest.
#include <doctest/doctest.h>

#include "chapters/05_ray_casting/estimator.h"
#include "common/geometry/shapes.h"
#include "common/recording/class_filter.h"
#include "tests/known/scenes.h"
#include "tests/support/estimators.h"

namespace {

/// What chapter 05 sees along the ray, and by which classes.
struct Seen {
    Rgb L;
    std::map<std::string, double> classes;
    uint64_t cut = 0;
};

Seen look(const Scene& scene, Vec3 from, Vec3 to, uint32_t seed = 1) {
    Sampler sampler = random_numbers(seed);
    Recorder recorder(true);
    recorder.start();
    Seen seen;
    seen.L = ch05::trace(scene, {from, normalize(to - from)}, sampler, recorder);
    for (const Contribution& part : recorder.contributions()) {
        seen.classes[part.path_class] += static_cast<double>(average(part.L));
    }
    seen.cut = recorder.paths_cut();
    return seen;
}

/// The irradiance that chapter 05 finds at the floor point (x, 0, 0).
double irradiance(const Scene& scene, float x) {
    return static_cast<double>(look(scene, {x - 3, 0.4f, 0}, {x, 0, 0}).L.g) * pi_exact;
}

bool is_close(double value, double truth) { return std::abs(value - truth) < 2e-6 * truth; }

}  // namespace

TEST_SUITE("ch05 random scenes") {
    TEST_CASE("brute: in random scenes a ray hits what the hierarchy says") {
        Sampler random = random_numbers(1);
        int met = 0;
        for (uint32_t number = 0; number < 100; number++) {
            Scene scene = parse_scene("world.pbrt", random_world(9, number), nullptr);
            prepare(scene, 1);
            auto view = ch05::camera_view(scene.camera, scene.width, scene.height);
            for (int i = 0; i < 200; i++) {
                Ray ray = ch05::camera_ray(view, random.u2());
                PrimHit found = ch05::linear_scan(scene.geometry, ray);
                std::optional<Hit> hit = intersect(scene, ray);
                CAPTURE(number);
                REQUIRE((found.prim != PrimHit::none) == hit.has_value());
                if (!hit) continue;
                met++;
                float t = length(hit->p - ray.o);
                CHECK(std::abs(found.t - t) < 1e-3f * t);
            }
        }
        CHECK(met > 10000);
    }
}

TEST_SUITE("ch05 lamps") {
    TEST_CASE("truth: a point light gives I cos / r^2") {
        Scene scene = floor_under("LightSource \"point\" \"point3 from\" [0 2 0]");
        CHECK(is_close(irradiance(scene, 1), 0.1788854382));
        CHECK(is_close(irradiance(scene, 0), 0.25));
        scene = floor_under("LightSource \"point\" \"point3 from\" [0 0.001 0] \"rgb I\" [1 1 1]");
        CHECK(std::abs(irradiance(scene, 0) / 1e6 - 1) < 0.01);  // large, but right
    }

    TEST_CASE("truth: a distant light gives E cos, and its shadows are parallel") {
        Scene scene = floor_under(
            "LightSource \"distant\" \"point3 from\" [3 4 0] \"point3 to\" [0 0 0] \"rgb L\" [5 5 "
            "5]\n"
            "Translate 3 4 0 Shape \"sphere\" \"float radius\" 0.5 "
            "Translate 2937 3996 0 Shape \"sphere\" \"float radius\" 0.5");
        CHECK(is_close(irradiance(scene, 2), 4));
        CHECK(is_close(irradiance(scene, -30), 4));
        CHECK(irradiance(scene, 0.3f) == 0);
        CHECK(irradiance(scene, -60) == 0);  // from five kilometres away
    }

    TEST_CASE("truth: a square is two lamps, each in the middle of its triangle") {
        for (float h : {10.0f, 1.0f}) {
            Scene scene = floor_under(shining + "Scale 0.5 1 0.5 " + square(h, false));
            double r2 = static_cast<double>(h) * h + 1.0 / 18;  // the middles are 1/6, 1/6 aside
            CHECK(is_close(irradiance(scene, 0), static_cast<double>(h) * h / (r2 * r2)));
        }
    }

    TEST_CASE("failure: lamps as points are right far away, and wrong close by") {
        for (auto [h, E, wrong] : {std::tuple{10.0f, 0.009966782906402, 0.003},
                                   {1.0f, 0.7522746884541, 0.2},
                                   {0.1f, 3.04212843837, 0.3}}) {
            Scene scene = floor_under(shining + "Scale 0.5 1 0.5 " + square(h, false));
            double error = std::abs(irradiance(scene, 0) / E - 1);
            CHECK(error < wrong);
            CHECK(error > wrong / 2);
        }
    }

    TEST_CASE("identity: nothing from the back of a lamp, from below, or through a wall") {
        CHECK(irradiance(floor_under(shining + square(2, true)), 0) == 0);
        CHECK(irradiance(floor_under("LightSource \"point\" \"point3 from\" [0 -2 0]"), 0) == 0);
        std::string lamp = "LightSource \"point\" \"point3 from\" [0 2 0]\n";
        CHECK(irradiance(floor_under(lamp + square(1, true)), 0.5f) == 0);
        CHECK(irradiance(floor_under(lamp + square(1, true)), 5) > 0);
        std::string two_sided = "AreaLightSource \"diffuse\" \"bool twosided\" true\n";
        CHECK(irradiance(floor_under(two_sided + square(2, true)), 0) ==
              irradiance(floor_under(shining + square(2, false)), 0));
    }

    TEST_CASE("identity: a bent normal sees no lamp below the surface, and none behind itself") {
        // The floor's normals lean towards +x: one ball is before them, but below the floor; one is
        // above the floor, but behind them. A third is both before and above.
        for (auto [ball, L] :
             {std::pair{"4 -1.5 0", 0.0}, {"-4 1.5 0", 0.0}, {"4 1.5 0", 0.0525884}}) {
            Scene scene = world_of(
                "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n"
                "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\""
                " [-50 0 -50  -50 0 50  50 0 50  50 0 -50]"
                " \"normal N\" [.8 .6 0  .8 .6 0  .8 .6 0  .8 .6 0] AttributeEnd\n" +
                shining + "Translate " + ball + " Shape \"sphere\"\n");
            CHECK(std::abs(static_cast<double>(look(scene, {0, 1, 0}, {0, 0, 0}).L.g) - L) < 1e-6);
        }
    }

    TEST_CASE("truth: what is just below a lamp hides it, what is just behind it does not, in 05") {
        for (float gap : {1e-4f, -1e-4f}) {
            Scene scene = world_of("AttributeBegin Material \"diffuse\" " + square(0, true) +
                                   "AttributeEnd AttributeBegin " + shining + disk(1, 2) +
                                   "AttributeEnd Translate 0 " + std::to_string(2 - gap) + " 0 " +
                                   square(0, false));
            CHECK((irradiance(scene, 0) == 0) == (gap > 0));
        }
    }
}

TEST_SUITE("ch05 camera") {
    TEST_CASE("identity: the field of view lies across the shorter side, and a pixel is square") {
        for (auto [width, height] : {std::pair{60, 40}, {40, 60}, {40, 40}}) {
            Camera camera;
            camera.fov = 90;
            camera.right = {1, 0, 0}, camera.up = {0, 1, 0}, camera.forward = {0, 0, 1};
            ch05::CameraView view = ch05::camera_view(camera, width, height);
            float w = static_cast<float>(width), h = static_cast<float>(height);
            Vec3 corner = view.corner, middle = corner + w / 2 * view.dx + h / 2 * view.dy;
            float half = std::min(w, h) / 2;
            CHECK(length(middle - camera.forward) < 1e-6f);
            CHECK(length(half * view.dx - camera.right) < 1e-6f);
            CHECK(length(half * view.dy + camera.up) < 1e-6f);
        }
    }
}

TEST_SUITE("ch05 mirrors and glass") {
    TEST_CASE("truth: a pane of glass, up to the branches that are too faint") {
        // T = (1 - R)^2 (1 + R^2 + ...), R = 0.04: the second term is dropped; so are those of
        // R_slab = R + (1 - R)^2 R (1 + R^2 + ...)
        std::string pane = "AttributeBegin Material \"dielectric\" Rotate 90 1 0 0 Scale 9 1 9 " +
                           square(0, false) + square(0.1f, true) + "AttributeEnd\n";
        Seen through = look(world_of(pane + "LightSource \"infinite\""), {0, 0, -4}, {0, 0, 0});
        CHECK(std::abs(through.classes["LSSE"] - 0.9216) < 1e-6);
        CHECK(std::abs(through.classes["LSE"] - 0.04) < 1e-6);
        CHECK(std::abs(through.classes["LSSSE"] - 0.036864) < 1e-6);
        CHECK(through.classes.size() == 3);
        CHECK(through.L.g > 0.998f);
    }

    TEST_CASE("failure: a ray that glass reflects for ever ends at the depth limit, and says so") {
        Scene scene = world_of(
            "LightSource \"infinite\" Material \"dielectric\"\n"
            "Shape \"trianglemesh\" \"integer indices\" [0 3 1 0 2 3 4 7 6 4 5 7 0 5 4 0 1 5"
            " 2 7 3 2 6 7 0 6 2 0 4 6 1 7 5 1 3 7]\n \"point3 P\" [-1 -1 -1  1 -1 -1"
            "  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]");
        Seen seen = look(scene, {0.1f, 0.2f, 0.3f}, {1.1f, 1.2f, 1.3f});
        CHECK(seen.cut == 1);
        CHECK(is_black(seen.L));
        seen = look(scene, {0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 5});
        CHECK(seen.cut == 0);
        CHECK(std::abs(seen.L.g - 2.25f) < 0.01f);  // inside glass light is n^2 as bright
    }
}

TEST_SUITE("ch05 classes of paths") {
    TEST_CASE("identity: only LE, LDE, LS+E and LDS+E, and together they are the whole") {
        for (const char* file : {"cornell-spheres", "cornell", "caustic"}) {
            Scene scene = scene_from("scenes/" + std::string(file) + ".pbrt", 32, 100);
            Census census = census_of(scene, ch05::trace, 4000, 1);
            for (const auto& [name, sum] : census.parts) {
                const std::string& path_class = name;
                CAPTURE(path_class);
                if (name[0] == 'L') CHECK(ClassFilter("LD?S*E").matches(path_class));
            }
            CHECK(census.parts.contains("LDE"));
            if (std::string(file) != "cornell") CHECK(census.parts.contains("LDSE"));
        }
    }

    TEST_CASE("truth: a lamp in a mirror, and the sky in six") {
        for (const char* name : {"reflection", "corridor"}) {
            const KnownScene& known = known_scene(name);
            Census census = census_of(scene_of(known.text), ch05::trace, 1000, 1);
            double truth = known.light.at("all").mean;
            CHECK(census.measured("all").mean == nearly(truth, 1e-4));
        }
    }

    TEST_CASE("failure: no caustic: glass casts the shadow of a stone") {
        Scene scene = floor_under(
            "LightSource \"point\" \"point3 from\" [0 4 0]\n"
            "Material \"dielectric\" Translate 0 1.5 0 Shape \"sphere\"");
        CHECK(irradiance(scene, 0) == 0);
        CHECK(irradiance(scene, 5) > 0);
    }

    TEST_CASE("identity: --max-depth 0 shows lamps only, 1 direct light, 2 the first mirror") {
        Scene scene = scene_from("scenes/cornell-spheres.pbrt", 32, 0);
        for (int depth : {0, 1, 2}) {
            scene.max_depth = depth;
            Census census = census_of(scene, ch05::trace, 4000, 1);
            CHECK(census.parts.contains("length " + std::to_string(depth)));
            CHECK_FALSE(census.parts.contains("length " + std::to_string(depth + 1)));
            CHECK(census.parts.contains("LE"));
        }
    }
}
