// What the scene reader makes of materials, lights and files.
#include <doctest/doctest.h>

#include <numbers>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/material/observer.h"
#include "common/scene_file/reader.h"
#include "common/scene_file/spectra.h"

namespace {

Scene parse_world(const std::string& text) {
    return parse_scene("scene.pbrt", "Camera \"perspective\" WorldBegin " + text, nullptr);
}

// The light of a directive, beside a shape that does not shine.
Light light_of(const std::string& directive) {
    return parse_world("Shape \"sphere\" " + directive).lights.back();
}

// The material of a directive.
Material material_of(const std::string& directive) {
    return parse_world("LightSource \"point\" Shape \"sphere\" Material " + directive)
        .materials.back();
}

bool near(double a, double b) { return std::abs(a - b) <= 1e-5 * std::abs(b); }
bool near(Rgb a, Rgb b) { return near(a.r, b.r) && near(a.g, b.g) && near(a.b, b.b); }

// The power that a primitive of this area sends.
double power_of(const Light& light, double area) {
    return std::numbers::pi * area * light.L.r * (light.two_sided ? 2 : 1);
}

// The reflectance at normal incidence of an interface to a metal.
double reflectance_at_normal(double eta, double k) {
    return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

const std::string quad =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
    "\"point3 P\" [0 0 0 2 0 0 2 1 0 0 1 0] ";

}  // namespace

TEST_SUITE("reader: materials") {
    TEST_CASE("input: a conductor's reflectance becomes eta and k that reflect so much") {
        Material m = material_of("\"conductor\" \"rgb reflectance\" [0 .5 .9]");
        CHECK(m.type == MaterialType::conductor);
        CHECK(m.eta == Rgb{1, 1, 1});
        CHECK(m.k.r == 0);
        CHECK(near(reflectance_at_normal(1, m.k.g), .5));
        CHECK(near(reflectance_at_normal(1, m.k.b), .9));
        // A whole reflectance is taken for .9999, as in pbrt.
        CHECK(near(
            reflectance_at_normal(1, material_of("\"conductor\" \"rgb reflectance\" [1 1 1]").k.r),
            .9999));
    }

    TEST_CASE("input: metals by their eta and k, as colors or by name") {
        Material m = material_of("\"conductor\" \"rgb eta\" [.2 .9 1.1] \"rgb k\" [3.9 2.4 2.1]");
        CHECK(m.eta == Rgb{.2f, .9f, 1.1f});
        CHECK(m.k == Rgb{3.9f, 2.4f, 2.1f});
        Material gold = material_of(
            "\"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" [ \"metal-Au-k\" ]");
        CHECK(gold.eta == metal_ior("Au")->eta);
        CHECK(gold.k == metal_ior("Au")->k);
        CHECK(material_of("\"conductor\"").eta == metal_ior("Cu")->eta);
        CHECK(material_of("\"conductor\"").k == metal_ior("Cu")->k);
        CHECK(material_of("\"conductor\" \"rgb eta\" [1 2 3]").k == metal_ior("Cu")->k);
    }

    TEST_CASE("input: roughness is the square of alpha, unless it is alpha") {
        auto alpha = [](const std::string& text) {
            return material_of("\"conductor\" " + text).alpha;
        };
        CHECK(alpha("") == 0);
        CHECK(near(alpha("\"float roughness\" .25"), .5));
        CHECK(alpha("\"float roughness\" .25 \"bool remaproughness\" false") == .25f);
        CHECK(
            alpha(
                "\"float uroughness\" .1 \"float vroughness\" .1 \"bool remaproughness\" false") ==
            .1f);
        // Below an alpha of a thousandth a metal is smooth.
        CHECK(alpha("\"float roughness\" .0009 \"bool remaproughness\" false") == 0);
        CHECK(alpha("\"float roughness\" .001 \"bool remaproughness\" false") == .001f);
        CHECK(alpha("\"float roughness\" .9e-6") == 0);
    }

    TEST_CASE("input: dielectric") {
        CHECK(material_of("\"dielectric\"").type == MaterialType::dielectric);
        CHECK(material_of("\"dielectric\"").ior == 1.5f);
        CHECK(material_of("\"dielectric\" \"float eta\" 1.33 \"float roughness\" 0").ior == 1.33f);
        CHECK(material_of("\"dielectric\" \"float roughness\" .9e-6").ior == 1.5f);
    }

    TEST_CASE("input: named materials may be used before they are made") {
        Scene scene = parse_world(
            "LightSource \"point\" NamedMaterial \"red\" Shape \"sphere\" "
            "MakeNamedMaterial \"green\" \"rgb reflectance\" [0 1 0] \"string type\" \"diffuse\" "
            "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [1 0 0] "
            "Shape \"sphere\" NamedMaterial \"green\" Shape \"sphere\"");
        auto color = [&](size_t i) {
            return scene.materials[scene.shapes[scene.geometry.spheres[i].shape].material]
                .reflectance;
        };
        CHECK(color(0) == Rgb{1, 0, 0});
        CHECK(color(1) == Rgb{1, 0, 0});
        CHECK(color(2) == Rgb{0, 1, 0});
    }
}

TEST_SUITE("reader: lights") {
    TEST_CASE("input: each Shape of an area light is one light with its range of primitives") {
        Scene scene = parse_world(
            "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 2 \"bool twosided\" "
            "true\n"
            "Shape \"sphere\"\n Shape \"disk\"\n " +
            quad + "\n" + quad +
            "\nAttributeBegin AreaLightSource \"diffuse\" Shape \"sphere\" AttributeEnd Shape "
            "\"disk\"");
        REQUIRE(scene.geometry.size() == 8);  // 4 triangles, 2 spheres, 2 disks
        REQUIRE(scene.lights.size() == 6);
        struct Range {
            uint32_t first, count;
        };
        const Range expected[] = {{4, 1}, {6, 1}, {0, 2}, {2, 2}, {5, 1}, {7, 1}};
        for (size_t i = 0; i < 6; i++) {
            CHECK(scene.lights[i].type == LightType::area);
            CHECK(scene.lights[i].first_prim == expected[i].first);
            CHECK(scene.lights[i].prims == expected[i].count);
            CHECK(scene.lights[i].two_sided == (i != 4));
            CHECK(scene.lights[i].L == (i == 4 ? Rgb{1, 1, 1} : Rgb{2, 4, 6}));
        }
        CHECK(scene.lights[1].at->line == 3);
        CHECK(scene.lights[1].at->column == 2);
        for (uint32_t i = 0; i < 4; i++) {
            int light = scene.shapes[scene.geometry.triangles[i].shape].light;
            CHECK(light == (i < 2 ? 2 : 3));
        }
    }

    TEST_CASE("input: power is that of each primitive, and L multiplies it") {
        auto first = [](const std::string& light, const std::string& shape) {
            return parse_world("AreaLightSource \"diffuse\" \"float power\" 5 " + light + shape);
        };
        // The two triangles of a quad send 5 W each, as in pbrt.
        Scene scene = first("", quad);
        REQUIRE(scene.lights.size() == 2);
        for (uint32_t i = 0; i < 2; i++) {
            CHECK(near(power_of(scene.lights[i], 1), 5));
            CHECK(scene.lights[i].first_prim == i);
            CHECK(scene.lights[i].prims == 1);
            CHECK(scene.shapes[scene.geometry.triangles[i].shape].light == static_cast<int>(i));
        }
        CHECK(near(power_of(first("\"bool twosided\" true ", quad).lights[0], 1), 5));
        CHECK(near(power_of(first("\"rgb L\" [2 2 2] ", quad).lights[0], 1), 10));
        CHECK(near(power_of(first("\"float scale\" 3 ", quad).lights[0], 1), 15));
        double sphere_area = 4 * std::numbers::pi * 9, disk_area = std::numbers::pi * 9;
        CHECK(near(power_of(first("Scale 3 3 3 ", "Shape \"sphere\"").lights[0], sphere_area), 5));
        CHECK(near(power_of(first("Scale 3 3 3 ", "Shape \"disk\"").lights[0], disk_area), 5));
    }

    TEST_CASE("input: point lights") {
        Light light = light_of("LightSource \"point\"");
        CHECK(light.type == LightType::point);
        CHECK(light.L == Rgb{1, 1, 1});
        CHECK(light.p == Vec3{0, 0, 0});
        CHECK(light.at->line == 1);
        CHECK(light.at->column == 48);
        light = light_of(
            "Translate 1 1 1 LightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 2 "
            "\"point3 from\" [1 2 3]");
        CHECK(light.L == Rgb{2, 4, 6});
        CHECK(light.p == Vec3{2, 3, 4});
        // power is the power for I = 1, in all directions.
        light = light_of("LightSource \"point\" \"float power\" 100 \"rgb I\" [1 .5 2]");
        CHECK(near(light.L * (4 * pi), {100, 50, 200}));
    }

    TEST_CASE("input: a power or illuminance that is not above 0 has no effect, as in pbrt") {
        for (const char* none : {"0", "-0.0", "-1", "-1e30"}) {
            for (const auto& [type, total] : {std::pair("point", "power"),
                                              {"distant", "illuminance"},
                                              {"infinite", "illuminance"}}) {
                const std::string light =
                    std::string("LightSource \"") + type + "\" \"float scale\" 3";
                CHECK(light_of(light + " \"float " + total + "\" " + none).L == light_of(light).L);
            }
            const std::string lamp = "AreaLightSource \"diffuse\" \"float power\" ";
            CHECK(parse_world(lamp + none + ' ' + quad).lights[0].L == Rgb{1, 1, 1});
        }
    }

    TEST_CASE("input: distant lights") {
        Light light = light_of("LightSource \"distant\"");
        CHECK(light.type == LightType::distant);
        CHECK(light.L == Rgb{1, 1, 1});
        CHECK(light.p == Vec3{0, 0, -1});
        light = light_of(
            "Rotate 90 1 0 0 Scale 3 3 3 Translate 9 9 9 LightSource \"distant\" \"rgb L\" [1 2 3] "
            "\"float scale\" 2 \"float illuminance\" 10 \"point3 from\" [0 5 0] \"point3 to\" [0 3 "
            "0]");
        CHECK(near(light.L, {20, 40, 60}));
        CHECK(length(light.p - Vec3{0, 0, 1}) < 1e-6f);
    }

    TEST_CASE("input: infinite lights") {
        Light light = light_of("LightSource \"infinite\"");
        CHECK(light.type == LightType::infinite);
        CHECK(light.L == Rgb{1, 1, 1});
        light = light_of("LightSource \"infinite\" \"rgb L\" [1 2 3] \"float scale\" 2");
        CHECK(light.L == Rgb{2, 4, 6});
        // illuminance is the irradiance pi L of a surface under the sky of L = 1.
        light = light_of("LightSource \"infinite\" \"float illuminance\" 10 \"rgb L\" [1 1 2]");
        CHECK(near(light.L * pi, {10, 10, 20}));
        CHECK(parse_world("Shape \"sphere\" LightSource \"infinite\" LightSource \"infinite\"")
                  .lights.size() == 2);
    }

    TEST_CASE("input: what is black is no light") {
        Scene scene = parse_world(
            "LightSource \"infinite\" \"rgb L\" [0 0 0] LightSource \"point\" \"float scale\" 0 "
            "LightSource \"distant\" AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [0 0 0] "
            "Shape \"sphere\" AttributeEnd");
        CHECK(scene.lights.size() == 1);
        CHECK(scene.shapes[scene.geometry.spheres[0].shape].light == -1);
    }

    TEST_CASE("input: blackbody lights have the color of their temperature and luminance 1") {
        Light light = light_of("LightSource \"point\" \"blackbody I\" 2856 \"float scale\" 3");
        CHECK(near(light.L, 3 * blackbody_rgb(2856)));
        light = parse_world("AreaLightSource \"diffuse\" \"blackbody L\" [6500] Shape \"sphere\"")
                    .lights[0];
        CHECK(near(light.L, blackbody_rgb(6500)));
    }

    TEST_CASE("truth: black bodies have the chromaticities that the CIE gives") {
        auto xy = [](double kelvin, double& x, double& y) {
            Rgb c = blackbody_rgb(kelvin);
            double X = 0.4124 * c.r + 0.3576 * c.g + 0.1805 * c.b;
            double Y = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
            double Z = 0.0193 * c.r + 0.1192 * c.g + 0.9505 * c.b;
            x = X / (X + Y + Z);
            y = Y / (X + Y + Z);
            CHECK(std::abs(luminance(c) - 1) < 1e-5);
        };
        double x = 0, y = 0;
        xy(2855.542, x, y);  // illuminant A, with today's constant of Planck's law
        CHECK(std::abs(x - 0.44757) < 2e-4);
        CHECK(std::abs(y - 0.40745) < 2e-4);
        xy(6500, x, y);
        CHECK(std::abs(x - 0.3135) < 2e-4);
        CHECK(std::abs(y - 0.3237) < 2e-4);
    }
}

TEST_SUITE("reader: spectra") {
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
            std::array<double, 3> rgb = quadrature(spectrum, even);
            double luminance_here = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
            Rgb light = light_rgb(spectrum);
            CHECK(std::abs(double{light.r} - rgb[0] / luminance_here) < 1e-3);
            CHECK(std::abs(double{light.g} - rgb[1] / luminance_here) < 1e-3);
            CHECK(std::abs(double{light.b} - rgb[2] / luminance_here) < 1e-3);
            rgb = quadrature(spectrum, standard_daylight());
            Rgb r = reflectance_rgb(spectrum);
            CHECK(std::abs(double{r.r} - std::min(1.0, rgb[0] / white[0])) < 1e-3);
            CHECK(std::abs(double{r.g} - rgb[1] / white[1]) < 1e-3);
            CHECK(std::abs(double{r.b} - rgb[2] / white[2]) < 1e-3);
        }
        CHECK(near(reflectance_rgb({{300, 0.25}, {900, 0.25}}), {0.25f, 0.25f, 0.25f}));
    }

    TEST_CASE("truth: listed daylight and black bodies have the colors that the CIE gives") {
        // Lines between rows of 10 nm make the observer's curves lower at their tops.
        auto close = [](Rgb a, Rgb b) {
            CHECK(std::abs(a.r - b.r) < 3e-3f);
            CHECK(std::abs(a.g - b.g) < 3e-3f);
            CHECK(std::abs(a.b - b.b) < 3e-3f);
        };
        close(light_rgb(standard_daylight()), *illuminant_rgb("stdillum-D65"));
        close(*illuminant_rgb("stdillum-A"), blackbody_rgb(2855.6));
        Spectrum planck;
        for (double nm = 300; nm <= 900; nm += 10) {
            planck.push_back({nm, std::pow(nm / 560, -5) / std::expm1(1.438777e7 / (nm * 5000))});
        }
        close(light_rgb(planck), blackbody_rgb(5000));
    }

    TEST_CASE("input: spectra of lights, of diffuse surfaces and of metal") {
        Light light =
            light_of("LightSource \"point\" \"spectrum I\" [300 2 900 2] \"float scale\" 3");
        CHECK(std::abs(luminance(light.L) - 3) < 1e-5f);
        CHECK(near(light_of("LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"").L,
                   *illuminant_rgb("stdillum-D65")));
        CHECK(
            near(material_of("\"diffuse\" \"spectrum reflectance\" [300 .25 900 .25]").reflectance,
                 {0.25f, 0.25f, 0.25f}));
        Material metal = material_of(
            "\"conductor\" \"spectrum eta\" [300 .5 900 .5] "
            "\"spectrum k\" \"metal-Ag-k\"");
        CHECK(near(metal.eta, {0.5f, 0.5f, 0.5f}));
        CHECK(metal.k == metal_ior("Ag")->k);
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
