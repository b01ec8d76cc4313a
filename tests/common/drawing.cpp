// Colours that stand for numbers.
#include <doctest/doctest.h>

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

}  // namespace

TEST_SUITE("drawing") {
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
