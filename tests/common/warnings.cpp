// What is said of a picture's error, and of light that is missing: each rule on both sides of its
// threshold, and what programs say.
#include <doctest/doctest.h>

#include "common/render/render.h"
#include "common/scene/prepare.h"
#include "tests/support/estimators.h"

namespace {

using Lines = std::vector<std::string>;

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}
/// Whether these are the lines: as many, each with its words.
bool are(const Lines& lines, const Lines& words) {
    bool same = std::ranges::equal(lines, words, has);
    for (const std::string& line : lines)
        if (!same) MESSAGE("said: " << line);
    return same;
}

/// A film of 16 x 16 pixels in which each sample of pixel i is value(i, number of the sample).
template <class Value>
Film film_with(int spp, const Value& value) {
    Film film(16, 16);
    for (size_t i = 0; i < film.pixels().size(); i++)
        for (int s = 0; s < spp; s++) film.add(i, grey(value(i, s)));
    return film;
}
/// A film that no sample alone says anything about: 1 everywhere, with 1 % of noise.
Film quiet_film(int spp = 4) {
    return film_with(spp, [](size_t, int s) { return 1 + 0.01 * (s % 2); });
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
std::string metal(const std::string& alpha, const std::string& rgb) {
    return "Material \"conductor\" \"bool remaproughness\" false \"float roughness\" " + alpha +
           " \"rgb reflectance\" [" + rgb + "]\n";
}
const std::string point = "LightSource \"point\" \"point3 from\" [0 5 0]\n",
                  distant = "LightSource \"distant\" \"point3 from\" [0 5 0]\n",
                  sky = "LightSource \"infinite\"\n", high_lamp = lamp(ball("0 5 0", "2")),
                  small_lamp = lamp(ball("0 5 0", "0.3")),
                  turned_lamp = lamp("Translate 0 5 0 Rotate -90 1 0 0 Shape \"disk\"\n"),
                  grey_floor = in(diffuse, floor_2), some_glass = in(glass, ball("2 2 2", "0.2"));

std::string camera(const std::string& look = "0 2 -4  0 0.3 0  0 1 0") {
    return "LookAt " + look + "\nCamera \"perspective\" \"float fov\" 30\nWorldBegin\n";
}
const std::string from_above = camera("0 3 0  0 0 0  0 0 1");
/// A scene of 16 x 16 pixels.
Scene seen(const std::string& world, const std::string& view = camera()) {
    Scene scene = scene_of(view + world);
    scene.width = scene.height = 16;
    return scene;
}

/// What is said of a scene beside a film, by default one that has nothing to be warned of.
Lines told(const Scene& scene, LightSearch search, const Film& film = quiet_film()) {
    RenderOptions options;
    options.search = search;
    return warnings_of(scene, options, Rendering{film, {}, {}});
}
bool tells(const std::string& world, LightSearch search, const Film& film,
           const std::string& words) {
    Lines lines = told(seen(world), search, film);
    return std::ranges::any_of(lines, [&](const auto& line) { return has(line, words); });
}

}  // namespace

TEST_SUITE("warnings") {
    TEST_CASE("truth: what a film says of its own error") {
        // Without noise, or with little, nothing.
        CHECK(are(told(quiet_film(), 1.01), {}));
        CHECK(are(told(film_with(4, [](size_t, int) { return 1; }), 1), {}));
        // Pixels without samples, and no light.
        Film some(16, 16);
        for (size_t i = 0; i < 192; i++)
            for (int s = 0; s < 4; s++) some.add(i, grey(1 + 0.01 * s));
        CHECK(are(told(some), {"rendering ended before 25 % of the pixels had a sample"}));
        CHECK(are(told(film_with(2, [](size_t, int) { return 0; })),
                  {"the picture is black: no sample found light"}));
        // A sample that is 1 % of the picture.
        Film film = film_with(4, [](size_t, int) { return 1; });  // 1024 in all
        CHECK(are(told(film, 10.2), {}));
        CHECK(are(told(film, 10.3), {"one sample contains 1.01 % of the whole picture"}));
        // n equal samples and nothing else are n effective ones.
        for (size_t n : {99u, 100u}) {
            Film few = film_with(2, [&](size_t i, int s) { return s == 0 && i < n ? 1 : 0; });
            CHECK(are(told(few), n < 100 ? Lines{"as few as 99 samples determine"} : Lines{}));
        }
    }

    TEST_CASE("truth: bright samples make the error where they alone do, and are few") {
        // Noise in 256 pixels, and one sample of `bright` more in some; of `largest`, as is told.
        auto warns = [](size_t pixels, double bright, double largest) {
            Film film = film_with(4, [&](size_t i, int s) {
                return 1 + 0.1 * (s % 2) + (i < pixels && s == 3 ? bright : 0);
            });
            Lines lines = told(film, largest);
            return lines.size() == 1 && lines[0].starts_with("a few bright samples determine");
        };
        CHECK(warns(1, 3, 4.1));
        CHECK(warns(20, 3, 4.1));
        CHECK(warns(3, 0.7, 1.8));
        CHECK(!warns(40, 3, 4.1));    // more than 30 pixels have the error
        CHECK(!warns(20, 3, 3.5));    // what it has above the mean is below 5 % of all squares
        CHECK(!warns(3, -0.9, 1.1));  // dark samples
        Film even = film_with(4, [](size_t i, int s) { return i < 3 && s > 2 ? 1.5 : 1; });
        CHECK(are(told(even, 1.5), {}));  // noise below 0.1 %
    }

    TEST_CASE("truth: few passes, and few noisy pixels, tell an error badly") {
        for (int spp : {1, 2, 15, 16}) {
            Film film = quiet_film(spp);
            film.start_batches();
            bool few = spp > 1 && spp < 16;
            CHECK(are(told(film), few ? Lines{"estimated from few passes"} : Lines{}));
        }
        for (size_t noisy : {15u, 17u}) {
            Film film(16, 16);
            film.start_halves();
            for (size_t i = 0; i < 256; i++)
                for (int s = 0; s < 8; s++)
                    film.add(i, grey(1 + (i < noisy ? 0.01 * (s % 3 == 0) : 0)), s % 2);
            CHECK(are(told(film), noisy < 16 ? Lines{"estimated from few pixels"} : Lines{}));
        }
    }

    TEST_CASE("truth: blur is told where it exceeds a tenth of the noise") {
        // A mean of 1, and a standard error of 0.01; photons that tell of this blur.
        Film film = film_with(4, [](size_t, int s) { return 1 + 0.277 * (s % 2); });
        double error = film.standard_error() / film.mean();
        for (double blur : {0.0, 0.05 * error, -0.05 * error, 0.15 * error, -0.15 * error, 0.5}) {
            CAPTURE(blur);
            SampleCounts counts;
            counts.photons = 2'000'000;
            counts.inner_photons = static_cast<uint64_t>(std::lround(1e6 * (1 + blur)));
            bool much = std::abs(blur) > 0.1 * error;
            CHECK(are(warnings_of(film, counts), much ? Lines{"photons blur light"} : Lines{}));
        }
    }

    TEST_CASE("truth: what each search for light leaves out, scene by scene") {
        const std::string met = "through mirrors or glass is found only by random hits",
                          delta = "through mirrors or glass from a point or distant light is left",
                          both_met = "sees in mirrors or glass is found only by random hits",
                          both_delta = "sees in mirrors or glass from a point or distant light",
                          direct = "is left out, and so is light that one surface reflects",
                          by_sky = "light that surfaces receive from the sky is left out",
                          bounced = "light that one surface reflects to another is left out";
        const std::string plain = grey_floor + high_lamp,
                          some_mirror = in(mirror, ball("2 2 2", "0.2")),
                          disk_above =
                              "Rotate 90 1 0 0 Scale 2 2 1 Translate 0 0 -2 Shape \"disk\"\n",
                          wall = "Translate 0 1 1 Rotate -90 1 0 0 " + floor_2;
        struct {
            std::string world;
            Lines light_sampling, direct, both_ends;
        } cases[] = {
            {plain + some_mirror, {met}, {direct}, {both_met}},
            {grey_floor + lamp(disk_above), {}, {"from the lamp's middle"}, {}},
            {in(black, floor_2) + high_lamp + some_mirror, {}, {}, {}},
            {plain + some_mirror + point, {delta, met}, {direct}, {both_delta}},
            {grey_floor + distant + some_glass, {delta}, {direct}, {both_delta}},
            {grey_floor + sky + some_glass, {}, {by_sky, direct}, {}},
            {plain + sky, {}, {by_sky}, {}},
            {in(black, floor_2) + sky, {}, {}, {}},
            {plain + in(diffuse, wall), {}, {bounced}, {}},
            {plain + in(black, wall), {}, {}, {}},
        };
        for (const auto& c : cases) {
            CAPTURE(c.world);
            Scene scene = seen(c.world);
            CHECK(are(told(scene, LightSearch::light_sampling), c.light_sampling));
            CHECK(are(told(scene, LightSearch::random_hits), {}));
            CHECK(are(told(scene, LightSearch::direct), c.direct));
            CHECK(are(told(scene, LightSearch::both_ends, quiet_film(1024)), c.both_ends));
            CHECK(are(told(scene, LightSearch::photons), {}));
        }
        Scene shallow = seen(plain + sky);
        shallow.max_depth = 0;
        CHECK(are(told(shallow, LightSearch::direct), {}));
        // Light that mirrors and glass cast takes two scattering events, seen in them three.
        Scene cast = seen(plain + some_mirror);
        for (int depth : {1, 2, 3}) {
            cast.max_depth = depth;
            bool is_cast = depth > 1, is_seen = depth > 2;
            CHECK(are(told(cast, LightSearch::light_sampling), is_cast ? Lines{met} : Lines{}));
            CHECK(are(told(cast, LightSearch::both_ends, quiet_film(1024)),
                      is_seen ? Lines{both_met} : Lines{}));
        }
    }

    TEST_CASE("truth: metal that is nearly a mirror is told, beside a small lamp or in view") {
        // A plate over a floor, near a lamp: what it sends to the floor, and shows the camera.
        auto is_told = [](const std::string& alpha, const std::string& radius, int spp,
                          const std::string& rgb = "0.9 0.9 0.9") {
            std::string plate = in(metal(alpha, rgb), "Translate 1 0.1 0 " + floor_2),
                        world = plate + grey_floor + lamp(ball("0 1 0", radius)),
                        hides = "via nearly smooth metal is found only by random hits",
                        shows = "metal that is nearly a mirror: few paths from a light";
            Film film = quiet_film(spp);
            CHECK(!tells(world, LightSearch::both_ends, film, hides));
            return std::pair(tells(world, LightSearch::light_sampling, film, hides),
                             tells(world, LightSearch::from_lights, film, shows));
        };
        CHECK(is_told("0.001", "0.02", 16) == std::pair(true, true));
        CHECK(is_told("0.05", "0.02", 16) == std::pair(true, true));
        CHECK(is_told("0.01", "0.7", 16) == std::pair(false, true));    // a large lamp
        CHECK(is_told("0.3", "0.02", 16) == std::pair(false, false));   // rough
        CHECK(is_told("0.05", "0.02", 64) == std::pair(false, false));  // many samples
        CHECK(is_told("0.01", "0.02", 16, "0 0 0") == std::pair(false, false));
    }

    TEST_CASE("truth: the causes of a black picture, all of them, and no others") {
        auto causes = [](Scene scene, LightSearch search = LightSearch::light_sampling,
                         int depth = 5, const std::string& paths = "") {
            RenderOptions options;
            options.search = search, options.paths = paths;
            scene.max_depth = depth;
            return causes_of_black(scene, options);
        };
        const std::string between = "too few paths find a way from the lights to what is in view",
                          away = "the lights and all that is in view face away from each other";
        const Scene lit = seen(grey_floor + small_lamp);
        CHECK(are(causes(lit), {between}));
        CHECK(are(causes(lit, LightSearch::random_hits), {"finds lights only by random hits"}));
        CHECK(are(causes(lit, LightSearch::direct, 5, "LDE"), {"--paths keeps no", between}));
        CHECK(are(causes(lit, LightSearch::direct, 0), {"with a depth of 0 only lights"}));
        CHECK(are(causes(seen(grey_floor + small_lamp, camera("0 2 -4  0 9 0  0 1 0"))),
                  {"the camera sees no surface"}));
        CHECK(
            are(causes(seen(in(black, floor_2) + small_lamp)), {"all surfaces in view are black"}));
        CHECK(are(causes(seen(in(mirror, floor_2) + small_lamp, from_above)),
                  {"the camera sees mirrors and glass alone"}));
        CHECK(are(causes(seen(small_lamp + in(diffuse, ball("0 2 -4", "1")))),
                  {"it may be inside something", away}));
        // Lights below the floor, a lamp that faces away, and skies, which never do.
        CHECK(are(causes(seen("LightSource \"point\" \"point3 from\" [0 -5 0]\n" + grey_floor)),
                  {away}));
        CHECK(are(causes(seen(grey_floor + turned_lamp)), {away + " (test.pbrt:11:34): Reverse"}));
        CHECK(are(causes(seen(grey_floor + sky)), {between}));
        // What a chapter has to say of its own comes last.
        Rendering r{film_with(2, [](size_t, int) { return 0; }), {}, {}, 0, {"its own"}};
        CHECK(are(warnings_of(lit, {}, r), {"the picture is black", between, "its own"}));
    }
}
