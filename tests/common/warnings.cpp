// What is said of a picture's error, and of light that is missing: each rule on both sides of its
// threshold, and what programs say.
#include "common/render/warnings.h"

#include <doctest/doctest.h>

#include "common/scene/light_shape.h"
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
                  small_lamp = lamp(ball("0 5 0", "0.3")), grey_floor = in(diffuse, floor_2),
                  some_glass = in(glass, ball("2 2 2", "0.2"));

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
        CHECK(are(told(film_with(2, [](size_t, int) { return 0; })), {"the picture is black"}));
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
                    film.add(i, grey(1 + (i < noisy ? 0.01 * (s / 2 % 2) : 0)), s % 2);
            CHECK(are(told(film), noisy < 16 ? Lines{"estimated from few pixels"} : Lines{}));
        }
    }

    TEST_CASE("truth: blur is told where it exceeds a tenth of the noise") {
        // A mean of 1, and a standard error of 0.01; photons that tell of this blur.
        Film film = film_with(4, [](size_t, int s) { return 1 + 0.277 * (s % 2); });
        double error = film.standard_error() / film.mean();
        for (double blur : {0.0, 0.05 * error, -0.05 * error, 0.15 * error, -0.15 * error, 0.5}) {
            CAPTURE(blur);
            SampleCounts counts = {.photons = 2'000'000};
            counts.inner_photons = static_cast<uint64_t>(std::lround(1e6 * (1 + blur)));
            bool much = std::abs(blur) > 0.1 * error;
            CHECK(are(warnings_of(film, counts), much ? Lines{"photons blur light"} : Lines{}));
        }
    }

    TEST_CASE("truth: what each search for light leaves out, scene by scene") {
        const std::string met = "through mirrors or glass is found only by chance",
                          delta = "through mirrors or glass from a point or distant light is left",
                          both_met = "sees in mirrors or glass is found only by chance",
                          both_delta = "sees in mirrors or glass from a point or distant light";
        const std::string plain = grey_floor + high_lamp,
                          some_mirror = in(mirror, ball("2 2 2", "0.2")),
                          black_floor = in(black, floor_2);
        struct {
            std::string world;
            Lines light_sampling, both_ends;
        } cases[] = {
            {plain, {}, {}},
            {plain + some_mirror, {met}, {both_met}},
            {black_floor + high_lamp + some_mirror, {}, {}},
            {plain + some_mirror + point, {delta, met}, {both_delta}},
            {grey_floor + distant + some_glass, {delta}, {both_delta}},
            {grey_floor + sky + some_glass, {}, {}},
            {black_floor + sky, {}, {}},
        };
        for (const auto& c : cases) {
            CAPTURE(c.world);
            Scene scene = seen(c.world);
            bool is_lit = c.world.starts_with(grey_floor);
            CHECK(are(told(scene, LightSearch::light_sampling), c.light_sampling));
            CHECK(are(told(scene, LightSearch::by_chance), {}));
            CHECK(are(told(scene, LightSearch::direct),
                      is_lit ? Lines{"from the middle of each lamp"} : Lines{}));
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
            CHECK(are(told(cast, LightSearch::merging, quiet_film(1024)), {}));
        }
    }

    TEST_CASE("truth: lamps that few paths hit by chance are told, and mirrors") {
        for (const char* radius : {"0.5", "1.2"}) {
            Scene lit = seen(grey_floor + lamp(ball("0 5 0", radius)));
            // The sphere around the scene has a radius of about 3.5: of 1024 paths 21 and 120.
            bool rare = radius[0] == '0';
            CHECK(are(told(lit, LightSearch::by_chance),
                      rare ? Lines{"so small that few paths hit it"} : Lines{}));
            CHECK(are(told(lit, LightSearch::by_chance, quiet_film(16)), {}));
            Scene cast =
                seen(grey_floor + point + in(mirror, ball("2 2 2", rare ? "0.03" : "0.2")));
            CHECK(are(told(cast, LightSearch::merging, quiet_film(96)),
                      rare ? Lines{"hardly any path from a point"} : Lines{}));
            CHECK(are(told(cast, LightSearch::merging, quiet_film(6400)), {}));
        }
    }

    TEST_CASE("truth: mirrors, glass and smooth metal that light paths cannot show are told") {
        for (const char* share : {"100", "50"}) {
            std::string right = share[0] == '5' ? "Translate 2 0 0 " : "";
            for (const std::string& surface : {mirror, metal("0.001", "0.9 0.9 0.9")}) {
                Scene scene = seen(in(surface, right + floor_2) + high_lamp, from_above);
                Lines lines = told(scene, LightSearch::from_lights);
                REQUIRE(!lines.empty());
                CHECK(lines.back().starts_with(share + std::string(" % of the picture shows")));
            }
        }
    }

    TEST_CASE("truth: surfaces that no path from a light has reached are told, and no noise") {
        // Of 16 x 16 pixels the first rows are black, or all but a sixteenth.
        auto are_told = [](const Scene& scene, auto black) {
            Film film = film_with(64, [&](size_t i, int s) {
                return black(i % 16, i / 16) ? 0 : 1 + 0.01 * (s % 2);
            });
            Lines lines = told(scene, LightSearch::from_lights, film);
            for (const std::string& line : lines)
                if (has(line, "no path from a light has reached")) return true;
            return false;
        };
        auto rows = [](size_t n) { return [n](size_t, size_t y) { return y < n; }; };
        Scene lit = seen(grey_floor + high_lamp, from_above);
        CHECK(are_told(lit, rows(3)));
        CHECK_FALSE(are_told(lit, rows(2)));
        CHECK_FALSE(are_told(lit, [](size_t x, size_t y) { return x % 4 != 2 || y % 4 != 2; }));
        CHECK_FALSE(are_told(seen(in(black, floor_2) + high_lamp, from_above), rows(3)));
        CHECK_FALSE(are_told(seen(grey_floor + lamp(ball("0 -5 0", "1")), from_above), rows(3)));
    }

    TEST_CASE("truth: metal that is nearly a mirror is told beside a lamp, for few samples") {
        auto is_told = [](const std::string& alpha, int spp, const std::string& rgb) {
            std::string plate = in(metal(alpha, rgb), "Translate 1 0.1 0 " + floor_2);
            Lines lines = told(seen(plate + grey_floor + small_lamp), LightSearch::light_sampling,
                               quiet_film(spp));
            return std::ranges::any_of(lines, [](const std::string& line) {
                return has(line, "via nearly smooth metal is found only by chance");
            });
        };
        CHECK(is_told("0.05", 16, "0.9 0.9 0.9"));        // 4096 0.05^2 = 10 reflections
        CHECK_FALSE(is_told("0.05", 64, "0.9 0.9 0.9"));  // 41
        CHECK_FALSE(is_told("0.3", 16, "0.9 0.9 0.9"));
        CHECK_FALSE(is_told("0.05", 16, "0 0 0"));
    }
}
