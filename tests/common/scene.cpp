// What is prepared of a scene before it is traced, and surfaces in one place.
#include <doctest/doctest.h>

#include "common/light/light_table.h"
#include "common/scene/mover.h"
#include "common/scene/prepare.h"
#include "common/scene/sky_image.h"
#include "tests/support/gates.h"
#include "tests/support/scenes.h"

namespace {

const std::string start = "Camera \"perspective\"\nWorldBegin LightSource \"infinite\"\n";

/// A mesh of a rectangle, or of a triangle, with these corners.
std::string mesh(const std::string& corners, bool rectangle = true) {
    return "Shape \"trianglemesh\" \"integer indices\" " +
           std::string(rectangle ? "[0 1 2 0 2 3]" : "[0 1 2]") + " \"point3 P\" [" + corners +
           "]\n";
}
/// A rectangle in the plane of height y, from (x0, z0) to (x1, z1).
std::string level(const std::string& y, const std::string& x0, const std::string& z0,
                  const std::string& x1, const std::string& z1) {
    auto corner = [&](const auto& x, const auto& z) { return x + " " + y + " " + z + " "; };
    return mesh(corner(x0, z0) + corner(x1, z0) + corner(x1, z1) + corner(x0, z1));
}
const std::string lamp = "AreaLightSource \"diffuse\"\n",
                  small = level("1", "-.5", "-.5", ".5", ".5"),
                  disk = "Translate 0 1 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" .3\n",
                  turn = "Rotate 37 1 2 3 Translate 30 40 50\n";
std::string ceiling(const std::string& y = "1") { return level(y, "-2", "-2", "2", "2"); }
std::string ball(const std::string& radius = "2") {
    return "Shape \"sphere\" \"float radius\" " + radius + "\n";
}

std::vector<std::string> notes_of(const std::string& world) {
    return notes_of_coincident(scene_of(start + world));
}

/// The box of the one shape that moves in a world.
Box box_of_mover(const std::string& world) { return scene_of(start + world).movers.at(0)->box; }

/// Whether the box reaches from low to high, and as much farther as rounding needs.
bool reaches(const Box& box, Vec3 low, Vec3 high) {
    bool right = true;
    for (int i = 0; i < 3; i++) {
        float slack =
            1e-5f * (high[i] - low[i]) + 1e-6f * std::max(std::abs(high[i]), std::abs(low[i]));
        right = right && std::abs(box.low[i] - (low[i] - slack)) < 1e-6f &&
                std::abs(box.high[i] - (high[i] + slack)) < 1e-6f;
    }
    return right;
}

}  // namespace

TEST_SUITE("scene") {
    TEST_CASE("truth: surfaces in one place are named, and no others") {
        const std::string with_shape = "5:1: note: this lamp and the Shape at test.pbrt:3:1 lie ",
                          some = " lie in one place", half = "0 1 0  1 1 0  1 1 1",
                          beside = " 1 -9  30 1 0  ";
        // A triangle over the half of space with x > x0, which half reaches up to x = 1.
        auto from = [&](const std::string& x0) { return mesh(x0 + beside + x0 + " 1 9", false); };
        const std::pair<std::string, std::string> cases[] = {
            // In a plane: all of a lamp, a corner of it, by a disk, of a wall that is turned, and
            // two lamps.
            {ceiling() + lamp + small, with_shape},
            {level("1", ".4", ".4", "2", "2") + lamp + small, with_shape},
            {ceiling() + lamp + disk, some},
            {turn + ceiling() + "Rotate 20 0 1 0\n" + lamp + small, some},
            {lamp + small + small, "5:1: note: this lamp and the Shape at test.pbrt:4:1 lie "},
            {lamp + small + "ReverseOrientation\n" + disk, some},
            {lamp + "Shape \"trianglemesh\" \"integer indices\" [0 1 2 2 0 1] \"point3 P\" [" +
                 half + "]",
             "4:1: note: this lamp and the Shape at test.pbrt:4:1 lie "},
            // Two triangles of a lamp, a wall that it touches, a millimetre, what crosses it, a
            // ball that it touches, and two walls that overlap but are not the same.
            {lamp + small, ""},
            {level("1", ".5", "-2", "2", "2") + lamp + small, ""},
            {ceiling("1.001") + lamp + small, ""},
            {"Translate 0 1 0 Rotate .01 0 0 1 Translate 0 -1 0\n" + ceiling() + "Identity\n" +
                 lamp + small,
             ""},
            {"Translate 0 3 0\n" + ball() + "Identity\n" + lamp + small, ""},
            {ceiling() + small, ""},
            // Apart by rounding, or by more: 2^-20 of the largest coordinate.
            {ceiling("1.0000007") + lamp + small, some},
            {ceiling("0.9999993") + lamp + small, some},
            {ceiling("1.0000011") + lamp + small, ""},
            {ceiling("0.9999989") + lamp + small, ""},
            // One box of a ball and a triangle.
            {mesh("-2 -2 -2  2 2 2  -2 2 0", false) + lamp + ball(), ""},
            // An overlap by a thousandth of an edge of 18 m, of the lamp or of the other face.
            {from(".981") + lamp + mesh(half, false), some},
            {from(".983") + lamp + mesh(half, false), ""},
            {mesh(half, false) + lamp + from(".981"), some},
            {mesh(half, false) + lamp + from(".983"), ""},
        };
        for (const auto& [world, note] : cases) {
            CAPTURE(world);
            std::vector<std::string> notes = notes_of(world);
            REQUIRE(notes.size() == (note.empty() ? 0 : 1));
            if (!notes.empty()) CHECK(notes[0].find(note) != std::string::npos);
        }
        std::string pairs = lamp;
        for (int i = 0; i < 25; i++) pairs += "Translate 0 1 0\n" + small + small;
        CHECK(notes_of(pairs).size() == 20);
    }

    TEST_CASE("truth: the sky, the sphere around a scene, and the boxes of what moves") {
        Light sky, point;
        sky.type = LightType::infinite, sky.L = {1, 2, 3};
        point.type = LightType::point, point.L = {1, 1, 1};
        for (bool has_image : {false, true}) {
            Scene scene;
            scene.lights = {point, sky, sky};
            scene.camera.o = {1, 2, 3};
            if (has_image) {
                SkyImage image;
                image.pixels = {{1, 1, 1}};
                scene.sky_image = std::make_shared<SkyImage>(image);
            }
            prepare(scene, 1);
            const Rgb all = {2, 4, 6}, none;
            CHECK(scene.sky_light == 1);
            CHECK(scene.sky == (has_image ? none : all));
            CHECK(scene.lights[0].L == point.L);
            CHECK(scene.lights[1].L == scene.sky);
            CHECK(scene.lights[2].L == none);
            if (has_image) CHECK(scene.sky_image->pixels[0] == Rgb{3, 5, 7});
            CHECK(scene.centre == Vec3{1, 2, 3});
            CHECK(scene.radius == 1);
        }
        // A ball from (-1, 1, 2) to (3, 5, 6), and one that moves from there.
        const std::string still = "Translate 1 3 4 " + ball(),
                          move = "ActiveTransform EndTime Translate 4 0 0 ActiveTransform All ";
        for (bool moves : {false, true}) {
            Scene scene = scene_of(start + still + (moves ? move + ball() : ""));
            CHECK(length(scene.centre - Vec3{moves ? 3.f : 1.f, 3, 4}) < 1e-4f);
            CHECK(std::abs(scene.radius - std::sqrt(moves ? 24.f : 12.f)) < 2e-4f);
            CHECK(scene.moves == moves);
            if (moves) CHECK(scene.movers[0]->first_prim == 1);
        }
        CHECK(reaches(box_of_mover("Translate 1 3 4 " + move + ball()), {-1, 1, 2}, {7, 5, 6}));
        // What turns stays at its distance from the origin, which goes straight.
        const std::string quarter =
            "Rotate 90 0 0 1 ActiveTransform All " + mesh("1 0 0  2 0 0  1 0 1", false);
        float r = std::sqrt(5.0f);
        CHECK(reaches(box_of_mover("ActiveTransform EndTime " + quarter), {-r, -r, -r}, {r, r, r}));
        CHECK(reaches(box_of_mover("ActiveTransform EndTime Translate 3 0 0 " + quarter),
                      {-r, -r, -r}, {3 + r, r, r}));
    }

    TEST_CASE("truth: the area, the sphere around it, and the rounding of each lamp") {
        const std::string at = "Translate 1 2 3 ";
        struct {
            std::string shape;
            double area;
            Vec3 centre;
            float radius;
            bool flat;
            float size, off_plane;  // m, of the numbers that rounding errors belong to
        } cases[] = {
            {mesh("0 0 0  3 0 0  0 4 0", false), 6, {1.5f, 2, 0}, 2.5f, true, 4, 0},
            {mesh("0 0 0  3 0 0  3 4 0  0 4 0"), 12, {1.5f, 2, 0}, 2.5f, true, 4, 0},
            {mesh("0 0 0  1 0 0  1 1 0  0 1.00001 0"), 1, {.5f, .5f, 0}, .70711f, true, 1, 0},
            {mesh("0 0 0  1 0 0  1 1 0  0 1.00002 0"), 1, {.5f, .5f, 0}, .70711f, false, 1, 0},
            {at + ball(), 16 * pi, {1, 2, 3}, 3.4641f, false, 5, 0},
            {at + "Shape \"disk\" \"float radius\" 2", 4 * pi, {1, 2, 3}, 3.4641f, true, 4, 3},
            {at + "Rotate 30 1 0 0 Shape \"disk\" \"float radius\" 2",
             4 * pi,
             {1, 2, 3},
             3.4641f,
             true,
             4,
             5.3301f},
        };
        for (const auto& c : cases) {
            CAPTURE(c.shape);
            Scene scene = scene_of(start + lamp + c.shape);
            const LightShape& lit = scene.light_shapes.at(1);
            CHECK(double{lit.area} == doctest::Approx(c.area).epsilon(2e-5).scale(0));
            CHECK(length(lit.centre - c.centre) < 2e-5f);
            CHECK(std::abs(lit.radius - c.radius) < 2e-5f);
            CHECK(lit.flat == c.flat);
            CHECK(std::abs(lit.first.eps / rounding_error(c.size) - 1) < 2e-5f);
            CHECK(std::abs(lit.first.off_plane - rounding_error(c.off_plane)) < 1e-10f);
            bool two = scene.lights[1].prims == 2;
            CHECK(lit.parallelogram == (two && c.flat));
            CHECK(lit.area_up_to.size() == (two ? 2 : 0));
            if (two) CHECK(lit.area_up_to[0] == doctest::Approx(c.area / 2).epsilon(2e-5).scale(0));
        }
    }
}
