// What surrounds a render: its films, and the pixels at the edges of lamps.
#include <doctest/doctest.h>

#include "common/render/render.h"
#include "common/scene/intersect.h"
#include "tests/support/process.h"
#include "tests/support/stand_ins.h"

namespace fs = std::filesystem;

TEST_SUITE("surroundings") {
    TEST_CASE("truth: the pixels at edges of lamps are those that differ from a neighbour") {
        Scene scene = world_of(
            "LightSource \"infinite\" \"rgb L\" [0.5 0.5 0.5]\n" +
                ("Rotate -90 1 0 0 Scale 0.7 1 0.4 " + square(1, true)) +
                "AreaLightSource \"diffuse\" \"rgb L\" [0.503 0.503 0.503] \"bool twosided\" true "
                "Translate 0 2 0 Scale 0.3 1 9 " +
                square(0, true),
            24);
        scene.width = 30;
        Film film(30, 24), other(30, 24);
        mark_lamp_edges(scene, 1, film);
        mark_lamp_edges(scene, 3, other);
        CameraView view = camera_view(scene.camera, 30, 24);
        auto seen = [&](int x, int y) {
            Vec2 middle = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
            auto hit = intersect(scene, camera_ray(view, middle));
            return average(hit ? emission(scene, *hit) : scene.sky);
        };
        int marked = 0;
        std::set<float> values;
        for (int y = 0; y < 24; y++)
            for (int x = 0; x < 30; x++) {
                float here = seen(x, y);
                values.insert(here);
                bool edge = false;
                for (auto [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
                    if (x + dx < 0 || y + dy < 0 || x + dx >= 30 || y + dy >= 24) continue;
                    float there = seen(x + dx, y + dy);
                    edge |= std::abs(here - there) > 0.01f * std::max(here, there);
                }
                size_t i = static_cast<size_t>(30 * y + x);
                CHECK((film.pixels()[i].is_edge == 1) == edge);
                CHECK(other.pixels()[i].is_edge == film.pixels()[i].is_edge);
                marked += edge;
            }
        CHECK(values.size() == 3);  // of which two are within 1 % of each other
        CHECK(marked > 10);
    }

    TEST_CASE("truth: a film is written during the render, as often as it should be") {
        TemporaryFolder folder;
        Scene scene = empty_scene(20, 10, 4);
        RenderOptions options = stand_in_options(1);
        options.film = folder / "a.film";
        int calls = 0;
        uint64_t written = 0;
        Method method = [&](const Scene&, Ray, Sampler&, Recorder&) {
            if (++calls == 300) ::usleep(30'000);
            if (calls == 700) written = read_film(options.film).film.samples();
            return Rgb{1, 1, 1};
        };
        for (double every : {60.0, 0.02}) {
            options.film_every = every, calls = 0, options.seed++;
            fs::remove(options.film);
            CHECK(render_film(scene, options, method).film.samples() == 800);
            CHECK((written >= 300) == (every < 1));
        }
        CHECK(folder.names() == std::set<std::string>{"a.film"});
        // One that cannot be written is told, and the render goes on.
        options.film = "none/a.film";
        CHECK(captured([&] {
                  return save_meanwhile(scene, options, {Film(1, 1), {}, {}}, 1) == 1 ? 0 : 1;
              }).err == "none/a.film: error: cannot write: No such file or directory\n");
    }
}
