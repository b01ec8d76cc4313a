// What the scene reader makes of materials, lights, spectra and files of others.
#include <doctest/doctest.h>

#include "common/base/files.h"
#include "common/material/observer.h"
#include "common/scene_file/spectra.h"
#include "tests/support/described.h"

namespace {

bool near(double a, double b) { return std::abs(a - b) <= 1e-5 * std::abs(b); }

/// How far two colors are apart in the worst channel.
float apart(Rgb a, Rgb b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

std::string last_light(const std::string& world) {
    std::string text = in_words(read_world(world));
    size_t at = text.rfind('\n', text.size() - 2) + 1;
    return text.substr(at, text.size() - at - 1);
}

Material last_material(const std::string& world) {
    return read_world(world + " Shape 'sphere'").materials.back();
}

/// How it looks, as in_words() says of a sphere.
std::string looks(const std::string& material) {
    std::string text = in_words(read_world("Material " + material + " Shape 'sphere'"));
    const std::string start = "sphere 0 0 0, 1 ";
    return text.substr(start.size(), text.find('\n') - start.size());
}

/// The reflectance at normal incidence of an interface to a metal.
double reflectance_at_normal(double eta, double k) {
    return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

const std::string quad =
    "Shape 'trianglemesh' 'integer indices' [0 1 2 0 2 3] 'point3 P' [0 0 0 2 0 0 2 1 0 0 1 0] ";

}  // namespace

TEST_SUITE("reader: materials") {
    TEST_CASE("input: metals by their reflectance, by eta and k, and by name") {
        Material m = last_material("Material 'conductor' 'rgb reflectance' [0 .5 1]");
        CHECK(m.eta == Rgb{1, 1, 1});
        CHECK(m.k.r == 0);
        CHECK(near(reflectance_at_normal(1, m.k.g), .5));
        CHECK(near(reflectance_at_normal(1, m.k.b), .9999));  // as in pbrt
        auto metal = [](Rgb eta, Rgb k, const char* alpha) {
            return "metal " + in_words(eta) + ", " + in_words(k) + ", " + alpha;
        };
        const MetalIor gold = *metal_ior("Au"), copper = *metal_ior("Cu");
        const struct {
            std::string parameters, looks;
        } cases[] = {
            {"'rgb eta' [.2 .9 1.1] 'rgb k' [3.9 2.4 2.1]", "metal 0.2 0.9 1.1, 3.9 2.4 2.1, 0"},
            {"'spectrum eta' 'metal-Au-eta' 'spectrum k' [ 'metal-Au-k' ]",
             metal(gold.eta, gold.k, "0")},
            {"'spectrum eta' [300 .5 900 .5] 'spectrum k' 'metal-Au-k'",
             metal({.5f, .5f, .5f}, gold.k, "0")},
            {"", metal(copper.eta, copper.k, "0")},
            {"'rgb eta' [1 2 3]", metal({1, 2, 3}, copper.k, "0")},
            // Roughness is the square of alpha, unless it is alpha; below .001 a metal is smooth.
            {"'float roughness' .25", metal(copper.eta, copper.k, "0.5")},
            {"'float roughness' .25 'bool remaproughness' false",
             metal(copper.eta, copper.k, "0.25")},
            {"'float uroughness' .1 'float vroughness' .1 'bool remaproughness' false",
             metal(copper.eta, copper.k, "0.1")},
            {"'float roughness' .0009 'bool remaproughness' false",
             metal(copper.eta, copper.k, "0")},
            {"'float roughness' .001 'bool remaproughness' false",
             metal(copper.eta, copper.k, "0.001")},
            {"'float roughness' .9e-6", metal(copper.eta, copper.k, "0")},
        };
        for (const auto& c : cases) CHECK(looks("'conductor' " + c.parameters) == c.looks);
        CHECK(looks("'dielectric'") == "glass 1.5");
        CHECK(looks("'dielectric' 'float eta' 1.33 'float roughness' .9e-6") == "glass 1.33");
    }

    TEST_CASE("input: named materials may be used before they are made, also by odd names") {
        Scene scene = read_world(
            "NamedMaterial 'red' Shape 'sphere' "
            "MakeNamedMaterial 'a\\'b\\\\c' 'rgb reflectance' [0 1 0] 'string type' 'diffuse' "
            "MakeNamedMaterial 'red' 'string type' 'diffuse' 'rgb reflectance' [1 0 0] "
            "Shape 'sphere' NamedMaterial 'a\\'b\\\\c' Shape 'sphere'");
        CHECK(in_words(scene).starts_with(
            "sphere 0 0 0, 1 1 0 0\nsphere 0 0 0, 1 1 0 0\nsphere 0 0 0, 1 0 1 0\n"));
    }
}

TEST_SUITE("reader: lights") {
    TEST_CASE("input: each Shape of an area light is one light with its range of primitives") {
        Scene scene = read_world(
            "AreaLightSource 'diffuse' 'rgb L' [1 2 3] 'float scale' 2 'bool twosided' true\n"
            "Shape 'sphere'\n Shape 'disk'\n " +
            quad + quad +
            "AttributeBegin AreaLightSource 'diffuse' Shape 'sphere' AttributeEnd Shape 'disk'");
        std::string lights = in_words(scene);
        CHECK(lights.substr(lights.find("infinite")) ==
              "infinite 1 1 1\narea 2 4 6, both sides of 1 from 4\n"
              "area 2 4 6, both sides of 1 from 7\narea 2 4 6, both sides of 2 from 0\n"
              "area 2 4 6, both sides of 2 from 2\narea 1 1 1, 1 from 5\n"
              "area 2 4 6, both sides of 1 from 8\n");
        CHECK(place_text(*scene.lights[2].at) == "scene.pbrt:4:2");
        for (uint32_t i = 0; i < 4; i++)
            CHECK(scene.shapes[scene.geometry.triangles[i].shape].light == (i < 2 ? 3 : 4));
        CHECK(read_world("AreaLightSource 'diffuse' 'rgb L' [0 0 0] Shape 'sphere' LightSource "
                         "'point' 'float scale' 0")
                  .lights.size() == 1);  // what is black is no light
    }

    TEST_CASE("input: power is that of each primitive, and L multiplies it") {
        auto powers = [](const std::string& parameters, const std::string& shape, double area) {
            std::vector<double> all;
            for (const Light& l :
                 read_world("AreaLightSource 'diffuse' 'float power' 5 " + parameters + shape)
                     .lights)
                if (l.type == LightType::area) {
                    CHECK(l.prims == 1);
                    all.push_back(double{pi} * area * l.L.r * (l.two_sided ? 2 : 1));
                }
            return all;
        };
        const double area = 9 * double{pi};
        auto check = [](const std::vector<double>& found, size_t count, double each) {
            CHECK(found.size() == count);
            for (double power : found) CHECK(near(power, each));
        };
        check(powers("", quad, 1), 2, 5);  // the two triangles of a quad send 5 W each, as in pbrt
        check(powers("'bool twosided' true ", quad, 1), 2, 5);
        check(powers("'rgb L' [2 2 2] ", quad, 1), 2, 10);
        check(powers("'float scale' 3 ", quad, 1), 2, 15);
        check(powers("Scale 3 3 3 ", "Shape 'sphere'", 4 * area), 1, 5);
        check(powers("Scale 3 3 3 ", "Shape 'disk'", area), 1, 5);
    }

    TEST_CASE("input: point, distant and infinite lights") {
        auto rgb = [](Rgb c) { return in_words(c); };
        const struct {
            std::string light, expected;
        } cases[] = {
            {"'point'", "point 1 1 1, 0 0 0"},
            {"'point' 'rgb I' [1 2 3] 'float scale' 2 'point3 from' [1 2 3]", "point 2 4 6, 1 4 6"},
            {"'point' 'float power' 100 'rgb I' [1 .5 2]",
             "point " + rgb(Rgb{100, 50, 200} / (4 * pi)) + ", 0 2 3"},
            {"'point' 'blackbody I' 2856 'float scale' 3",
             "point " + rgb(3 * blackbody_rgb(2856)) + ", 0 2 3"},
            {"'point' 'spectrum I' 'stdillum-A'",
             "point " + rgb(*illuminant_rgb("stdillum-A")) + ", 0 2 3"},
            {"'distant'", "distant 1 1 1, 0 0 -1"},
            {"'distant' 'rgb L' [1 2 3] 'float scale' 2 'float illuminance' 10 "
             "'point3 from' [0 5 0] 'point3 to' [0 3 0]",
             "distant 20 40 60, 0 1 0"},
            {"'infinite'", "infinite 1 1 1"},
            {"'infinite' 'rgb L' [1 2 3] 'float scale' 2", "infinite 2 4 6"},
            // illuminance is the irradiance pi L of a surface under the sky of L = 1.
            {"'infinite' 'float illuminance' 10 'rgb L' [1 1 2]",
             "infinite " + rgb(Rgb{10, 10, 20} / pi)},
        };
        for (const auto& c : cases) {
            bool at_origin = c.expected.ends_with("0 0 0");
            CHECK(last_light((at_origin ? "" : "Translate 0 2 3 LightSource ") +
                             (at_origin ? "LightSource " + c.light : c.light)) == c.expected);
        }
        // A power or illuminance that is not above 0 has no effect, as in pbrt.
        for (const char* none : {"0", "-0.0", "-1e30"}) {
            for (const auto& [type, total] : {std::pair("point", "power"),
                                              {"distant", "illuminance"},
                                              {"infinite", "illuminance"}}) {
                std::string light = std::string("LightSource '") + type + "' 'float scale' 3";
                CHECK(last_light(light + " 'float " + total + "' " + none) == last_light(light));
            }
            CHECK(last_light(std::string("AreaLightSource 'diffuse' 'float power' ") + none + ' ' +
                             quad) == "area 1 1 1, 2 from 0");
        }
    }

    TEST_CASE("truth: black bodies have the chromaticities that the CIE gives") {
        for (auto [kelvin, x, y] : {std::tuple(2855.542, 0.44757, 0.40745),  // illuminant A
                                    {6500, 0.3135, 0.3237}}) {
            Rgb c = blackbody_rgb(kelvin);
            double X = 0.4124 * c.r + 0.3576 * c.g + 0.1805 * c.b;
            double Y = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
            double Z = 0.0193 * c.r + 0.1192 * c.g + 0.9505 * c.b;
            CHECK(std::abs(X / (X + Y + Z) - x) < 2e-4);
            CHECK(std::abs(Y / (X + Y + Z) - y) < 2e-4);
            CHECK(std::abs(luminance(c) - 1) < 1e-5);
        }
        // Lines between rows of 10 nm make the observer's curves lower at their tops.
        CHECK(apart(light_rgb(standard_daylight()), *illuminant_rgb("stdillum-D65")) < 3e-3f);
        CHECK(apart(*illuminant_rgb("stdillum-A"), blackbody_rgb(2855.6)) < 3e-3f);
    }

    TEST_CASE("truth: the observer's columns have the sums and centres of the CIE's table") {
        const double sums[3] = {10.683642, 10.685779, 10.6769};
        const double centres[3] = {6108.62642, 5986.08563, 4848.0652};  // sums of nm times column
        for (size_t k = 0; k < 3; k++) {
            double sum = 0, centre = 0;
            for (size_t i = 0; i < observer.size(); i++) {
                sum += observer[i][k];
                centre += observer[i][k] * (380 + 10 * static_cast<double>(i));
            }
            CHECK(sum == doctest::Approx(sums[k]).epsilon(1e-9).scale(0));
            CHECK(centre == doctest::Approx(centres[k]).epsilon(1e-9).scale(0));
        }
    }

    TEST_CASE("truth: colors of spectra, by quadrature") {
        // The observer and the spectrum as straight lines between what is known, in steps of 0.01
        // nm.
        auto line = [](const Spectrum& known, double nm) {
            for (size_t i = 1; i < known.size(); i++) {
                auto [a, low] = known[i - 1];
                auto [b, high] = known[i];
                if (nm >= a && nm <= b) return low + (high - low) * (nm - a) / (b - a);
            }
            return 0.0;
        };
        auto quadrature = [&](const Spectrum& spectrum, const Spectrum& light) {
            std::array<Spectrum, 3> curves;
            for (size_t i = 0; i < observer.size(); i++) {
                for (size_t k = 0; k < 3; k++) {
                    curves[k].push_back({380 + 10 * static_cast<double>(i), observer[i][k]});
                }
            }
            std::array<double, 3> xyz = {};
            for (double nm = 380.005; nm < 780; nm += 0.01) {
                double value = line(spectrum, nm) * line(light, nm);
                for (size_t k = 0; k < 3; k++) xyz[k] += value * line(curves[k], nm);
            }
            return srgb_from_xyz(xyz[0], xyz[1], xyz[2]);
        };
        const Spectrum even = {{300, 1}, {900, 1}},
                       band = {{400, 0}, {455, 0.9}, {520.5, 0.2}, {690, 1}},
                       step = {{380, 0.1}, {580, 0.1}, {582, 0.8}, {780, 0.8}};
        std::array<double, 3> white = quadrature(even, standard_daylight());
        for (const Spectrum& spectrum : {even, band, step}) {
            auto [r, g, b] = quadrature(spectrum, even);
            Rgb seen = {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
            CHECK(apart(light_rgb(spectrum), seen / luminance(seen)) < 1e-3f);
            std::array<double, 3> rgb = quadrature(spectrum, standard_daylight());
            for (size_t k = 0; k < 3; k++) rgb[k] = std::min(1.0, rgb[k] / white[k]);
            Rgb surface = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                           static_cast<float>(rgb[2])};
            CHECK(apart(reflectance_rgb(spectrum), surface) < 1e-3f);
        }
    }

    TEST_CASE("input: spectra of lights and of diffuse surfaces") {
        Light light =
            read_world("LightSource 'point' 'spectrum I' [300 2 900 2] 'float scale' 3").lights[1];
        CHECK(std::abs(luminance(light.L) - 3) < 1e-5f);
        CHECK(looks("'diffuse' 'spectrum reflectance' [300 .25 900 .25]") == "0.25 0.25 0.25");
    }
}

TEST_SUITE("reader: scenes made by others") {
    TEST_CASE("input: scenes as other programs write them load unchanged") {
        std::vector<std::string> notes;
        Scene box = load_scene("tests/pictures/real-scenes/cornell-box/scene-v4.pbrt", &notes);
        CHECK(box.geometry.triangles.size() == 36);
        CHECK(box.geometry.normals.size() == box.geometry.positions.size());
        CHECK(box.max_depth == 4);
        CHECK(notes.size() == 2);
        REQUIRE(box.lights.size() == 1);
        CHECK(box.lights[0].L == Rgb{17, 12, 4});
        CHECK(box.lights[0].prims == 2);
        // The lamp's normals point down into the room.
        const Triangle& lamp = box.geometry.triangles[box.lights[0].first_prim];
        Vec3 p0 = box.geometry.positions[lamp.v[0]];
        CHECK(cross(box.geometry.positions[lamp.v[1]] - p0, box.geometry.positions[lamp.v[2]] - p0)
                  .y < 0);
    }

    TEST_CASE("files: an included file continues where its Include stands") {
        Scene scene = load_scene("tests/support/includes/main.pbrt", nullptr);
        REQUIRE(scene.geometry.spheres.size() == 3);
        CHECK(scene.geometry.spheres[0].c == Vec3{1, 0, 0});  // from the included file
        CHECK(scene.geometry.spheres[1].c == Vec3{3, 0, 0});  // named beside the included file
        CHECK(scene.geometry.spheres[2].c == Vec3{3, 5, 0});  // its transform is still in force
        CHECK(scene.geometry.triangles.size() == 1);          // named beside the main file
        CHECK(scene.shapes[scene.geometry.spheres[2].shape].material == 1);
    }
}
