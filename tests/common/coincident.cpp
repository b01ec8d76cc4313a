#include "common/scene/coincident.h"

#include <doctest/doctest.h>

#include "tests/support/scenes.h"

namespace {

/// A rectangle in the plane of height y, from (x0, z0) to (x1, z1); reads "x0 z0 x1 z1".
std::string level(const std::string& y, const std::string& x0, const std::string& z0,
                  const std::string& x1, const std::string& z1) {
    return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" + x0 + " " +
           y + " " + z0 + " " + x1 + " " + y + " " + z0 + " " + x1 + " " + y + " " + z1 + " " + x0 +
           " " + y + " " + z1 + "]\n";
}
const std::string lamp = "AreaLightSource \"diffuse\"\n",
                  small = level("1", "-.5", "-.5", ".5", ".5"),
                  ceiling = level("1", "-2", "-2", "2", "2"),
                  disk = "Translate 0 1 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" .3\n",
                  ball = "Shape \"sphere\" \"float radius\" 2\n",
                  turn = "Rotate 37 1 2 3 Translate 30 40 50\n";

}  // namespace

TEST_SUITE("coincident") {
    TEST_CASE("truth: surfaces in one place are named, and no others") {
        const std::string with_shape = "5:1: note: this lamp and the Shape at test.pbrt:3:1 lie ";
        std::string crowd = "AttributeBegin\n";
        for (int i = 0; i < 200; i++) crowd += "Translate 9 0 0 Shape \"sphere\"\n";
        crowd += "AttributeEnd\n";
        const std::pair<std::string, std::string> cases[] = {
            // In a plane: all of a lamp, a corner of it, by a disk, of a wall that is turned, and
            // two lamps. In space: balls. And faces that are given twice.
            {ceiling + lamp + small, with_shape},
            {level("1", ".4", ".4", "2", "2") + lamp + small, with_shape},
            {ceiling + lamp + disk, " lie in one place"},
            {turn + ceiling + "Rotate 20 0 1 0\n" + lamp + small, " lie in one place"},
            {crowd + ceiling + lamp + small, " lie in one place"},
            {lamp + small + small, "5:1: note: this lamp and the lamp at test.pbrt:4:1 lie "},
            {ball + lamp + ball, with_shape},
            {small + "Material \"conductor\"\n" + small,
             "5:1: note: this Shape and the Shape at test.pbrt:3:1 lie "},
            {lamp + small + "ReverseOrientation\n" + disk, " lie in one place"},
            // Two triangles of a lamp, a wall that it touches, a millimetre, what crosses it, a
            // ball that it touches, and two walls that overlap but are not the same.
            {lamp + small, ""},
            {level("1", ".5", "-2", "2", "2") + lamp + small, ""},
            {level("1.001", "-2", "-2", "2", "2") + lamp + small, ""},
            {"Translate 0 1 0 Rotate .01 0 0 1 Translate 0 -1 0\n" + ceiling + "Identity\n" + lamp +
                 small,
             ""},
            {"Translate 0 3 0\n" + ball + "Identity\n" + lamp + small, ""},
            {ceiling + small, ""},
        };
        for (const auto& [world, note] : cases) {
            CAPTURE(world);
            std::vector<std::string> notes = notes_of_coincident(
                scene_of("Camera \"perspective\"\nWorldBegin LightSource \"infinite\"\n" + world));
            REQUIRE(notes.size() == (note.empty() ? 0 : 1));
            if (!notes.empty()) CHECK(notes[0].find(note) != std::string::npos);
        }
    }
}
