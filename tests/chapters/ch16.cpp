// Chapter 16: the lens and the shutter.
#include <doctest/doctest.h>

#include "chapters/16_lens_and_shutter/estimator.h"
#include "common/geometry/transform.h"
#include "common/scene/mover.h"
#include "tests/support/estimators.h"

namespace {

Method by_sixteen(const Scene& scene) { return method_of<ch16::trace>(ch16::prepare(scene)); }

/// A camera at the origin that looks along +z, with a lens of radius 0.1 that is sharp at 2.
Camera camera_with_lens(bool mirrored) {
    Camera camera;
    camera.right = {mirrored ? -1.0f : 1.0f, 0, 0}, camera.up = {0, 1, 0},
    camera.forward = {0, 0, 1};
    camera.lens_radius = 0.1f, camera.focal_distance = 2;
    return camera;
}

/// Where the ray is at this depth.
Vec3 at_depth(const Ray& ray, float z) { return ray.o + (z - ray.o.z) / ray.d.z * ray.d; }

const std::string black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0] ";

/// The share of a picture's relMSE that is the variance of means over all other dimensions, for
/// fixed points of the pixel, and of the lens or the time: pairs of paths share nothing but these.
double noise_of(Scene scene, bool lens, bool time) {
    const Camera camera = scene.camera;
    CameraView view = camera_view(camera, scene.width, scene.height);
    if (lens) scene.camera.lens_radius = 0;
    Method trace = by_sixteen(scene);
    Sampler dimensions = random_numbers(7), sampler = random_numbers(8);
    Recorder recorder;
    constexpr int n = 128;
    double shared = 0, all = 0;
    for (int pixel = 0; pixel < scene.width * scene.height; pixel++) {
        double sum = 0, squares = 0, products = 0;
        for (int i = 0; i < n; i++) {
            Vec2 v = dimensions.u2(), u = dimensions.u2();
            Vec2 film = {static_cast<float>(pixel % scene.width) + v.x,
                         static_cast<float>(pixel / scene.width) + v.y};
            Ray ray = camera_ray(view, film);
            if (lens) ray = ch16::through_lens(camera, ray, u);
            if (time) {
                float t = ch16::sample_time(camera, u.x);
                scene.camera.shutter_open = scene.camera.shutter_close = t;
            }
            double a = static_cast<double>(average(trace(scene, ray, sampler, recorder)));
            double b = static_cast<double>(average(trace(scene, ray, sampler, recorder)));
            sum += (a + b) / 2 / n, squares += (a * a + b * b) / 2 / n, products += a * b / n;
        }
        double scale = 1 / (sum * sum + 0.01);
        shared += scale * (products - sum * sum), all += scale * (squares - sum * sum);
    }
    return shared / all;
}

}  // namespace

TEST_SUITE("ch16 lens and shutter") {
    TEST_CASE("variance: which dimensions of a pixel carry the noise" * doctest::skip()) {
        Scene bokeh = scene_from("scenes/bokeh.pbrt", 24, 8);
        Scene ball = scene_from("scenes/moving-ball.pbrt", 24, 8);
        CHECK(noise_of(bokeh, false, false) < 0.06);
        CHECK(noise_of(bokeh, true, false) > 0.85);
        CHECK(noise_of(ball, false, false) < 0.2);
        double with_time = noise_of(ball, false, true);
        CHECK(with_time > 0.4);
        CHECK(with_time < 0.65);
    }
}

TEST_SUITE("ch16 pixel") {
    Film zone_plate(int spp, bool centre) {
        Scene scene = scene_from("scenes/zone-plate.pbrt", 128, 0);
        scene.camera.pixel_centre = centre;
        return film_of(scene, by_sixteen(scene), spp, 0, SamplerType::sobol).film;
    }

    TEST_CASE("failure: the middles of pixels alone see rings that are not there" *
              doctest::skip()) {
        // Where rings are narrower than a pixel, the mean of 4 x 4 pixels is nearly one half.
        auto off = [](const Film& film) {
            double worst = 0;
            for (int y = 0; y < 128; y += 4)
                for (int x = 0; x < 128; x += 4) {
                    if (std::hypot(x - 62, y - 62) < 20) continue;
                    worst = std::max(worst, std::abs(block_of(film, x, y, 4).mean - 0.5));
                }
            return worst;
        };
        Film centre = zone_plate(1, true);
        CHECK(off(zone_plate(64, false)) < 0.1);
        CHECK(off(centre) > 0.4);
        // More samples of the same point change nothing.
        CHECK(zone_plate(4, true).image().pixels == centre.image().pixels);
    }
}

TEST_SUITE("ch16 lens") {
    TEST_CASE("truth: circles of confusion") {
        // In the plane of focus a point at depth z is a disk of radius a |z - F| / z.
        Sampler random = random_numbers(1);
        for (auto [z, radius] : {std::pair{4.0f, 0.05f}, {1, 0.1f}, {2, 0}, {100, 0.098f}}) {
            float widest = 0;
            for (int i = 0; i < 1000; i++) {
                Camera camera = camera_with_lens(i % 2 == 0);
                // A pinhole ray through the point's disk; its lens ray at the rim of the lens.
                Vec2 rim = {0x1.fffffep-1f, random.u1()};
                Ray pinhole = {{0, 0, 0},
                               normalize(uniform_direction(random.u2()) + Vec3{0, 0, 2})};
                Ray ray = ch16::through_lens(camera, pinhole, rim);
                Vec3 sharp = at_depth(pinhole, 2), p = at_depth(ray, z);
                // All rays of a film point meet in the plane of focus, on and off the axis.
                CHECK(length(at_depth(ray, 2) - sharp) < 1e-6f);
                // Seen back from p, the centre of the lens is displaced by what the lens is wide.
                widest = std::max(widest, length(at_depth({p, p}, 2) - sharp));
            }
            CHECK(widest < radius * 1.0001f + 4e-6f);
            CHECK(widest > radius * 0.999f - 1e-6f);
        }
    }

    TEST_CASE("density: all points of the lens are equally likely") {
        Camera camera = camera_with_lens(false);
        Sampler random = random_numbers(2);
        RunningStats x2, r2;
        for (int i = 0; i < 400000; i++) {
            Vec3 o = ch16::through_lens(camera, {{0, 0, 0}, {0, 0, 1}}, random.u2()).o;
            CHECK(o.z == 0);
            x2.add(100 * static_cast<double>(o.x * o.x));
            r2.add(100 * static_cast<double>(o.x * o.x + o.y * o.y));
        }
        check_mean(x2, 0.25, 1.0 / 16, 0.004);  // r = u in place of sqrt(u): 1/6
        check_mean(r2, 0.5, 1.0 / 12, 0.004);
    }
}

TEST_SUITE("ch16 shutter") {
    /// White behind; what is in front moves, and is black.
    Scene before_white(const std::string& mover) {
        Scene scene =
            world_of("LightSource \"infinite\" AttributeBegin " + black + mover + " AttributeEnd");
        scene.max_depth = 0;
        return scene;
    }
    /// A disk of radius 1/4 that goes from x = -1/2 to 1/2.
    const std::string disk_on_its_way =
        "Translate -0.5 0 0 ActiveTransform EndTime Translate 1 0 0 ActiveTransform All "
        "Shape \"disk\" \"float radius\" 0.25";

    TEST_CASE("truth: how long what moves covers a point") {
        std::string edge =
            "Translate 0.2 0 0 ActiveTransform EndTime Translate 0.6 0 0 ActiveTransform All "
            "Translate -5 0 0 Rotate 90 1 0 0 Scale 5 1 5 " +
            square(0, true);
        struct {
            std::string mover;
            Vec3 p;
            double covered;
        } cases[] = {{disk_on_its_way, {0, 0, 0}, 0.5},
                     {disk_on_its_way, {0, 0.2f, 0}, 0.3},
                     {disk_on_its_way, {-0.5f, 0, 0}, 0.25},
                     {disk_on_its_way, {0, 0.26f, 0}, 0},
                     {edge, {0.5f, 0, 0}, 0.5},
                     {edge, {0.35f, 0, 0}, 0.75},
                     {edge, {0.1f, 0, 0}, 1},
                     {edge, {0.9f, 0, 0}, 0}};
        for (const auto& c : cases) {
            Scene scene = before_white(c.mover);
            RunningStats s =
                repeat(scene, {c.p - Vec3{0, 0, 3}, {0, 0, 1}}, by_sixteen(scene), 100000);
            check_mean(s, 1 - c.covered, c.covered * (1 - c.covered) + 1e-9, 0.014);
        }
    }

    TEST_CASE("truth: a shutter that opens late and closes early sees part of the way") {
        Scene scene = before_white(disk_on_its_way);
        scene.camera.shutter_open = 0.25f, scene.camera.shutter_close = 0.5f;  // x from -0.25 to 0
        // It covers 0.15 to each side: all the time, never, from x = -0.1 on.
        for (auto [x, seen] : {std::pair{-0.125f, 0.0}, {0.25f, 1}, {0.05f, 0.6}}) {
            RunningStats s = repeat(scene, {{x, 0.2f, -3}, {0, 0, 1}}, by_sixteen(scene), 100000);
            check_mean(s, seen, seen * (1 - seen), 0.013);
        }
    }
}
