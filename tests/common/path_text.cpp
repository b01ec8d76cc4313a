// What --explain tells of a path whose events are made by hand, to the last word.
#include <doctest/doctest.h>

#include "common/recording/path_story.h"
#include "tests/support/scenes.h"

namespace {

/// A hit of this material at p.
Hit hit_at(Vec3 p, const Material& material, bool front = true) {
    Hit x{};
    x.p = p, x.n = x.ng = {0, 0, -1}, x.t = 2.5f, x.front = front, x.material = &material;
    return x;
}

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
        Material wall, glass;
        glass.type = MaterialType::dielectric;
        PathStory story(5, false);
        Recorder recorder(true, &story);
        recorder.start();
        story.starts_at_eye();
        trace_hit();
        recorder.vertex(hit_at({1, 2, 3}, glass, false));
        CHECK_FALSE(story.has_left());
        recorder.emitted({1, 0.5f, 0.25f}, 0.5f);
        recorder.scatter({0, 0.6f, 0.8f}, {2, 4, 8}, 1, true, {0.5f, 0.25f, 0.125f});
        recorder.roulette(1, {0.5f, 0.25f, 0.125f});
        trace_hit();
        recorder.vertex(hit_at({1, 2, 4}, wall));
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

    TEST_CASE("truth: the vertex, weight, way and pixel of a connection of two paths") {
        Material wall;
        Recorder recorder(true);
        recorder.start();
        recorder.start_at_light({});
        auto meet = [&] {
            recorder.vertex(hit_at({}, wall));
            recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, false, {1, 1, 1});
        };
        meet();
        recorder.start_at_eye();
        meet(), meet();
        for (auto [s, t, vertex] : {std::tuple{2, 1, 2}, {1, 3, 4}}) {
            size_t pixel = t == 1 ? 17 : Contribution::own_pixel;
            recorder.connected({1, 2, 3}, s, t, 0.5f, pixel);
            const Contribution& last = recorder.contributions().back();
            CHECK(last.vertex == vertex);  // from 1, those of the light's path first
            CHECK(last.mis == 0.5f);
            CHECK(last.way == "s " + std::to_string(s) + ", t " + std::to_string(t));
            CHECK(last.pixel == pixel);
        }
    }
}
