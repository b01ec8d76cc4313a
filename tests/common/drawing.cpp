// What is drawn: paths in their scene, plots, sheets and colours.
#include <doctest/doctest.h>

#include "common/base/files.h"
#include "common/explaining/path_drawing.h"
#include "common/explaining/preview.h"
#include "common/picture/comparison.h"
#include "common/picture/heat_map.h"
#include "common/picture/sheet.h"
#include "tests/support/scenes.h"

namespace {

/// A camera at (1, 3, -5) that looks about along +z and a little down, 40 x 20 pixels.
Scene room(const std::string& more = "") {
    Scene scene = scene_of(
        "LookAt 1 3 -5  0.5 1 0  0 1 0 Camera \"perspective\" \"float fov\" 50\nWorldBegin\n"
        "LightSource \"point\" \"point3 from\" [0.5 1.5 1]\n" +
        square(0, true) + more);
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

Image seen_by_camera(const Scene& scene, int side) {
    CameraView view = camera_view(scene.camera, side, side);
    return preview(scene, side, side, [&](Vec2 pixel) { return camera_ray(view, pixel); });
}

Image numbered(int width, int height) {
    Image image(width, height);
    for (size_t i = 0; i < image.pixels.size(); i++) image.pixels[i].r = static_cast<float>(i);
    return image;
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
        // A ball seen from the front: its middle faces the camera, its rim looks away.
        auto middle = [](const std::string& world, float x = 50.5f) {
            Scene scene = world_of(world, 101);
            Image image = seen_by_camera(scene, 101);
            return image.at(static_cast<int>(x), 50);
        };
        const std::string point = "LightSource \"point\"\n",
                          red = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.25 0]\n";
        auto is_about = [](Rgb a, Rgb b) {
            return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) < 0.01f;
        };
        CHECK(middle(point + "Translate 50 0 0 Shape \"sphere\"") == Rgb{0.8f, 0.85f, 0.9f});
        CHECK(is_about(middle(point + red + "Shape \"sphere\""), {0.5f, 0.25f, 0}));
        CHECK(is_about(middle(point + "Material \"conductor\" Shape \"sphere\""),
                       {0.45f, 0.45f, 0.5f}));
        CHECK(is_about(middle(point + "Material \"dielectric\" Shape \"sphere\""),
                       {0.5f, 0.7f, 0.75f}));
        CHECK(middle("AreaLightSource \"diffuse\" Shape \"sphere\"") == Rgb{1, 0.75f, 0.05f});
        // A plane at 60 degrees is lit by 1/4 + 3/4 cos 60 = 5/8.
        std::string plane =
            point + red + "Rotate 60 0 1 0 Rotate 90 1 0 0 Scale 9 1 9 " + square(0, true);
        Rgb seen = middle(plane);
        CHECK(is_about(seen, {0.5f * 0.625f, 0.25f * 0.625f, 0}));
    }

    TEST_CASE("truth: the colours of a heat map, and of an error, in order and at their places") {
        Image numbers(6, 1);
        for (int i = 0; i < 6; i++) numbers.at(i, 0).r = static_cast<float>(2 * i);
        Image map = heat_map(numbers, 8);
        const Rgb colours[] = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}, {1, 1, 1}};
        for (int i = 0; i < 6; i++) CHECK(map.at(i, 0) == colours[i]);
        numbers.at(0, 0).r = 1, numbers.at(1, 0).r = 3, numbers.at(2, 0).r = 5;
        numbers.at(3, 0).r = 7;
        map = heat_map(numbers, 8);
        const Rgb between[] = {{0, 0, 0.5f}, {0, 0.5f, 0.5f}, {0.5f, 0.5f, 0}, {1, 0.5f, 0.5f}};
        for (int i = 0; i < 4; i++) CHECK(map.at(i, 0) == between[i]);
        // The rays of pixels go through their middles, row by row.
        Scene scene = room();
        CameraView view = camera_view(scene.camera, 40, 20);
        auto is_ray = [&](const Ray& ray, float x, float y) {
            return length(ray.d - camera_ray(view, {x, y}).d) < 1e-6f;
        };
        CHECK(is_ray(pixel_ray(scene, view, 83), 3.5f, 2.5f));
        CHECK(pixel_rays(scene, 1).size() == 800);
        std::vector<Ray> rays = pixel_rays(scene, 7);
        CHECK(rays.size() == 115);
        CHECK(is_ray(rays[12], 4.5f, 2.5f));
        Image of_work = heat_map(
            scene, 1, [&](const Ray& ray) { return is_ray(ray, 3.5f, 2.5f) ? 1.0f : 0.0f; });
        CHECK(of_work.width == 40);
        for (int i = 0; i < 800; i++)
            CHECK(of_work.pixels[static_cast<size_t>(i)].g == (i == 83 ? 1 : 0));
        // Seven colours, each a sixth from the next.
        const Rgb stops[] = {{0, 0, 0},
                             {0.02f, 0.01f, 0.15f},
                             {0.2f, 0.01f, 0.25f},
                             {0.6f, 0.06f, 0.1f},
                             {0.95f, 0.3f, 0.01f},
                             {1, 0.75f, 0.1f},
                             {1, 1, 1}};
        for (int i = 0; i < 7; i++) {
            Rgb here = false_colour(i / 6.0);
            for (float d : {here.r - stops[i].r, here.g - stops[i].g, here.b - stops[i].b})
                CHECK(std::abs(d) < 1e-6f);
            if (i == 6) break;
            Rgb mean = 0.5f * (stops[i] + stops[i + 1]), half = false_colour((i + 0.5) / 6);
            CHECK(std::abs(half.r - mean.r) + std::abs(half.b - mean.b) < 1e-6f);
        }
        CHECK(false_colour(-1) == Rgb{0, 0, 0});
        CHECK(false_colour(9) == Rgb{1, 1, 1});
    }

    TEST_CASE("truth: a sheet has its tiles in a grid, in the order of reading, on grey") {
        std::vector<Tile> tiles;
        for (int i = 0; i < 5; i++) tiles.push_back({numbered(7 + i % 2, 5 - i % 2), {}});
        Image all = sheet(tiles, 3);
        const Rgb paper = {0.6f, 0.6f, 0.6f};
        REQUIRE(all.width == 10 + 3 * 18);
        REQUIRE(all.height == 10 + 2 * 15);
        Image expected(all.width, all.height);
        std::fill(expected.pixels.begin(), expected.pixels.end(), paper);
        for (int i = 0; i < 5; i++) {
            const Image& tile = tiles[static_cast<size_t>(i)].image;
            for (int y = 0; y < tile.height; y++)
                for (int x = 0; x < tile.width; x++)
                    expected.at(10 + 18 * (i % 3) + x, 10 + 15 * (i / 3) + y) = tile.at(x, y);
        }
        CHECK(all.pixels == expected.pixels);
        // Words make a tile as wide as they are, and each line 22 pixels higher.
        Image worded = sheet({{numbered(7, 5), {"some words", ""}}}, 1), nowhere;
        CHECK(worded.width == 20 + write_words(nowhere, 0, 0, "some words"));
        CHECK(worded.height == 20 + 5 + 2 * 22);
    }
}
