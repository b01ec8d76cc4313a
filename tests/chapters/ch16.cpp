// Chapter 16: the lens and the shutter.
#include <doctest/doctest.h>

#include <array>

#include "chapters/15_mis_ris/estimator.h"
#include "chapters/16_lens_and_shutter/estimator.h"
#include "tests/support/estimators.h"

namespace {

Method by_fifteen(const Scene& scene) { return method_of<ch15::trace>(ch15::prepare(scene)); }
Method by_sixteen(const Scene& scene) { return method_of<ch16::trace>(ch16::prepare(scene)); }

/// A camera at the origin that looks along +z, with a lens of radius 0.1 that is sharp at 2.
Camera camera_with_lens() {
    Camera camera;
    camera.right = {1, 0, 0}, camera.up = {0, 1, 0}, camera.forward = {0, 0, 1};
    camera.lens_radius = 0.1f, camera.focal_distance = 2;
    return camera;
}

/// Where the ray is at this depth.
Vec3 at_depth(const Ray& ray, float z) { return ray.o + (z - ray.o.z) / ray.d.z * ray.d; }

const std::string black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0] ";

const std::string white_floor =
    "Material \"diffuse\" \"rgb reflectance\" [1 1 1] Scale 500 1 500 " + square(0, true);

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
    TEST_CASE("identity: where nothing is new, each picture is chapter 15's, bit for bit") {
        for (std::string name :
             {"cornell", "cornell-spheres", "thousand-lights", "veach-mis", "leaning wall"}) {
            CAPTURE(name);
            Scene scene = name == "leaning wall" ? leaning_wall()
                                                 : scene_from("scenes/" + name + ".pbrt", 16, 8);
            for (SamplerType sampler :
                 {SamplerType::independent, SamplerType::stratified, SamplerType::sobol}) {
                Rendering before = film_of(scene, by_fifteen(scene), 4, 1, sampler);
                Rendering now = film_of(scene, by_sixteen(scene), 4, 1, sampler);
                CHECK(before.film.image().pixels == now.film.image().pixels);
                CHECK(before.stats.rays == now.stats.rays);
            }
        }
    }

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
    constexpr int size = 128;

    /// Whether the zone plate is white at this point of the film, in pixels: 401 rings of equal
    /// area, out to 1.5 times half the picture.
    bool is_white(double x, double y) {
        double r = std::hypot(x - size / 2, y - size / 2) / (size / 2);
        return static_cast<int>(401 * r * r / 2.25) % 2 == 0;
    }
    double mean_of_pixel(int x, int y) {
        int white = 0, n = 64;
        for (int i = 0; i < n * n; i++)
            white += is_white(x + (i % n + 0.5) / n, y + (i / n + 0.5) / n);
        return static_cast<double>(white) / (n * n);
    }

    Image zone_plate(SamplerType type, int spp, bool centre = false) {
        Scene scene = scene_from("scenes/zone-plate.pbrt", size, 0);
        scene.spp = spp;
        RenderOptions options;
        options.sampler = type, options.threads = 2, options.quiet = true;
        scene.camera.pixel_centre = centre;
        return render_film(scene, options, by_sixteen(scene)).film.image();
    }

    TEST_CASE("failure: the middles of pixels alone see rings that are not there" *
              doctest::skip()) {
        // Where rings are narrower than a pixel, the mean of 4 x 4 pixels is nearly one half.
        Image area = zone_plate(SamplerType::sobol, 64);
        Image centre = zone_plate(SamplerType::sobol, 1, true);
        auto off = [](const Image& image) {
            double worst = 0;
            for (int y = 0; y < size; y += 4)
                for (int x = 0; x < size; x += 4) {
                    if (std::hypot(x - 62, y - 62) < 20) continue;
                    double sum = 0;
                    for (int i = 0; i < 16; i++) sum += double{image.at(x + i % 4, y + i / 4).g};
                    worst = std::max(worst, std::abs(sum / 16 - 0.5));
                }
            return worst;
        };
        CHECK(off(area) < 0.1);
        CHECK(off(centre) > 0.4);
        // More samples of the same point change nothing.
        CHECK(zone_plate(SamplerType::sobol, 4, true).pixels == centre.pixels);
    }
}

TEST_SUITE("ch16 lens") {
    TEST_CASE("truth: circles of confusion") {
        // In the plane of focus a point at depth z is a disk of radius a |z - F| / z.
        Camera camera = camera_with_lens();
        struct {
            float z, radius;
        } cases[] = {{4, 0.05f}, {1, 0.1f}, {2, 0}, {100, 0.098f}};
        Sampler random = random_numbers(1);
        for (auto [depth, radius] : cases) {
            float z = depth;  // clang 14 cannot capture the names in [ ]
            float widest = 0;
            for (int i = 0; i < 1000; i++) {
                // A pinhole ray through the point's disk; its lens ray at the rim of the lens.
                Vec2 rim = {0x1.fffffep-1f, random.u1()};
                Ray pinhole = {{0, 0, 0},
                               normalize(uniform_direction(random.u2()) + Vec3{0, 0, 2})};
                Ray ray = ch16::through_lens(camera, pinhole, rim);
                Vec3 sharp = at_depth(pinhole, 2), p = at_depth(ray, z);
                // All rays of a film point meet in the plane of focus, on and off the axis.
                CHECK(length(at_depth(ray, 2) - sharp) < 1e-6f);
                // Seen back from p, the centre of the lens is displaced by what the lens is wide.
                Vec3 back = at_depth({p, p}, 2) - sharp;
                widest = std::max(widest, length(back));
                CHECK(length(back) < radius * 1.0001f + 4e-6f);
            }
            CHECK(widest > radius * 0.999f - 1e-6f);
        }
    }

    TEST_CASE("density: all points of the lens are equally likely") {
        Camera camera = camera_with_lens();
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

    TEST_CASE("truth: how long what moves covers a point") {
        std::string disk =
            "Translate -0.5 0 0 ActiveTransform EndTime Translate 1 0 0 ActiveTransform All "
            "Shape \"disk\" \"float radius\" 0.25";
        std::string edge =
            "Translate 0.2 0 0 ActiveTransform EndTime Translate 0.6 0 0 ActiveTransform All "
            "Translate -5 0 0 Rotate 90 1 0 0 Scale 5 1 5 " +
            square(0, true);
        struct {
            std::string mover;
            Vec3 p;
            double covered;
        } cases[] = {{disk, {0, 0, 0}, 0.5},      {disk, {0, 0.2f, 0}, 0.3},
                     {disk, {-0.5f, 0, 0}, 0.25}, {disk, {0, 0.26f, 0}, 0},
                     {edge, {0.5f, 0, 0}, 0.5},   {edge, {0.35f, 0, 0}, 0.75},
                     {edge, {0.1f, 0, 0}, 1},     {edge, {0.9f, 0, 0}, 0}};
        for (const auto& c : cases) {
            Scene scene = before_white(c.mover);
            RunningStats s =
                repeat(scene, {c.p - Vec3{0, 0, 3}, {0, 0, 1}}, by_sixteen(scene), 100000);
            check_mean(s, 1 - c.covered, c.covered * (1 - c.covered) + 1e-9, 0.014);
        }
    }

    TEST_CASE("truth: a shutter that opens late and closes early sees part of the way") {
        Scene scene = before_white(
            "Translate -0.5 0 0 ActiveTransform EndTime Translate 1 0 0 ActiveTransform All "
            "Shape \"disk\" \"float radius\" 0.25");
        scene.camera.shutter_open = 0.25f, scene.camera.shutter_close = 0.5f;  // x from -0.25 to 0
        Ray ray = {{-0.125f, 0.2f, -3}, {0, 0, 1}};
        RunningStats s = repeat(scene, ray, by_sixteen(scene), 1000);
        CHECK(s.mean() == 0);  // covered all the time: 0.15 to each side
        ray.o.x = 0.25f;       // covered from x = 0.1 on: never
        CHECK(repeat(scene, ray, by_sixteen(scene), 1000).mean() == 1);
        ray.o.x = 0.05f;  // covered from x = -0.1 on: the last 40 %
        check_mean(repeat(scene, ray, by_sixteen(scene), 100000), 0.6, 0.24, 0.013);
    }

    TEST_CASE("truth: a shape that moves is where its parts are at each time") {
        // A turn of 90 degrees, a stretch from 1 to 3 and a move, each for itself known.
        Transform start = translation({1, 2, 3});
        Transform end = translation({3, 2, 1}) * rotation(90, {0, 0, 1}) * scaling({3, 1, 1});
        Motion motion(start, end);
        for (double t : {0.0, 0.25, 0.5, 1.0}) {
            Transform expected = translation({1 + 2 * t, 2, 3 - 2 * t}) *
                                 rotation(90 * t, {0, 0, 1}) * scaling({1 + 2 * t, 1, 1});
            for (Vec3d p : {Vec3d{1, 0, 0}, Vec3d{0.3, -2, 5}}) {
                Vec3d is = transform_point(motion.at(t), p);
                CHECK(length(is - transform_point(expected, p)) < 1e-12);
            }
        }
        // The shorter way round, a half turn, a mirror, and no way at all.
        Transform back = rotation(350, {0, 1, 0});
        CHECK(length(transform_point(Motion({}, back).at(0.5), {1, 0, 0}) -
                     transform_point(rotation(-5, {0, 1, 0}), {1, 0, 0})) < 1e-12);
        for (const Transform& m : {rotation(180, {1, 2, 3}), scaling({-1, 1, 1}),
                                   scaling({-2, -3, -4}) * rotation(77, {3, 1, 1}), Transform{}}) {
            Motion way({}, m);
            for (Vec3d p : {Vec3d{1, 0, 0}, Vec3d{0.3, -2, 5}}) {
                CHECK(length(transform_point(way.at(1), p) - transform_point(m, p)) < 1e-12);
                CHECK(length(transform_point(way.at(0), p) - p) < 1e-12);
            }
        }
    }

    TEST_CASE("brute: at each time, hits as of the same scene at rest") {
        // A tetrahedron, a ball and a disk that move and turn, against copies that are put where
        // they are at the time.
        const std::string shapes[] = {
            "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 1 3 1 2 3 0 3 2] \"point3 P\" "
            "[-.5 -.5 -.5  .5 -.5 -.5  0 -.5 .5  0 .5 0]",
            "Shape \"sphere\" \"float radius\" 0.4", "Shape \"disk\" \"float radius\" 0.6"};
        auto matrix = [](const Transform& t) {
            std::string text = "ConcatTransform [";
            for (Vec3d c : {t.x, t.y, t.z}) {
                for (double x : {c.x, c.y, c.z}) text += std::to_string(x) + " ";
                text += "0 ";
            }
            for (double x : {t.o.x, t.o.y, t.o.z}) text += std::to_string(x) + " ";
            return text + "1]";
        };
        std::string move = "Translate 0.5 -0.2 0.3 Rotate 100 1 2 3 ";
        Transform end = translation({0.5, -0.2, 0.3}) * rotation(100, {1, 2, 3});
        Sampler random = random_numbers(5);
        int hits = 0;
        for (const std::string& shape : shapes) {
            CAPTURE(shape);
            Scene moving = world_of("LightSource \"infinite\" ActiveTransform EndTime " + move +
                                    "ActiveTransform All " + shape);
            REQUIRE(moving.movers.size() == 1);
            for (float time : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
                Scene still =
                    world_of("LightSource \"infinite\" " +
                             matrix(Motion({}, end).at(static_cast<double>(time))) + shape);
                for (int i = 0; i < 500; i++) {
                    Vec3 o = 3 * uniform_direction(random.u2());
                    Vec3 at = 0.7f * uniform_direction(random.u2());
                    Ray ray = {o, normalize(at - o), infinity, time};
                    std::optional<Hit> a = intersect(moving, ray), b = intersect(still, ray);
                    if (a.has_value() != b.has_value()) {  // at a rim, by rounding
                        Vec3 p = a ? a->p : b->p;
                        ray.d = normalize(p - o + 1e-4f * uniform_direction(random.u2()));
                        continue;
                    }
                    CHECK(occluded(moving, ray) == a.has_value());
                    if (!a) continue;
                    hits++;
                    CHECK(std::abs(a->t - b->t) < 2e-5f);
                    CHECK(length(a->p - b->p) < 2e-5f);
                    CHECK(length(a->n - b->n) < 1e-3f);
                    CHECK(length(a->ng - b->ng) < 1e-3f);
                    CHECK(a->front == b->front);
                    // A ray that leaves does not meet the same side of the shape again.
                    std::optional<Hit> again = intersect(moving, spawn_ray(*a, a->ng));
                    CHECK((!again || again->t > 1e-3f));
                }
            }
        }
        CHECK(hits > 1000);
    }

    TEST_CASE("identity: the box of what moves holds it at all times") {
        Sampler random = random_numbers(6);
        for (int i = 0; i < 200; i++) {
            auto any = [&] { return Vec3d(uniform_direction(random.u2())); };
            Transform start = translation(3.0 * any()) * rotation(360 * double{random.u1()}, any());
            Transform end = translation(3.0 * any()) * scaling({2, 0.5, 1});
            if (i % 2 == 0) end = end * rotation(360 * double{random.u1()}, any());
            if (i % 3 == 0) end = translation(any()) * start;  // without a turn
            Mover mover(start, end);
            for (int k = 0; k < 8; k++) {
                Vec3 p = 2 * uniform_direction(random.u2());
                mover.geometry.positions.push_back(to_vec3(transform_point(start, Vec3d(p))));
            }
            Box box = box_over_time(mover);
            for (double t = 0; t <= 1; t += 1.0 / 64)
                for (Vec3 p : mover.geometry.positions) {
                    Vec3 q = to_vec3(transform_point(mover.world_from_start(t), Vec3d(p)));
                    for (int axis = 0; axis < 3; axis++) {
                        CHECK(q[axis] >= box.low[axis]);
                        CHECK(q[axis] <= box.high[axis]);
                    }
                }
        }
    }

    TEST_CASE("truth: shadows and bounces see the shape at the path's own time") {
        // A roof that closes over the floor at half time: half of the floor's light, and the roof
        // itself is met by no path of the other half.
        std::string roof =
            "Translate 1000 1 0 ActiveTransform EndTime Translate -2000 0 0 ActiveTransform All "
            "Scale 400 1 400 " +
            square(0, false);
        Scene scene = world_of(white_floor +
                               " LightSource \"distant\" \"point3 from\" [0 1 0] "
                               "\"point3 to\" [0 0 0] AttributeBegin " +
                               black + roof + " AttributeEnd");
        scene.max_depth = 1;
        // The roof covers the origin for 800 of 2000 m. It hides the lamp from the floor below it.
        RunningStats s = repeat(scene, onto_origin, by_sixteen(scene), 100000, 1, pi_exact);
        check_mean(s, 0.6, 0.24, 0.013);
    }
}
