// Law: every method finds the light that a scene is known to have.
#include "tests/laws/laws.h"
#include "tests/support/known_lights.h"

namespace {

std::string at(double x, double y, double z) {
    return "Translate " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) +
           " ";
}
std::string thing(const std::string& material, const std::string& shape) {
    return "AttributeBegin Material " + material + " " + shape + " AttributeEnd ";
}
const std::string white_sky = "LightSource \"infinite\"\n";

/// Irradiance of the unit square at height h, straight overhead.
double irradiance_of_square(double h) {
    double a = 0.5 / h, s = a / std::sqrt(1 + a * a);
    return 4 * s * std::atan(s);
}

/// n point lights in a circle of radius r around (x, y, 0), each brighter than the one before; I:
/// of all on average.
std::string points(int n, double I, double x, double y, double r) {
    std::string all;
    for (int k = 0; k < n; k++) {
        double angle = 2 * pi_exact * k / n;
        std::string rgb = std::to_string(2 * I * k / (n - 1)) + " ";
        all += "AttributeBegin " + at(x + r * std::cos(angle), y, r * std::sin(angle)) +
               "LightSource \"point\" \"rgb I\" [" + rgb + rgb + rgb + "] AttributeEnd\n";
    }
    return all;
}

/// A scene of 16 x 16 pixels, seen from z = -7.
Scene furnace(const std::string& world) {
    Scene scene = scene_of(
        "LookAt 0 0 -7  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\n"
        "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\n" +
        world);
    scene.max_depth = 80;
    return scene;
}
const std::string white_paint = "\"diffuse\" \"rgb reflectance\" [1 1 1]";
const std::string mirror = "\"conductor\" \"rgb reflectance\" [1 1 1]";
const std::string glass = "\"dielectric\"";
std::string ball(const std::string& place, const std::string& r) {
    return "Translate " + place + " Shape \"sphere\" \"float radius\" " + r + " ";
}

/// The picture shows a square of 1 m: its mean is that of its irradiance.
Scene floor_in_sight(const std::string& lights, const std::string& shape = square(0, true)) {
    Scene scene = scene_of(
        "LookAt 0 0.5 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 90\n"
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n" +
        thing("\"diffuse\" \"rgb reflectance\" [.5 .5 .5]", shape) + lights);
    scene.max_depth = 2;
    return scene;
}

/// A lamp aside that shines up into a mirror lights the floor as its image would.
void check_by_mirror(const std::string& floor, double bound) {
    auto aside = [](double h, bool up) {
        return black_lamp("1", at(1.5, h, 0) + "Scale 0.5 1 0.5 " + square(0, up));
    };
    Measured image =
        brightness(floor_in_sight(aside(1.5, false), floor), methods_named({"15"})[0], 100000);
    std::string lamp = aside(0.5, true) + thing(mirror, "Scale 9 1 9 " + square(1, false));
    check_light(floor_in_sight(lamp, floor), {image.mean, bound, image.se, true});
}

}  // namespace

TEST_SUITE("law: known light") {
    /// The known scenes from one to another, also by class of path. The standard error is at most
    /// `least`, or more, up to `most`, where all chapters together do not know the light well.
    void check_known(const std::string& first, const std::string& last, double least = 0.02,
                     double most = 0.03) {
        bool has_begun = false;
        for (const KnownScene& known : known_scenes()) {
            has_begun |= known.name == first;
            if (!has_begun) continue;
            CAPTURE(known.name);
            Quantity all = known.light.at("all");
            double hard = all.mean > 0 ? 25 * all.se / all.mean : 0;
            KnownLight light = {all.mean, std::clamp(hard, least, most), all.se + 1e-5 * all.mean};
            light.most = 1024 * known.samples, light.parts = known.light;
            Scene scene = scene_of(known.text);
            // In `red` paths from both ends have thousands of connections. In `box` one in a
            // thousand goes through a corner. Paths from the sky hardly ever meet what is seen.
            bool by_eye = known.name == "red" || known.name == "box";
            for (const NamedMethod& m : all_methods()) {
                bool as_another = m.is_variant() && m.name != "09-area" && !m.random_hits();
                bool too_rare = m.number() == 20 && scene.sky_light >= 0;
                if (as_another || too_rare || m.number() < known.first_chapter ||
                    (by_eye && m.number() > 20))
                    light.except.push_back(m.name);
            }
            check_light(scene, light);
            if (known.name == last) return;
        }
        FAIL("no known scene ", last);
    }
    TEST_CASE("truth: floors under known lamps") { check_known("floor", "horizon"); }
    TEST_CASE("truth: known light of two bounces") { check_known("wall-beside", "metal-beside"); }
    TEST_CASE("truth: known skies and rooms") { check_known("sky", "box", 0.03); }
    TEST_CASE("truth: known lights of other kinds") { check_known("point", "shining-ball", 0.01); }
    TEST_CASE("truth: known normals that lean") { check_known("leaning", "bent-mirror"); }
    TEST_CASE("truth: known mirrors and glass") { check_known("corridor", "tiny"); }
    TEST_CASE("truth: known rough metal") { check_known("metal-wall", "real-metal", 0.01, 0.01); }
    TEST_CASE("truth: known cameras, colors and skies") {
        check_known("corner", "sky-picture", 0.02, 0.06);
    }
    TEST_CASE("truth: known light of several things at once") {
        check_known("small", "still-life", 0.03, 0.06);
    }
    TEST_CASE("truth: known scenes for any renderer") { check_known("frame", "pearl", 0.03); }

    TEST_CASE("truth: a lamp whose normals lean lights as a flat one does") {
        Scene scene = scene_of(known_scene("leaning-lamp").text);  // the unit square at 1.5 m
        check_light(seen_along(scene, onto_origin), {0.5 * 0.3874136329362 / pi_exact});
    }

    TEST_CASE("truth: flux onto a floor, from every light and by a mirror") {
        const std::string lamp_above = black_lamp("1", unit_square(1));
        for (const auto& [lights, E] : std::vector<std::pair<std::string, double>>{
                 {lamp_above, 0.1998248956984 * pi_exact},
                 {"LightSource \"point\" \"point3 from\" [0 1 0]", 4 * std::asin(0.2)},
                 {"LightSource \"distant\" \"point3 from\" [0 3 4] \"point3 to\" [0 0 0]", 0.6},
                 {white_sky, pi_exact}}) {
            CAPTURE(lights);
            check_light(floor_in_sight(lights), {0.5 * E / pi_exact, 0.03, 0, true});
        }
        check_by_mirror(square(0, true), 0.03);
    }

    TEST_CASE("truth: flux by a mirror onto a floor whose normals lean from the lamp") {
        // It is lit where they look away from the camera, since the geometric normal takes their
        // place there.
        check_by_mirror(
            "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-.5 0 -.5  "
            "-.5 0 .5  .5 0 .5  .5 0 -.5] \"normal N\" [-6 1 0  -6 1 0  -6 1 0  -6 1 0]",
            0.06);
    }

    TEST_CASE("truth: the sky is one light among others, whatever its number") {
        // It is no light's turn to be first: a lamp of 10 before it, one of 5 behind it.
        std::string tilted = at(3, 1, 0) + "Rotate -60 0 0 1 Scale 0.5 1 0.5 " + square(0, false);
        std::string overhead = black_lamp("10", unit_square(1)), aside = black_lamp("5", tilted);
        std::string sky = "LightSource \"infinite\" \"float scale\" 2\n";
        Measured of_aside = brightness(lit_floor(aside), methods_named({"10"})[0], 100000);
        REQUIRE(of_aside.mean > 0.03);
        double L = 2 + 8 * irradiance_of_square(1) / pi_exact + of_aside.mean * 3 / 5;
        for (const std::string& lights :
             {sky + overhead + aside, overhead + sky + aside, aside + overhead + sky})
            check_light(lit_floor(lights), {L, 0.02, of_aside.se});
    }

    TEST_CASE("truth: what is just below a lamp hides it, what is just behind it does not") {
        for (double size : {1.0, 100.0})
            for (double gap : {1e-4, -1e-4}) {
                CAPTURE(size);
                CAPTURE(gap);
                std::string scale = std::to_string(size) + " ";
                Scene scene =
                    lit_floor("Scale " + scale + scale + scale + black_lamp("1", unit_square(1)) +
                              at(0, 1 - gap, 0) + "Scale 0.6 1 0.6 " + square(0, false));
                check_light(scene, {gap > 0 ? 0 : irradiance_of_square(1) / pi_exact});
            }
    }

    /// A floor under n lamps, and others of huge power that light nothing.
    void check_many_lights(int n) {
        const std::string sun =
            "LightSource \"distant\" \"point3 from\" [0 1 0]"
            " \"point3 to\" [0 0 0]\n";
        const std::string roof = "AttributeBegin " + at(0, 9, 0) + "Scale 900 1 900 " +
                                 square(0, false) + "AttributeEnd\n";
        const std::string shade =
            "AttributeBegin " + at(20, 5, 0) + "Shape \"sphere\" AttributeEnd\n";
        const std::string lamps = points(n, 0.0625, 0, 2, 1);
        const double E = n * 0.0625 * 2 / std::pow(5, 1.5);
        for (const auto& [lights, truth] :
             {std::pair(lamps, E),
              {white_sky + lamps, E + pi_exact},
              {white_sky + lamps + sun, E + pi_exact + 1},
              {sun + roof + lamps, E},
              {shade + points(40, 1e9, 20, 5, 0.5) + lamps, E},
              {shade + points(n, 1e9, 20, 5, 0.5) + lamps, E},
              {lamps + points(n, 0, 0, 2, 2) + white_sky, E + pi_exact}}) {
            CAPTURE(lights.substr(0, 200));
            CAPTURE(n);
            KnownLight known = {truth / pi_exact, 0.15, 5e-6 * truth};
            // Chapter 12 rarely keeps a candidate that a brighter one outweighs.
            if (lights.starts_with(shade)) known.except = {"12", "12-m2"};
            check_light(lit_floor(lights), known);
        }
    }
    TEST_CASE("truth: more lights than candidates, some of them of huge power that light nothing") {
        for (int n : {63, 1000}) check_many_lights(n);
    }
    TEST_CASE("truth: one light more than candidates" * doctest::skip()) { check_many_lights(65); }

    TEST_CASE(
        "furnace: inside a lamp that loses 1 % at a bounce, and inside one that loses nothing") {
        for (const auto& [a, max_depth] : {std::pair(std::string("0.99 "), 100000), {"1 ", 99}}) {
            CAPTURE(max_depth);
            Scene scene = world_of(lamp("0.01", "ReverseOrientation Shape \"sphere\" ", a + a + a));
            scene.max_depth = max_depth;
            // Uniform directions are far more noise, and so many vertices many connections.
            KnownLight known = {1, 0.03, 2e-5};
            for (const NamedMethod& m : methods_for(scene))
                if (m.number() < 10 || m.number() > 15 || m.is_variant())
                    known.except.push_back(m.name);
            check_light(seen_along(scene, {{0, 0, 0}, {0, 0, 1}}), known);
        }
    }

    TEST_CASE("furnace: lamps of every shape, that shine to both sides, and mirrors and glass") {
        // Lamps emit 1 and reflect a half; all else reflects or refracts all light. Around them
        // stands a sphere that is such a lamp too, or a sky of radiance 2. So the radiance is
        // 1 + 1/2 + 1/4 + ... = 2 in every direction, at every point.
        auto two_sided = [](const std::string& shape) {
            return lamp("1", shape, ".5 .5 .5", "true");
        };
        const std::string lamps =
            two_sided("Translate -1.5 1 0 Rotate 40 1 1 0 Shape \"disk\" \"float radius\" 1 ") +
            two_sided("Translate 1.5 1.2 1 Rotate 70 1 0 2 " + square(0, true)) +
            two_sided(ball("0 -1.8 -1", "0.4")) +
            two_sided(
                "Shape \"trianglemesh\" \"point3 P\" [-3 -2 1  -1 -2 2  -2 0 1  -2 -1 3] "
                "\"integer indices\" [0 1 2 1 3 2] ");
        const std::string things = thing(glass, ball("0.4 0.3 -2", "0.7")) +
                                   thing(mirror, ball("-1.2 -0.6 -2", "0.6")) +
                                   thing(white_paint, ball("1.4 -1 -1.5", "0.5"));
        for (const std::string& around :
             {two_sided("Shape \"sphere\" \"float radius\" 10 "),
              std::string("LightSource \"infinite\" \"rgb L\" [2 2 2] ")})
            check_light(furnace(around + lamps + things), {2, 0.01});
    }
}
