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
        // The lamp and three vertices; the lamp, the eye and all four, in the second panel.
        std::vector<Vec2> circles = circles_in(drawn);
        REQUIRE(circles.size() == 10);
        for (size_t i : {0u, 1u, 2u}) {
            CHECK(std::abs(circles[i + 1].x - (20 + 11.5f * pixels[i].x)) < 0.1f);
            CHECK(std::abs(circles[i + 1].y - (20 + 11.5f * pixels[i].y)) < 0.1f);
        }
        // Seen or hidden rays: each in both panels but for what is not in front, and in the legend.
        CHECK(count(drawn, "stroke='#080'") == 3);
        CHECK(count(drawn, "stroke-dasharray='5 4'") == 3);
        CHECK(count(drawn, "stroke-dasharray='2 4'") >= 2);
        CHECK(count(drawn, "stroke='#e70'") == 3);  // circles of the light path, and the legend
    }

    TEST_CASE("truth: from above, right is right and far is up, whichever axis points up") {
        // The eye, and two vertices that are 1 m more to the right, and 1 m farther away.
        const std::tuple<const char*, Vec3, Vec3> rooms[] = {
            {"0 2 -9  0 1 0  0 1 0", {1, 0, 0}, {0, 0, 1}},
            {"0 -9 1  0 0 0  0 0 1", {-1, 0, 0}, {0, 1, 0}},
            {"0 6 9  0 0 0  0 1 0", {-1, 0, 0}, {0, 0, -1}}};
        for (const auto& [look, right, away] : rooms) {
            CAPTURE(look);
            Scene scene = scene_of("LookAt " + std::string(look) +
                                   " Camera \"perspective\"\nWorldBegin\n"
                                   "LightSource \"infinite\" Shape \"sphere\"\n");
            scene.width = scene.height = 20;
            Vec3 eye = scene.camera.o;
            std::vector<Vec2> all =
                circles_in(draw_path(scene, eye, {{eye + right, -1}, {eye + away, -1}}, {}));
            REQUIRE(all.size() >= 3);
            Vec2 e = all[all.size() - 3], r = all[all.size() - 2], f = all[all.size() - 1];
            CHECK(r.x - e.x > 10);
            CHECK(std::abs(r.y - e.y) < 0.2f);
            CHECK(std::abs(f.x - e.x) < 0.2f);
            CHECK(std::abs((e.y - f.y) / (r.x - e.x) - 1) < 0.02f);
        }
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
