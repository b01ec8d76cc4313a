// What a recorder keeps and a story tells of events that are made by hand, to the last word.
#include <doctest/doctest.h>

#include "common/recording/recorder.h"
#include "tests/support/scenes.h"

namespace {

/// A hit of this material at p.
Hit hit_at(Vec3 p, const Material& material, bool front = true) {
    Hit x{};
    x.p = p, x.n = x.ng = {0, 0, -1}, x.t = 2.5f, x.front = front, x.material = &material;
    return x;
}

struct Materials {
    Material wall, mirror, glass;
    Materials() {
        wall.reflectance = {0.5f, 0.5f, 0.5f};
        mirror.type = MaterialType::conductor;
        glass.type = MaterialType::dielectric;
    }
};

/// The same scene for all: a ball of radius 1 around (9, 0, 0), for rays that meet something.
const Scene& ball() {
    static const Scene scene = world_of("LightSource \"point\" Translate 9 0 0 Shape \"sphere\"");
    return scene;
}
/// Rays that this thread traces, of which a story keeps what they met.
void trace_hit() { intersect(ball(), {{0, 0, 0}, {1, 0, 0}}); }
void trace_miss() { intersect(ball(), {{0, 0, 0}, {0, 1, 0}}); }
void shadow_hit() { occluded(ball(), {{0, 0, 0}, {1, 0, 0}}); }
void shadow_miss() { occluded(ball(), {{0, 0, 0}, {0, 1, 0}}); }

}  // namespace

TEST_SUITE("path text") {
    TEST_CASE("truth: the story of a path from the eye, word by word") {
        Materials m;
        PathStory story(5, false);
        Recorder recorder(true, &story);
        recorder.start();
        story.starts_at_eye();
        trace_hit();
        recorder.vertex(hit_at({1, 2, 3}, m.glass, false));
        CHECK_FALSE(story.has_left());
        recorder.emitted({1, 0.5f, 0.25f}, 0.5f);
        recorder.scatter({0, 0.6f, 0.8f}, {2, 4, 8}, 1, true, {0.5f, 0.25f, 0.125f});
        recorder.roulette(1, {0.5f, 0.25f, 0.125f});
        trace_hit();
        recorder.vertex(hit_at({1, 2, 4}, m.wall));
        shadow_miss();
        recorder.direct({1, 2, 4}, {0, 1, 0}, 0.75f, 0.125f, 0.25f);
        shadow_hit();
        recorder.scatter({0, 0, -1}, {0.5f, 0.25f, 0.125f}, 0.375f, false, {1, 2, 3});
        recorder.roulette(0.5f, {2, 4, 6});
        trace_miss();
        CHECK(story.has_left());
        recorder.vertex({});
        recorder.emitted({3, 2, 1});
        story.ends();
        CHECK(story.text() ==
              "from the eye:\nvertex 1  dielectric at (1, 2, 3), n (0, 0, -1), back, distance 2.5\n"
              "    light met: adds (0.5, 0.25, 0.125), mis 0.5, class LE\n"
              "    goes on along wi (0, 0.6, 0.8): f (2, 4, 8) sr^-1, pdf_w 1 (delta), beta (0.5, "
              "0.25, 0.125)\n"
              "vertex 2  diffuse at (1, 2, 4), n (0, 0, -1), front, distance 2.5\n"
              "    samples a light along wi (0, 1, 0): pdf_l 0.75, pdf_b 0.125 sr^-1\n"
              "    light sampled: adds (0.5, 0.5, 0.5), mis 0.25, class LDSE\n"
              "    shadow ray along (1, 0, 0): blocked\n"
              "    goes on along wi (0, 0, -1): f (0.5, 0.25, 0.125) sr^-1, pdf_w 0.375 sr^-1, "
              "beta (1, 2, 3)\n"
              "    survives roulette, q 0.5, beta (2, 4, 6)\n"
              "    leaves the scene along (0, 1, 0)\n"
              "    sky met: adds (6, 8, 6), mis 1, class LDSE\n"
              "    ends: it has left the scene\n");
    }

    TEST_CASE("truth: why a path ends") {
        Materials m;
        Material soot = m.wall;
        soot.reflectance = {0, 0, 0};
        const std::string below =
            "absorbed at vertex 1: the direction drawn lies below the surface";
        struct {
            const Material& material;
            bool counts_photons, goes_on;
            std::string why;
        } cases[] = {
            {m.wall, false, false, below},
            {m.wall, true, false, "photons around vertex 1 tell the rest"},
            {m.mirror, true, false, below},
            {soot, true, false, "vertex 1 is black: it absorbs all"},
            {m.wall, false, true, "roulette stops it"},
        };
        for (const auto& c : cases) {
            PathStory story(1, c.counts_photons);
            Recorder recorder(true, &story);
            recorder.start();
            trace_hit();
            recorder.vertex(hit_at({}, c.material));
            if (c.goes_on) recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, true, {1, 1, 1});
            story.ends();
            CHECK(story.text().ends_with("    ends: " + c.why + "\n"));
        }
    }

    TEST_CASE("truth: the class, way, vertex and pixel of each connection of two paths") {
        // From the light D S D, from the eye S D S: what lies between the two ends that are
        // connected has the letters of its vertices, and both ends are D.
        Materials m;
        const Material* kinds[] = {&m.wall, &m.mirror};
        auto is_mirror = [&](char letter) { return letter == 'S'; };
        const std::string light = "DSD", eye = "SDS";
        Recorder recorder(true);
        recorder.start();
        auto walk = [&](const std::string& letters) {
            for (char letter : letters) {
                recorder.vertex(hit_at({}, *kinds[is_mirror(letter)]));
                recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, is_mirror(letter), {1, 1, 1});
            }
        };
        recorder.start_at_light({});
        walk(light);
        recorder.start_at_eye();
        walk(eye);
        recorder.vertex(hit_at({}, m.wall));
        CHECK(recorder.contributions().empty());
        for (int s = 0; s <= 4; s++) {
            for (int t = 1; t <= 5; t++) {
                if (s + t < 2) continue;
                CAPTURE(s);
                CAPTURE(t);
                // Vertices of the eye's path: t = 1 is the eye itself, 2 the first that it met.
                std::string expected = "L";
                for (int i = 1; i < s; i++)
                    expected += i == s - 1 ? 'D' : light[static_cast<size_t>(i - 1)];
                std::string from_eye;
                for (int i = 2; i <= t - (s == 0); i++)
                    from_eye += i == t ? 'D' : eye[static_cast<size_t>(i - 2)];
                std::reverse(from_eye.begin(), from_eye.end());
                expected += from_eye + "E";
                size_t pixel = t == 1 ? 17 : Contribution::own_pixel;
                recorder.connected({1, 2, 3}, s, t, 0.5f, pixel);
                const Contribution& last = recorder.contributions().back();
                CHECK(last.path_class == expected);
                CHECK(last.way == "s " + std::to_string(s) + ", t " + std::to_string(t));
                CHECK(last.pixel == pixel);
                CHECK(last.mis == 0.5f);
                CHECK(last.L == Rgb{1, 2, 3});
                // Vertices count from 1: four of the light's path, then those from the eye.
                CHECK(last.vertex == (t == 1 ? s : 4 + t - 1));
            }
        }
        // The light's path begins anew; so does all.
        recorder.start_at_light({});
        recorder.vertex(hit_at({}, m.wall));
        recorder.connected({1, 1, 1}, 2, 1, 1, 3);
        CHECK(recorder.contributions().back().path_class == "LDE");
        recorder.start();
        CHECK(recorder.contributions().empty());
        CHECK(recorder.vertices().empty());
    }
}
