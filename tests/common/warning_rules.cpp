// When a warning is given: each of them alone, on both sides of its threshold.
#include <doctest/doctest.h>

#include "tests/traces/15.h"
#include "tests/traces/21.h"
#include "common/results/black_picture.h"
#include "common/results/metal_light.h"
#include "common/results/warnings.h"
#include "tests/support/estimators.h"

template <>
struct doctest::StringMaker<std::vector<std::string>> {
    static doctest::String convert(const std::vector<std::string>& lines) {
        std::string all;
        for (const std::string& line : lines) all += line + "\n";
        return all.c_str();
    }
};

namespace {

using Lines = std::vector<std::string>;

Rgb grey(double v) {
    float x = static_cast<float>(v);
    return {x, x, x};
}

/// A film in which each sample of pixel i is value(i, number of the sample).
template <class Value>
Film film_with(int width, int height, int spp, const Value& value) {
    Film film(width, height);
    for (size_t i = 0; i < film.pixels().size(); i++)
        for (int s = 0; s < spp; s++) film.add(i, grey(value(i, s)));
    return film;
}
/// A film that no sample alone says anything about: 1 everywhere, with 1 % of noise.
Film quiet_film(int width, int height, int spp = 4) {
    return film_with(width, height, spp, [](size_t, int s) { return 1 + 0.01 * (s % 2); });
}

Lines told(const Film& film, double largest = 0) {
    SampleCounts counts;
    counts.largest = largest;
    return warnings_of(film, counts);
}

const std::string floor_2 =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-2 0 -2  -2 0 2  2 0 2 "
    " 2 0 -2]\n";
const std::string diffuse = "Material \"diffuse\"\n", mirror = "Material \"conductor\"\n",
                  glass = "Material \"dielectric\"\n",
                  black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
std::string in(const std::string& material, const std::string& shapes) {
    return "AttributeBegin\n" + material + shapes + "AttributeEnd\n";
}
std::string lamp(const std::string& shape) {
    return in("AreaLightSource \"diffuse\"\n" + black, shape);
}
std::string ball(const std::string& at, const std::string& radius) {
    return "Translate " + at + " Shape \"sphere\" \"float radius\" " + radius + "\n";
}
const std::string point = "LightSource \"point\" \"point3 from\" [0 5 0]\n",
                  distant = "LightSource \"distant\" \"point3 from\" [0 5 0]\n",
                  sky = "LightSource \"infinite\"\n", high_lamp = lamp(ball("0 5 0", "2"));

/// A camera above the floor, 16 x 16 pixels.
Scene seen(const std::string& world, const std::string& look = "0 2 -4  0 0.3 0  0 1 0",
           const std::string& fov = "30") {
    Scene scene = scene_of("LookAt " + look + " Camera \"perspective\" \"float fov\" " + fov +
                           "\nWorldBegin\n" + world);
    scene.width = scene.height = 16;
    return scene;
}

/// What is said of a scene beside a film that has nothing to be warned of.
Lines told(const Scene& scene, LightSearch search, const std::string& strategy = "", int spp = 4) {
    RenderOptions options;
    options.search = search;
    if (!strategy.empty()) options.own = {{"strategy", strategy}};
    return warnings_of(scene, options,
                       Rendering{quiet_film(scene.width, scene.height, spp), {}, {}});
}

}  // namespace

TEST_SUITE("warning rules") {
    TEST_CASE("truth: of a film without noise, or with little, nothing is said") {
        CHECK(told(quiet_film(16, 16), 1.01) == Lines{});
        CHECK(told(film_with(16, 16, 4, [](size_t, int) { return 1; }), 1) == Lines{});
    }

    TEST_CASE("truth: pixels without samples, and a film without light") {
        Film some(10, 10);
        for (size_t i = 0; i < 75; i++)
            for (int s = 0; s < 4; s++) some.add(i, grey(1 + 0.01 * s));
        CHECK(told(some) ==
              Lines{"rendering ended before 25 % of the pixels had a sample: they are black"});
        Film none(10, 10);
        CHECK(told(none) ==
              Lines{"rendering ended before 100 % of the pixels had a sample: they are black"});
        CHECK(told(film_with(10, 10, 2, [](size_t, int) { return 0; })) ==
              Lines{"the picture is black: no sample found light"});
    }

    TEST_CASE("truth: a sample is named from 1 % of the picture on, with its share") {
        Film film = film_with(16, 16, 4, [](size_t, int) { return 1; });  // 1024 in all
        CHECK(told(film, 10.2) == Lines{});
        CHECK(told(film, 10.3) == Lines{"one sample contains 1.01 % of the whole picture"});
        CHECK(told(film, 512) == Lines{"one sample contains 50 % of the whole picture"});
    }

    TEST_CASE("truth: the samples that carry a picture are too few below 100") {
        // n equal samples and nothing else are n effective ones.
        for (int n : {40, 99, 100}) {
            CAPTURE(n);
            Film film = film_with(16, 16, 2, [&](size_t i, int s) {
                return s == 0 && static_cast<int>(i) < n ? 1 : 0;
            });
            Lines expected;
            if (n < 100)
                expected.push_back("as few as " + std::to_string(n) +
                                   " samples determine the picture: the true error is larger than "
                                   "the reported one");
            CHECK(told(film) == expected);
        }
    }

    TEST_CASE("truth: bright samples make the error where they alone do, and are few") {
        const std::string line =
            "a few bright samples determine the error: the true error is larger than the reported "
            "one";
        // Noise in 256 pixels, and one sample of `bright` more in some.
        auto film = [&](size_t few, double bright) {
            return film_with(16, 16, 4, [=](size_t i, int s) {
                return 1 + 0.1 * (s % 2) + (i < few && s == 3 ? bright : 0);
            });
        };
        CHECK(told(film(1, 3), 4.1) == Lines{line});
        CHECK(told(film(20, 3), 4.1) == Lines{line});
        CHECK(told(film(40, 3), 4.1) == Lines{});  // more than 30 pixels have the error
        CHECK(told(film(1, 0.1), 1.2) == Lines{});
        // What it has above the mean must be larger than 5 % of all squares: of 2.7 twenty times.
        CHECK(told(film(20, 3), 3.5) == Lines{});
        // Dark samples in an even picture are none; nor are any where the noise is below 0.1 %.
        CHECK(told(film(3, 0.7), 1.8) == Lines{line});
        CHECK(told(film(3, -0.9), 1.1) == Lines{});
        CHECK(told(film_with(16, 16, 4, [](size_t i, int s) { return i < 3 && s > 2 ? 1.5 : 1; }),
                   1.5) == Lines{});
    }

    TEST_CASE("truth: few passes, and few audited pixels, tell an error badly") {
        for (int spp : {1, 2, 15, 16}) {
            CAPTURE(spp);
            Film film = film_with(16, 16, spp, [](size_t, int s) { return 1 + 0.01 * (s % 2); });
            film.start_batches();
            Lines expected;
            if (spp > 1 && spp < 16)
                expected = {
                    "the error is estimated from few passes: the true one may be half or twice as "
                    "large"};
            CHECK(told(film) == expected);
        }
        const Lines few = {
            "the error is estimated from few pixels: the true one may be half or twice as large"};
        for (bool halves : {false, true})
            for (int noisy : {15, 17, 200}) {
                CAPTURE(halves);
                CAPTURE(noisy);
                Film film(16, 16);
                halves ? film.start_halves() : film.start_audit();
                int audited = 0;
                for (size_t i = 0; i < 256; i++) {
                    bool counts = halves || film.is_audited(i);
                    bool is_noisy = counts && audited++ < noisy;
                    for (int s = 0; s < 4; s++) {
                        double value = 1 + (is_noisy ? 0.01 * (s % 2) : 0);
                        film.add(i, grey(value));
                        if (halves) film.add(i, grey(value), 1);
                        if (!halves && counts) film.audit(i, grey(value + 0.01 * (s % 2)));
                    }
                }
                CHECK(told(film) == (halves && noisy < 16 ? few : Lines{}));
            }
    }

    TEST_CASE("truth: what each search for light leaves out, scene by scene") {
        const std::string
            leaves = "light that reaches a surface through mirrors or glass ",
            met = "is found only by chance: the true error may be larger than the reported one",
            delta = "from a point or distant light is left out: no path can hit such a light",
            both =
                "light that goes through mirrors or glass to a surface that the camera sees in "
                "mirrors or glass ",
            blurred =
                "photons blur light within their radius: the reported error does not "
                "include this bias",
            direct = leaves + "is left out, and so is light that one surface reflects to another",
            by_sky =
                "light that surfaces receive from the sky is left out: the sky is seen only "
                "directly and in mirrors";
        const std::string floor = in(diffuse, floor_2), plain = floor + high_lamp,
                          with_mirror = plain + in(mirror, ball("2 2 2", "0.2")),
                          with_glass = plain + in(glass, ball("2 2 2", "0.2")),
                          no_receiver =
                              in(black, floor_2) + high_lamp + in(mirror, ball("2 2 2", "0.2"));
        struct {
            std::string world;
            Lines light_sampling, by_chance, direct, both_ends;
        } cases[] = {
            {plain, {}, {}, {}, {}},
            {with_mirror, {leaves + met}, {}, {direct}, {both + met}},
            {with_glass, {leaves + met}, {}, {direct}, {both + met}},
            {no_receiver, {}, {}, {}, {}},
            {in(mirror, floor_2) + high_lamp, {}, {}, {}, {}},
            {with_mirror + point, {leaves + delta, leaves + met}, {}, {direct}, {both + delta}},
            {floor + point + in(glass, ball("2 2 2", "0.2")),
             {leaves + delta},
             {},
             {direct},
             {both + delta}},
            {floor + distant + in(glass, ball("2 2 2", "0.2")),
             {leaves + delta},
             {},
             {direct},
             {both + delta}},
            {floor + sky + in(glass, ball("2 2 2", "0.2")), {}, {}, {by_sky, direct}, {}},
            {plain + sky, {}, {}, {by_sky}, {}},
        };
        for (const auto& c : cases) {
            CAPTURE(c.world);
            Scene scene = seen(c.world);
            CHECK(told(scene, LightSearch::light_sampling) == c.light_sampling);
            CHECK(told(scene, LightSearch::by_chance) == c.by_chance);
            CHECK(told(scene, LightSearch::direct) == c.direct);
            CHECK(told(scene, LightSearch::both_ends, "", 1024) == c.both_ends);
            bool is_blurred = c.world.find(floor) != std::string::npos;
            CHECK(told(scene, LightSearch::photons) == (is_blurred ? Lines{blurred} : Lines{}));
        }
        // Direct light alone, and not even that.
        Scene scene = seen(plain + sky);
        scene.max_depth = 0;
        CHECK(told(scene, LightSearch::direct) == Lines{});
        // Light that mirrors and glass cast takes two scattering events, seen in them three.
        for (int depth : {1, 2, 3}) {
            scene = seen(with_glass);
            scene.max_depth = depth;
            Lines cast = depth < 2 ? Lines{} : Lines{leaves + met};
            CHECK(told(scene, LightSearch::light_sampling) == cast);
            CHECK(told(scene, LightSearch::both_ends) == (depth < 3 ? Lines{} : Lines{both + met}));
            CHECK(told(scene, LightSearch::photons) == (depth < 2 ? Lines{} : Lines{blurred}));
        }
    }

    TEST_CASE("truth: a lamp is small for chance where 50 paths do not meet it") {
        const Lines rare = {
            "this chapter finds lights only by chance, and one is so small that few paths hit it: "
            "the true error may be larger than the reported one"};
        // 1024 paths, each meets a share A / (4 pi R^2) of the scene's sphere.
        Scene scene = seen(in(diffuse, ball("0 0 0", "1")) + high_lamp + lamp(ball("2 0 0", "1")));
        for (double chance : {0.047, 0.05}) {
            CAPTURE(chance);
            for (LightShape& shape : scene.light_shapes)
                shape.area =
                    static_cast<float>(chance * 4 * pi_exact) * scene.radius * scene.radius;
            CHECK(told(scene, LightSearch::by_chance) == (chance < 0.049 ? rare : Lines{}));
            CHECK(told(scene, LightSearch::light_sampling) == Lines{});
        }
        // Of two lamps one is too small; it counts from 1 % of all power on.
        for (float L : {0.3f, 3.0f}) {
            Scene two = seen(in(diffuse, floor_2) + high_lamp + lamp(ball("0 1 0", "0.2")));
            two.lights[0].L = {1, 1, 1}, two.lights[1].L = {L, L, L};
            CHECK(told(two, LightSearch::by_chance) == (L > 1 ? rare : Lines{}));
        }
    }

    TEST_CASE("truth: where paths begin at lights, the share that shows mirrors is told") {
        auto line = [](const std::string& share) {
            return Lines{share +
                         " % of the picture shows a mirror or glass: this part is black, because "
                         "no vertex on it can be connected to the camera"};
        };
        // The left quarter of what is seen of a plane, and all of it.
        auto half = [&](const std::string& material, const std::string& left) {
            return in(material,
                      "Translate " + left +
                          " 0 0 Shape \"trianglemesh\" \"integer "
                          "indices\" [0 1 2 0 2 3] \"point3 P\" [0 0 -9  0 0 9  9 0 9  9 0 -9]\n");
        };
        for (const std::string& material : {mirror, glass}) {
            Scene all = seen(in(material, floor_2) + high_lamp, "0 3 0  0 0 0  0 0 1", "20");
            CHECK(told(all, LightSearch::from_lights) == line("100"));
            Scene right = seen(half(material, "0") + high_lamp, "0 3 0  0 0 0  0 0 1", "20");
            CHECK(told(right, LightSearch::from_lights) == line("50"));
        }
    }

    TEST_CASE(
        "truth: paths from lights that hardly reach what the camera sees, or glass, are told") {
        // The disk on which paths from the sky and the sun begin grows with the ground.
        auto tells = [](const std::string& world, LightSearch search, const std::string& line) {
            Scene scene = seen(world);
            Film film = film_with(16, 16, 256, [](size_t, int s) { return 2 * (s % 2); });
            RenderOptions options;
            options.search = search;
            Lines lines = warnings_of(scene, options, Rendering{film, {}, {}});
            return std::ranges::any_of(lines, [&](const auto& l) { return l.starts_with(line); });
        };
        for (bool far : {false, true}) {
            CAPTURE(far);
            std::string ground = in(diffuse, (far ? "Scale 5e3 1 5e3 " : "Scale 2 1 2 ") + floor_2);
            std::string roof = in(diffuse, "Translate 0 9 0 Scale 6e3 1 6e3 " + floor_2);
            for (const std::string& light : {sky, distant}) {
                CHECK(tells(ground + light, LightSearch::from_lights, "so few paths") == far);
                CHECK(!tells(ground + roof + light, LightSearch::from_lights, "so few paths"));
            }
            std::string with_glass = ground + in(glass, ball("0 1 0", "0.5"));
            for (LightSearch search : {LightSearch::both_ends, LightSearch::merging}) {
                CHECK(tells(with_glass + distant, search, "hardly any path") == far);
                CHECK(!tells(with_glass + sky, search, "hardly any path"));
            }
        }
    }

    TEST_CASE("truth: what a chapter has to say of its own comes last") {
        Scene scene = seen(in(diffuse, floor_2) + high_lamp);
        Rendering r{film_with(16, 16, 2, [](size_t, int) { return 0; }), {}, {}};
        r.warnings = {"its own"};
        Lines lines = warnings_of(scene, {}, r);
        REQUIRE(lines.size() == 3);
        CHECK(lines[0] == "the picture is black: no sample found light");
        CHECK(lines[1].starts_with("possible cause: "));
        CHECK(lines[2] == "its own");
    }

    TEST_CASE("truth: the causes of a black picture, all of them, and no others") {
        const std::string floor = in(diffuse, floor_2), small_lamp = lamp(ball("0 5 0", "0.3")),
                          wall = in(diffuse, "Translate 0 4.5 0 Scale 3 1 3 " + floor_2),
                          pane = in(glass, "Translate 0 4 0 Scale 3 1 3 " + floor_2);
        const std::string stands = "something stands between the lights and all that is in view",
                          straight = "with a depth of 1 light comes straight from the lights alone",
                          inside =
                              "all that the camera sees it sees from behind: it may be inside "
                              "something",
                          ways =
                              "light takes ways here that too few paths find: more samples, or "
                              "another chapter",
                          through =
                              "light comes to what is in view only through glass, where "
                              "light sampling does not find it: chapters 20 to 25 do",
                          turned =
                              ": ReverseOrientation turns a light, \"bool twosided\" true "
                              "lights both sides",
                          away = "the lights face away from all that is in view";
        auto causes = [](Scene scene, LightSearch search = LightSearch::light_sampling,
                         int depth = 5, const std::string& paths = "") {
            RenderOptions options;
            options.search = search, options.paths = paths;
            scene.max_depth = depth;
            return causes_of_black(scene, options, 0.02);
        };
        CHECK(causes(seen(floor + small_lamp)) == Lines{ways});
        CHECK(causes(seen(floor + small_lamp), LightSearch::direct) == Lines{ways});
        CHECK(causes(seen(floor + small_lamp), LightSearch::both_ends) == Lines{ways});
        CHECK(causes(seen(floor + small_lamp), LightSearch::light_sampling, 5, "LDE") ==
              Lines{"--paths keeps no class of path that brings light", ways});
        CHECK(
            causes(seen(floor + small_lamp), LightSearch::by_chance) ==
            Lines{"this chapter finds lights only by chance, by about one path in 50: more samples "
                  "find them, or a chapter that samples lights (from 09 on)"});
        CHECK(causes(seen(floor + small_lamp), LightSearch::from_lights) ==
              Lines{"paths begin at the lights, and few of them come to what the camera sees: more "
                    "samples, or a chapter whose paths begin at the camera"});
        CHECK(causes(seen(floor + small_lamp), LightSearch::photons) ==
              Lines{"photons begin at the lights, and few of them come to what the camera sees: "
                    "more photons, or a chapter whose paths begin at the camera"});
        CHECK(causes(seen(floor + small_lamp + wall)) == Lines{stands});
        CHECK(causes(seen(floor + small_lamp + wall), LightSearch::light_sampling, 1) ==
              Lines{stands, straight});
        CHECK(causes(seen(floor + small_lamp + pane)) == Lines{through, ways});
        CHECK(causes(seen(floor + small_lamp + pane + wall)) == Lines{stands});
        CHECK(causes(seen(floor + small_lamp), LightSearch::light_sampling, 0) ==
              Lines{"with a depth of 0 only lights themselves are seen, and none is in view"});
        CHECK(causes(seen(floor + small_lamp, "0 2 -4  0 9 0  0 1 0")) ==
              Lines{"the camera sees no surface: see its LookAt, fov and Scale"});
        CHECK(causes(seen(in(black, floor_2) + small_lamp)) ==
              Lines{"all surfaces in view are black: they reflect nothing"});
        CHECK(causes(seen(in(mirror, floor_2) + small_lamp, "0 2 -4  0 0.3 0  0 1 0", "5")) ==
              Lines{"the camera sees mirrors and glass alone, and nothing in or behind them"});
        CHECK(causes(seen(small_lamp + in(diffuse, ball("0 2 -4", "1")))) ==
              Lines{inside, "all surfaces in view face away from the lights"});
        // What a mirror or glass shows is in view.
        for (const std::string& way : {mirror, glass}) {
            Scene there = seen(in(way, floor_2) +
                                   in(black, "Scale 99 9 99 Translate 0 -1 0 " + floor_2 +
                                                 "Translate 0 2 0 " + floor_2) +
                                   small_lamp,
                               "0 2 -4  0 0.3 0  0 1 0", "5");
            CHECK(causes(there) == Lines{"all surfaces in view are black: they reflect nothing"});
        }
        // Lights that face away: the first that has a surface is named with its place.
        std::string down = "Translate 0 5 0 Rotate -90 1 0 0 Shape \"disk\"\n";
        CHECK(causes(seen(floor + lamp(down))) == Lines{away + " (test.pbrt:10:34)" + turned});
        CHECK(causes(seen("LightSource \"point\" \"point3 from\" [0 -5 0]\n" + floor)) ==
              Lines{"all surfaces in view face away from the lights"});
        CHECK(causes(seen("LightSource \"point\" \"point3 from\" [0 5 0]\n" + floor + wall)) ==
              Lines{stands});
        CHECK(causes(seen(floor + sky)) == Lines{ways});
    }

    TEST_CASE("agreement: light by nearly mirrors is that which a bidirectional tracer finds") {
        // A lamp that shines away from the floor onto a plate of metal above, which lights it.
        auto scene_with = [](const std::string& reflectance, float scale = 1) {
            std::string s = std::to_string(scale);
            Scene scene = scene_of(
                "Scale " + s + " " + s + " " + s +
                " LookAt 0 0.8 -0.5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 80\n"
                "WorldBegin\n" +
                in("AreaLightSource \"diffuse\" \"rgb L\" [100 50 20]\n" + black,
                   "Translate 0.5 1 0 Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 0.1\n") +
                in("Material \"conductor\" \"rgb reflectance\" [" + reflectance +
                       "] \"bool remaproughness\" false \"float roughness\" 0.05\n",
                   "Translate 0.5 3 0 Rotate 180 0 0 1 Scale 0.3 1 0.3 " + floor_2) +
                in(diffuse, floor_2));
            scene.width = scene.height = 16;
            scene.max_depth = 2;
            return scene;
        };
        Scene scene = scene_with("0.9 0.8 0.4");
        REQUIRE(is_nearly_mirror(scene.materials[scene.shapes[1].material], 100));
        SplatTrace trace = splat_trace_with<ch21::trace>(endpoints_of(scene));
        Film film = film_of(scene, trace, 512).film;
        double found = light_by_nearly_mirrors(scene, 100, false);
        CHECK(film.standard_error() < 0.02 * film.mean());
        CHECK(std::abs(found / film.mean() - 1) < 0.05 + 5 * film.standard_error() / film.mean());
        // Half the reflectance is half the light; a scene of another size has the same.
        CHECK(light_by_nearly_mirrors(scene_with("0.45 0.4 0.2"), 100, false) ==
              doctest::Approx(found / 2).epsilon(1e-3).scale(0));
        CHECK(light_by_nearly_mirrors(scene_with("0.9 0.8 0.4", 8), 100, false) ==
              doctest::Approx(found).epsilon(0.02).scale(0));
        // So many paths meet the lamp by themselves: there is nothing to warn of.
        CHECK(light_by_nearly_mirrors(scene, 1e6, false) == 0);
        CHECK(light_by_nearly_mirrors(scene, 20 / 0.0025, false) == 0);
    }

    TEST_CASE("agreement: what nearly mirrors show the camera, as a path tracer finds it") {
        Scene scene = seen(lamp(ball("0 1.5 3", "0.6")) +
                               in("Material \"conductor\" \"bool remaproughness\" false \"float "
                                  "roughness\" 0.02\n",
                                  "Scale 0.3 1 0.3 " + floor_2) +
                               in(diffuse, "Translate 0 -0.5 0 Scale 3 1 3 " + floor_2),
                           "0 1.5 -3  0 0 0  0 1 0", "40");
        Trace trace = trace_with<ch15::trace>(ch15::prepare(scene));
        Film film = film_of(scene, trace, 64).film, few(16, 16);
        NearlyMirrorsSeen is = nearly_mirrors_seen(scene, film_of(scene, trace, 4).film);
        // By hand: the pixels whose middle shows the plate.
        double share = 0, mean = 0;
        CameraView view = camera_view(scene.camera, 16, 16);
        for (size_t i = 0; i < 256; i++) {
            Vec2 middle = {static_cast<float>(i % 16) + 0.5f, static_cast<float>(i / 16) + 0.5f};
            auto hit = intersect(scene, camera_ray(view, middle));
            if (!hit || !is_rough(*hit->material)) continue;
            share += 1.0 / 256, mean += film.pixels()[i].mean() / 256;
        }
        CHECK(is.share == share);
        CHECK(share > 0.05);
        CHECK(is.hits > 1000);
        CHECK(is.error < 0.02 * is.expected);
        CHECK(std::abs(is.expected / mean - 1) < 0.03);
        CHECK(std::abs(is.found / mean - 1) < 0.15);
        CHECK(is.found != is.expected);
    }
}
