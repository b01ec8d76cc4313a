// What is drawn: paths in their scene, and colours.
#include <doctest/doctest.h>

#include "common/base/files.h"
#include "common/picture/comparison.h"
#include "common/picture/heat_map.h"
#include "common/render/path_drawing.h"
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

/// The middles of the circles in a drawing.
std::vector<Vec2> circles_in(const std::string& svg) {
    std::vector<Vec2> found;
    for (size_t at = 0; (at = svg.find("<circle ", at)) != std::string::npos; at++) {
        Vec2 p{};
        REQUIRE(std::sscanf(svg.c_str() + at, "<circle cx='%f' cy='%f'", &p.x, &p.y) == 2);
        found.push_back(p);
    }
    return found;
}
size_t count(const std::string& text, const std::string& part) {
    size_t found = 0;
    for (size_t at = 0; (at = text.find(part, at)) != std::string::npos; at++) found++;
    return found;
}

}  // namespace

TEST_SUITE("drawing") {
    TEST_CASE("truth: vertices are drawn where the camera sees them, and to scale from above") {
        Scene scene = room();
        CameraView view = camera_view(scene.camera, 40, 20);
        auto to = [&](Vec2 pixel, float t) {
            Ray ray = camera_ray(view, pixel);
            return ray.o + t * ray.d;
        };
        const Vec2 pixels[] = {{5, 4}, {20, 10}, {33, 17}};
        Vec3 eye = scene.camera.o;
        Vec3 a = to(pixels[0], 3), b = to(pixels[1], 5), c = to(pixels[2], 6);
        Vec3 behind = 2 * eye - to({10, 10}, 1);
        auto ray = [](Vec3 from, Vec3 dest, bool shadow, bool met, float t) {
            return TracedRay{{from, dest - from, 1}, shadow, met, t};
        };
        TracedRay leaves = {{b, normalize(eye - a)}, false, false, infinity};
        std::string drawn = draw_path(scene, eye, {{a, -1}, {b, 0}, {c, -2}, {behind, 1}},
                                      {ray(a, b, true, false, NAN), ray(c, a, false, true, 1),
                                       leaves, ray({0, -4, 0}, {0, 4, 0}, true, true, NAN)});
        // Three vertices; the eye and all four, in the second panel.
        std::vector<Vec2> circles = circles_in(drawn);
        REQUIRE(circles.size() == 8);
        for (size_t i : {0u, 1u, 2u}) {
            CHECK(std::abs(circles[i].x - (20 + 11.5f * pixels[i].x)) < 0.1f);
            CHECK(std::abs(circles[i].y - (20 + 11.5f * pixels[i].y)) < 0.1f);
        }
        // From above, right is right and far is up, to one scale.
        Vec2 shown = {circles[6].x - circles[4].x, circles[4].y - circles[6].y};
        CHECK(shown.x > 0);
        CHECK(circles[6].y < circles[3].y - 10);
        Vec3 right = scene.camera.right, away = cross(right, {0, 1, 0});
        CHECK(std::abs(shown.x / shown.y - dot(c - a, right) / dot(c - a, away)) < 0.01f);
        // Seen or hidden rays: each in both panels but for what is not in front, and in the legend.
        CHECK(count(drawn, "stroke='#080'") == 3);
        CHECK(count(drawn, "stroke-dasharray='5 4'") == 3);
        CHECK(count(drawn, "stroke-dasharray='2 4'") >= 2);
        CHECK(count(drawn, "stroke='#e70'") == 3);  // circles of the light path, and the legend
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
