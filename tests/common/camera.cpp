// The pinhole camera, by pbrt's conventions, and pictures of numbers.
#include "common/scene/camera.h"

#include <doctest/doctest.h>

#include "common/path/method.h"
#include "common/picture/drawing.h"
#include "tests/support/folder.h"
#include "tests/support/gates.h"
#include "tests/support/scenes.h"

namespace {

/// Where on the film, in shares of its width and height, the camera of these options sees p.
Vec2 film_place(const std::string& options, Vec3 p, int width, int height) {
    Scene scene = scene_of(options + "\nWorldBegin\nLightSource \"infinite\" Shape \"sphere\"");
    CameraView view = camera_view(scene.camera, width, height);
    // Solve p - o = s (corner + x dx + y dy) by Cramer's rule.
    Vec3 d = p - view.o;
    float det = dot(view.corner, cross(view.dx, view.dy));
    float s = dot(d, cross(view.dx, view.dy)) / det;
    REQUIRE(s > 0);
    return {dot(view.corner, cross(d, view.dy)) / det / s / static_cast<float>(width),
            dot(view.corner, cross(view.dx, d)) / det / s / static_cast<float>(height)};
}

const std::string perspective = "Camera \"perspective\" \"float fov\" 90 ";

}  // namespace

TEST_SUITE("camera") {
    TEST_CASE("truth: where a camera of pbrt's conventions has a point in its picture") {
        const std::string fov = "Camera \"perspective\" \"float fov\" 60",
                          moved = "Translate 0 0 5 LookAt 1 2 3  1 2 4  0 1 0 " + perspective,
                          window = perspective + "\"float screenwindow\" [-2 2 -1 3]",
                          aspect = perspective + "\"float frameaspectratio\" ";
        float half = std::tan(pi / 6);
        struct {
            std::string options;
            Vec3 p;
            float x, y;
            int width = 100, height = 100;
        } cases[] = {
            // Looking along +z with y up, +x is on the right; looking along -z it is on the left.
            {"LookAt 0 0 0  0 0 1  0 1 0 " + perspective, {1, 0, 2}, 0.75f, 0.5f},
            {"LookAt 0 0 0  0 0 -1  0 1 0 " + perspective, {1, 1, -2}, 0.25f, 0.25f},
            {"Scale -1 1 1 LookAt 0 0 0  0 0 -1  0 1 0 " + perspective, {1, 1, -2}, 0.75f, 0.25f},
            // Translate comes after LookAt has acted: the camera stands 5 farther back.
            {moved + "Translate 100 0 0", {1, 2, 3}, 0.5f, 0.5f},
            {moved, {3.5f, 2, 3}, 0.75f, 0.5f},
            {"Rotate 90 0 0 1 " + perspective, {1, 0, 2}, 0.5f, 0.25f},
            {"Scale 3 3 3 " + perspective, {1, 1, 2}, 0.75f, 0.25f},
            // The angle across the shorter side.
            {fov, {half, half, 1}, 1, 0},
            {fov, {2 * half, half, 1}, 1, 0, 200, 100},
            {fov, {half, 3 * half, 1}, 1, 0, 100, 300},
            {"Camera \"perspective\"", {1, 1, 1}, 1, 0},  // 90 when not given
            {window, {0, 0, 1}, 0.5f, 0.75f},
            {window, {2, 3, 1}, 1, 0},
            {aspect + "2", {2, 1, 1}, 1, 0},
            {aspect + "0.5", {1, 2, 1}, 1, 0},
            {aspect + "4 \"float screenwindow\" [-1 1 -1 1]", {1, 1, 1}, 1, 0},
        };
        for (const auto& c : cases) {
            CAPTURE(c.options);
            Vec2 place = film_place(c.options, c.p, c.width, c.height);
            CHECK(std::abs(place.x - c.x) < 1e-5f);
            CHECK(std::abs(place.y - c.y) < 1e-5f);
        }
    }

    TEST_CASE("identity: a camera sample is a point of its pixel, at the next two numbers") {
        Sampler sampler = random_numbers(3), same = random_numbers(3);
        for (auto [x, y] : {std::pair(0, 0), std::pair(29, 0), std::pair(7, 19)}) {
            Vec2 film = film_point(x, y, sampler);
            Vec2 u = same.u2();
            CHECK(film.x == static_cast<float>(x) + u.x);
            CHECK(film.y == static_cast<float>(y) + u.y);
        }
        CHECK(sampler.u1() == same.u1());

        // "pixel centre" takes the same two numbers, and does not use them.
        Vec2 film = film_point(7, 19, sampler, true);
        same.u2();
        CHECK(film.x == 7.5f);
        CHECK(film.y == 19.5f);
        CHECK(sampler.u1() == same.u1());
    }

    TEST_CASE("truth: the colours of a heat map, and which pixel each has") {
        Image numbers(6, 1);
        for (int i = 0; i < 6; i++) numbers.at(i, 0).r = static_cast<float>(2 * i);
        numbers.at(0, 0).r = 5;
        Image map = heat_map(numbers, 8);
        const Rgb colours[] = {{0.5f, 0.5f, 0}, {0, 0, 1}, {0, 1, 0},
                               {1, 0, 0},       {1, 1, 1}, {1, 1, 1}};
        for (int i = 0; i < 6; i++) CHECK(map.at(i, 0) == colours[i]);
        // The rays of a scene, counted row by row.
        Scene scene = world_of("LightSource \"infinite\" Shape \"sphere\"");
        scene.width = 40, scene.height = 20;
        CameraView view = camera_view(scene.camera, 40, 20);
        CHECK(length(pixel_ray(scene, view, 83).d - camera_ray(view, {3.5f, 2.5f}).d) < 1e-6f);
    }
}
