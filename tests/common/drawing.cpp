// What is drawn: paths in their scene, and colours.
#include <doctest/doctest.h>

#include "common/base/files.h"
#include "common/explaining/path_drawing.h"
#include "common/explaining/preview.h"
#include "common/picture/comparison.h"
#include "common/picture/heat_map.h"
#include "tests/support/scenes.h"

namespace {

/// A camera at (1, 3, -5) that looks about along +z and a little down, 40 x 20 pixels.
Scene room() {
    Scene scene = scene_of(
        "LookAt 1 3 -5  0.5 1 0  0 1 0 Camera \"perspective\" \"float fov\" 50\nWorldBegin\n"
        "LightSource \"point\" \"point3 from\" [0.5 1.5 1]\n" +
        square(0, true));
    scene.width = 40, scene.height = 20;
    return scene;
}

/// The drawing with no more of the pictures below it than their headers, 33 bytes as text.
std::string without_pictures(std::string svg) {
    const std::string begin = "base64,";
    for (size_t at = 0; (at = svg.find(begin, at)) != std::string::npos;) {
        at += begin.size() + 44;
        svg.erase(at, svg.find('\'', at) - at);
    }
    return svg;
}

}  // namespace

TEST_SUITE("drawing") {
    TEST_CASE("picture: a path with rays of all kinds is drawn as in drawing.svg") {
        // It was looked at: each vertex where the camera has it, and from above, right on the
        // right; shadow rays green, or dashed with a cross; light paths orange.
        Scene scene = room();
        CameraView view = camera_view(scene.camera, 40, 20);
        auto to = [&](float x, float y, float t) {
            Ray ray = camera_ray(view, {x, y});
            return ray.o + t * ray.d;
        };
        Vec3 eye = scene.camera.o, a = to(5, 4, 3), b = to(20, 10, 5), c = to(33, 17, 6);
        Vec3 behind = 2 * eye - to(10, 10, 1);
        std::vector<PathVertex> path = {{a, -1}, {b, 0}, {behind, 1}, {{0, 1, 0}, -2}, {c, 3}};
        auto ray = [](Vec3 from, Vec3 dest, bool shadow, bool met, float t) {
            return TracedRay{{from, dest - from, 1}, shadow, met, t};
        };
        TracedRay leaves = {{b, normalize(eye - a)}, false, false, infinity};
        std::vector<TracedRay> rays = {ray(a, b, true, false, NAN), ray(c, a, false, true, 1),
                                       leaves, ray({0, -4, 0}, {0, 4, 0}, true, true, NAN)};
        std::string drawn = draw_path(scene, eye, path, rays);
        // Rooms whose z is up, and that are seen from above and behind.
        for (const char* look : {"0 -9 1  0 0 0  0 0 1", "0 6 3  0 0 0  0 1 0"}) {
            Scene other = scene_of("LookAt " + std::string(look) +
                                   " Camera \"perspective\"\nWorldBegin\n"
                                   "LightSource \"point\" Shape \"sphere\"\n");
            other.width = other.height = 20;
            drawn += draw_path(other, other.camera.o, {{{1, 2, 3}, -1}}, {});
        }
        CHECK(without_pictures(drawn) == read_file("tests/support/drawing.svg"));
    }

    TEST_CASE("truth: a preview has the sky, lamps and materials, each lit from the camera") {
        const std::string point = "LightSource \"point\"\n",
                          red = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.25 0]\n";
        auto middle = [](const std::string& world) {
            Scene scene = world_of(world);
            CameraView view = camera_view(scene.camera, 101, 101);
            return preview(scene, 101, 101, [&](Vec2 p) { return camera_ray(view, p); }).at(50, 50);
        };
        auto is = [](Rgb a, Rgb b) {
            return max_component(abs(Vec3{a.r - b.r, a.g - b.g, a.b - b.b})) < 0.01f;
        };
        CHECK(is(middle(point + "Translate 50 0 0 Shape \"sphere\""), {0.8f, 0.85f, 0.9f}));
        CHECK(is(middle(point + red + "Shape \"sphere\""), {0.5f, 0.25f, 0}));
        CHECK(is(middle("AreaLightSource \"diffuse\" Shape \"sphere\""), {1, 0.75f, 0.05f}));
        // A plane at 60 degrees is lit by 1/4 + 3/4 cos 60 = 5/8.
        CHECK(is(
            middle(point + red + "Rotate 60 0 1 0 Rotate 90 1 0 0 Scale 9 1 9 " + square(0, true)),
            {0.5f * 0.625f, 0.25f * 0.625f, 0}));
    }

    TEST_CASE("truth: the colours of a heat map, and which pixel each has") {
        Image numbers(6, 1);
        for (int i = 0; i < 6; i++) numbers.at(i, 0).r = static_cast<float>(2 * i);
        numbers.at(0, 0).r = 5;
        Image map = heat_map(numbers, 8);
        const Rgb colours[] = {{0.5f, 0.5f, 0}, {0, 0, 1}, {0, 1, 0},
                               {1, 0, 0},       {1, 1, 1}, {1, 1, 1}};
        for (int i = 0; i < 6; i++) CHECK(map.at(i, 0) == colours[i]);
        // Of a scene: each pixel shows the number of its own ray.
        Scene scene = room();
        Ray ray = camera_ray(camera_view(scene.camera, 40, 20), {3.5f, 2.5f});
        Image of_work = heat_map(
            scene, 1, [&](const Ray& r) { return length(r.d - ray.d) < 1e-6f ? 1.0f : 0.0f; });
        for (size_t i = 0; i < 800; i++) CHECK(of_work.pixels[i].g == (i == 83 ? 1 : 0));
        CHECK(pixel_rays(scene, 7).size() == 115);
        // Of numbers from 0 to 1: black, red in the middle, white.
        CHECK(false_colour(0.5) == Rgb{0.6f, 0.06f, 0.1f});
        CHECK(false_colour(-1) == Rgb{0, 0, 0});
        CHECK(false_colour(9) == Rgb{1, 1, 1});
    }
}
