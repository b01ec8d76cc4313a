// Law: every method finds the light that a scene is known to have.
#include "common/light/lights.h"
#include "tests/laws/laws.h"
#include "tests/support/folder.h"
#include "tests/support/ggx_truth.h"
#include "tests/support/known_lights.h"

namespace {

std::string at(double x, double y, double z) {
    return "Translate " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) +
           " ";
}
std::string thing(const std::string& material, const std::string& shape) {
    return "AttributeBegin Material " + material + " " + shape + " AttributeEnd ";
}
/// A lamp of this radiance; sides: "false" or "true", whether both shine.
std::string lamp(const std::string& L, const std::string& shape, const std::string& reflectance,
                 const std::string& two_sided = "false") {
    return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [" + L + " " + L + " " + L +
           "] \"bool twosided\" " + two_sided + " Material \"diffuse\" \"rgb reflectance\" [" +
           reflectance + "]\n" + shape + "AttributeEnd\n";
}
const std::string white_sky = "LightSource \"infinite\"\n";

/// Irradiance of the unit square at height h, straight overhead.
double irradiance_of_square(double h) {
    double a = 0.5 / h, s = a / std::sqrt(1 + a * a);
    return 4 * s * std::atan(s);
}

/// A pane of glass, upright before a sky of which a black wall hides one half: that behind the eye,
/// or that behind the pane.
Scene pane_before_half_a_sky(bool sky_behind_pane) {
    auto wall = [](double z, bool facing) {
        return at(0, 0, z) + "Rotate -90 1 0 0 Scale 300 1 300 " + square(0, facing);
    };
    Scene scene = world_of(white_sky + thing("\"dielectric\"", wall(0, true)) +
                           thing("\"dielectric\"", wall(0.1, false)) +
                           "Material \"diffuse\" \"rgb reflectance\" [0 0 0] " +
                           wall(sky_behind_pane ? -5 : 5, true));
    scene.max_depth = 1000;
    return scene;
}

/// What all lights give the floor's point x, each one by itself: no choice among them.
Measured sum_over_lights(const Scene& scene, const Hit& x, int samples) {
    double sum = 0, variance = 0;
    Sampler random = random_numbers(1);
    for (size_t i = 0; i < scene.lights.size(); i++) {
        RunningStats one;
        for (int k = 0; k < samples; k++) {
            LightSample y = sample_one_light(scene, i, x, random.u2());
            float cos_x = std::max(0.0f, dot(y.wi, x.n));
            bool lit = y.pdf_w > 0 && cos_x > 0 && !occluded(scene, spawn_ray(x, y.wi, y.dist));
            one.add(lit ? static_cast<double>(average(y.Le) * cos_x / y.pdf_w) : 0);
        }
        sum += one.mean(), variance += one.standard_error() * one.standard_error();
    }
    return {sum, std::sqrt(variance)};
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

}  // namespace

TEST_SUITE("law: known light") {
    TEST_CASE("truth: lights of every kind, alone and together") {
        for (const auto& all : {lights_of_known_irradiance, lights_without_size})
            for (const auto& [lights, E] : all) {
                CAPTURE(lights);
                check_light(lit_floor(lights), {E / pi_exact});
            }
    }

    TEST_CASE("truth: flux onto a floor, from every light and by a mirror") {
        // The picture shows a square of 1 m: its mean is that of its irradiance.
        auto floor_in_sight = [](const std::string& lights) {
            Scene scene = scene_of(
                "LookAt 0 0.5 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 90\n"
                "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n" +
                thing("\"diffuse\" \"rgb reflectance\" [.5 .5 .5]", square(0, true)) + lights);
            scene.max_depth = 2;
            return scene;
        };
        const std::string lamp_above = black_lamp("1", unit_square(1));
        for (const auto& [lights, E] : std::vector<std::pair<std::string, double>>{
                 {lamp_above, 0.1998248956984 * pi_exact},
                 {"LightSource \"point\" \"point3 from\" [0 1 0]", 4 * std::asin(0.2)},
                 {"LightSource \"distant\" \"point3 from\" [0 3 4] \"point3 to\" [0 0 0]", 0.6},
                 {white_sky, pi_exact}}) {
            CAPTURE(lights);
            check_light(floor_in_sight(lights), {0.5 * E / pi_exact, 0.03, 0, true});
        }
        // A lamp aside that shines up into a mirror, as its image would down.
        auto aside = [](double h, bool up) {
            return black_lamp("1", at(1.5, h, 0) + "Scale 0.5 1 0.5 " + square(0, up));
        };
        Measured image =
            brightness(floor_in_sight(aside(1.5, false)), methods_named({"15"})[0], 400000);
        check_light(
            floor_in_sight(aside(0.5, true) + thing(mirror, "Scale 9 1 9 " + square(1, false))),
            {image.mean, 0.03, image.se, true});
    }

    TEST_CASE("truth: a lamp close to the floor is as bright when it is cut into many lamps") {
        // Both strategies of MIS count, each with the choice among the lamps in its density.
        for (int n : {1, 2, 3}) {
            CAPTURE(n);
            std::string lamps, side = std::to_string(0.5 / n) + " ";
            for (int i = 0; i < n * n; i++)
                lamps += black_lamp("1", at((i % n + 0.5) / n - 0.5, 0.1, (i / n + 0.5) / n - 0.5) +
                                             "Scale " + side + "1 " + side + square(0, false));
            check_light(lit_floor(lamps), {irradiance_of_square(0.1) / pi_exact, 0.01});
        }
    }

    TEST_CASE("truth: a two-sided lamp gives the same from behind, near and far") {
        for (double h : {0.5, 3.0, 10.0}) {
            CAPTURE(h);
            // Its front looks up. A second lamp makes chapters choose.
            Scene scene = lit_floor(
                lamp("1", at(0, h, 0) + "Scale 0.5 1 0.5 " + square(0, true), "0 0 0", "true") +
                lamp("1", at(0, h + 1, 0) + "Scale 0.2 1 0.2 " + square(0, true), "0 0 0", "true"));
            check_light(scene, {irradiance_of_square(h) / pi_exact});
        }
    }

    TEST_CASE("truth: the sky is one light among others, whatever its number") {
        // It is no light's turn to be first: a lamp of 10 before it, one of 5 behind it.
        std::string tilted = at(3, 1, 0) + "Rotate -60 0 0 1 Scale 0.5 1 0.5 " + square(0, false);
        std::string overhead = black_lamp("10", unit_square(1)), aside = black_lamp("5", tilted);
        std::string sky = "LightSource \"infinite\" \"float scale\" 2\n";
        Measured of_aside = brightness(lit_floor(aside), methods_named({"10"})[0], 400000);
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

    TEST_CASE(
        "truth: a pane at a grazing angle before half a sky: (1 - R) / (1 + R), and the rest") {
        // At 80 degrees R = 0.3878: paths run to and fro in the glass, and roulette ends many.
        double a = 80 * pi_exact / 180, cos_t = std::sqrt(1 - std::pow(std::sin(a) / 1.5, 2));
        double s = (std::cos(a) - 1.5 * cos_t) / (std::cos(a) + 1.5 * cos_t);
        double p = (1.5 * std::cos(a) - cos_t) / (1.5 * std::cos(a) + cos_t);
        double R = (s * s + p * p) / 2;
        CHECK(R == doctest::Approx(0.3878).epsilon(1e-3).scale(0));
        Ray ray = {{0, 0, -4},
                   {0, static_cast<float>(std::sin(a)), static_cast<float>(std::cos(a))}};
        for (bool behind_pane : {true, false})
            check_light(seen_along(pane_before_half_a_sky(behind_pane), ray),
                        {behind_pane ? (1 - R) / (1 + R) : 2 * R / (1 + R), 0.005});
    }

    TEST_CASE("failure: without lights a picture is black") {
        check_light(seen_along(floor_without_lights(), onto_origin), {0});
    }

    TEST_CASE("truth: a lamp in a mirror, and straight on") {
        Scene scene = light_before_mirror();
        check_light(seen_along(scene, {{0, 0, -4}, {0, 0, 1}}), {0.9, 1e-5});
        check_light(seen_along(scene, {{0, 0, -4}, {0, 0, -1}}), {1, 1e-5});
    }

    TEST_CASE("truth: among a thousand lights the choice gives the sum of them all") {
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 32, 1);
        CameraView view = camera_view(scene.camera, 32, 32);
        int points = 0;
        for (Vec2 film : {Vec2{16, 20}, {8, 24}, {24, 28}, {16, 30}}) {
            Ray ray = camera_ray(view, film);
            std::optional<Hit> x = intersect(scene, ray);
            if (!x || x->light >= 0 || x->material->type != MaterialType::diffuse) continue;
            points++;
            Measured all = sum_over_lights(scene, *x, 16);
            double f = static_cast<double>(average(x->material->reflectance)) / pi_exact;
            check_light(seen_along(scene, ray), {f * all.mean,
                                                 0.03,
                                                 f * all.se,
                                                 false,
                                                 {"07", "08", "09", "09-area", "10", "13-bsdf"}});
        }
        CHECK(points >= 3);
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
                if (m.number() < 10 || m.number() > 15) known.except.push_back(m.name);
            check_light(seen_along(scene, {{0, 0, 0}, {0, 0, 1}}), known);
        }
    }

    TEST_CASE("furnace: inside a sphere that emits 1 and reflects the albedo: 1 / (1 - albedo)") {
        for (double albedo : {0.0, 0.5, 0.8}) {
            std::string a = std::to_string(albedo) + " ";
            Scene scene = scene_of(
                "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 60\n"
                "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n" +
                lamp("1", "ReverseOrientation Shape \"sphere\" \"float radius\" 0.1 ", a + a + a));
            scene.max_depth = 1000;
            check_light(scene, {1 / (1 - albedo), 0.01, 0, true});
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

    TEST_CASE("furnace: a sky in mirrors and glass that fill the scene") {
        // They are so near to each other that paths from the sky find what they show as often as
        // paths from the eye do.
        std::string plate = "Translate 0 -1 0 Rotate 20 1 0 0 " + square(0, true);
        check_light(furnace("LightSource \"infinite\" \"rgb L\" [2 2 2] " +
                            thing(white_paint, plate) + thing(mirror, ball("-0.5 -0.4 0", "0.5")) +
                            thing(glass, ball("0.5 -0.4 0", "0.5"))),
                    {2, 0.01});
    }

    TEST_CASE("furnace: under a sky of radiance 1 a picture's mean is the mean of its texture") {
        // The square reaches beyond the film, which sees one whole period of the texture.
        TemporaryFolder folder;
        Image picture(5, 3);
        Sampler random = random_numbers(7);
        double mean = 0;
        for (Rgb& r : picture.pixels) {
            r = {random.u1(), random.u1(), random.u1()};
            mean += double{average(r)} / static_cast<double>(picture.pixels.size());
        }
        write_image(folder / "a.pfm", picture, "");
        std::string half = std::to_string(16 * std::tan(std::numbers::pi / 9));
        check_light(
            world_of(white_sky + "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" +
                     folder / "a.pfm" +
                     "\" \"float uscale\" 4 \"float vscale\" 4 Material \"diffuse\" "
                     "\"texture reflectance\" \"t\" Scale " +
                     half + " " + half +
                     " 1 Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
                     "[-1 -1 0 -1 1 0 1 1 0 1 -1 0] \"point2 uv\" [0 0 0 1 1 1 1 0]"),
            {mean, 0.005});
    }
}
