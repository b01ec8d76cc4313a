// Law: all methods bring the same light, class of path by class of path.
#include <cstdio>

#include "common/render/render.h"
#include "common/scene/prepare.h"
#include "common/scene/sky_image.h"
#include "tests/known/scenes.h"
#include "tests/laws/laws.h"
#include "tests/support/light_paths.h"

namespace {

/// An image of the sky, brighter to one side, with a sun.
SkyImage sunny_sky() {
    SkyImage sky;
    sky.map = SkyImage::Map::wide, sky.width = 32, sky.height = 16;
    sky.x = {1, 0, 0}, sky.y = {0, 0, -1}, sky.z = {0, 1, 0};
    for (size_t i = 0; i < 32 * 16; i++) {
        Vec3 d = direction_of(sky, sky.middle_of(i));
        float L = 0.3f + 0.2f * d.x;
        sky.pixels.push_back({L, L, 1.5f * L});
    }
    sky.pixels[sky.pixel_at(point_of(sky, normalize({-0.5f, 0.8f, -0.4f})))] = {40, 36, 30};
    return sky;
}
const std::string floor_and_balls =
    "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [.6 .5 .4] Translate 0 -1 0 Scale 4 1 "
    "4 " +
    square(0, true) +
    "AttributeEnd AttributeBegin Material \"dielectric\" Translate -0.5 -0.3 0 Shape \"sphere\" "
    "\"float radius\" 0.5 AttributeEnd AttributeBegin Material \"conductor\" \"float roughness\" "
    "0.3 Translate 0.6 -0.5 0 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd ";
const std::string small_lamp =
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [8 6 4] Material "
    "\"diffuse\" \"rgb reflectance\" [0 0 0] Translate 1 1.5 0 Scale .3 1 .3 " +
    square(0, false) + "AttributeEnd ";

/// Glass and metal on a floor under this image, with a lamp or without any other light.
Scene under(const SkyImage& sky, bool with_lamp, int size = 32) {
    Scene scene =
        world_of(floor_and_balls + (with_lamp ? small_lamp : "LightSource \"infinite\""), size);
    if (!with_lamp) scene.lights.clear(), scene.sky = {}, scene.sky_light = -1;
    scene.sky_image = std::make_shared<SkyImage>(sky);
    scene.camera.o = {0, 0.5f, -4};
    scene.max_depth = 5;
    return scene;
}

/// A round mesh with the normals of a ball, of 10 x 6 rectangles: they lean far from the surface.
std::string smooth_ball(Vec3 centre, float r) {
    std::string P, N, indices;
    auto add = [](std::string& text, Vec3 p) {
        for (float x : {p.x, p.y, p.z}) text += std::to_string(x) + " ";
    };
    for (int j = 0; j <= 6; j++)
        for (int i = 0; i <= 10; i++) {
            Vec3 n = from_cylindrical(std::sin(pi * static_cast<float>(j) / 6),
                                      static_cast<float>(i % 10) / 10,
                                      std::cos(pi * static_cast<float>(j) / 6));
            add(P, centre + r * n), add(N, n);
            if (i == 10 || j == 6) continue;
            int a = 11 * j + i;
            for (int k : {a, a + 11, a + 12, a, a + 12, a + 1}) indices += std::to_string(k) + " ";
        }
    return "Shape \"trianglemesh\" \"integer indices\" [" + indices + "] \"point3 P\" [" + P +
           "] \"normal N\" [" + N + "]\n";
}

/// Glass and metal under a lamp, out of focus.
Scene through_a_lens() {
    Scene scene = world_of(floor_and_balls + small_lamp + "LightSource \"infinite\"");
    scene.camera.o = {0, 0.5f, -4};
    scene.camera.lens_radius = 0.3f, scene.camera.focal_distance = 3;
    scene.max_depth = 5;
    return scene;
}
/// A mirror and glass fill the picture: light from mirrors is seen in mirrors.
Scene behind_mirrors() {
    Scene scene = world_of(
        floor_and_balls + small_lamp +
        "AttributeBegin Material \"conductor\" \"rgb reflectance\" [1 1 1] Translate -.7 .1 -2 "
        "Shape \"sphere\" \"float radius\" 0.5 AttributeEnd AttributeBegin Material "
        "\"dielectric\" Translate .6 .1 -2 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd");
    scene.max_depth = 6;
    return scene;
}
/// Scenes in which all that a scene may hold is near to each other.
std::vector<std::pair<std::string, Scene>> scenes_of_all_kinds() {
    std::vector<std::pair<std::string, Scene>> scenes;
    for (uint32_t number : {0u, 18u})
        scenes.emplace_back("random " + std::to_string(number), random_scene(number));
    scenes.emplace_back("textures", load_scene("scenes/globe.pbrt", nullptr));
    Scene& globe = scenes.back().second;
    prepare(globe, 1);
    globe.width = globe.height = 32, globe.max_depth = 4;
    scenes.emplace_back("sky image", under(sunny_sky(), false));
    scenes.emplace_back("sky image and lamp", under(sunny_sky(), true));
    scenes.emplace_back("lens", through_a_lens());
    scenes.emplace_back("bokeh", scene_from("scenes/bokeh.pbrt", 32, 4));
    scenes.emplace_back("moving ball", scene_from("scenes/moving-ball.pbrt", 32, 4));
    scenes.emplace_back("mirrors and glass fill the picture", behind_mirrors());
    return scenes;
}

}  // namespace

TEST_SUITE("law: agreement") {
    TEST_CASE("agreement: all methods, by length and class of path") {
        for (const auto& [name, scene] : scenes_of_all_kinds()) {
            CAPTURE(name);
            CHECK(check_classes_agree(scene, 8192) > 40);
        }
    }

    TEST_CASE("identity: by the weights alone, chapter 22 brings what chapter 21 brings") {
        std::vector<Scene> scenes = {through_a_lens(), under(sunny_sky(), true)};
        for (auto [name, how] : {std::pair{"cornell", ""},
                                 {"cornell-spheres", ""},
                                 {"light-in-glass", ""},
                                 {"horizon-sky", ""},
                                 {"far-and-near", ""},
                                 {"veach-mis", ""},
                                 {"cornell", "metal"},
                                 {"two-lights", "two-sided"},
                                 {"cornell", "leaning normals"}}) {
            scenes.push_back(scene_from("scenes/" + std::string(name) + ".pbrt", 32, 8));
            change(scenes.back(), how);
        }
        for (const Scene& scene : scenes) {
            CAPTURE(scene.origin->file);
            Measured a = brightness(scene, methods_named({"21"})[0], 4096);
            Measured b = brightness(scene, methods_named({"22-weights"})[0], 4096);
            CHECK(a.mean == doctest::Approx(b.mean).epsilon(1e-4).scale(0));
            CHECK(a.mean > 0);
        }
    }

    TEST_CASE("identity: turned, mirrored and scaled scenes have the same light") {
        // As before chapter 09, without point lights, whose light falls with the square of the
        // scale.
        for (uint32_t number : {16u, 30u}) {
            CAPTURE(number);
            std::string text = random_world(8, number);
            std::vector<Scene> moved;
            for (auto [there, back] : {std::pair{"Rotate 50 1 2 3 ", "Rotate -50 1 2 3 "},
                                       {"Scale -1 1 1 ", "Scale -1 1 1 "},
                                       {"Translate 3 -20 7 ", "Translate -3 20 -7 "},
                                       {"Scale .001 .001 .001 ", "Scale 1000 1000 1000 "}}) {
                std::string other = text;
                other.insert(other.find("\n", other.find("WorldBegin")) + 1, there);
                moved.push_back(scene_of(other.insert(other.find("Camera"), back)));
            }
            check_same_light(scene_of(text), moved, 8192);
        }
    }

    TEST_CASE("identity: a sky beside an image of the sky is the image of their sum") {
        SkyImage image = sunny_sky(), sum = image;
        for (Rgb& L : sum.pixels) L += Rgb{1, 2, 3};
        Scene a = under(sum, false),
              b = world_of(floor_and_balls + "LightSource \"infinite\" \"rgb L\" [1 2 3]");
        b.sky_image = std::make_shared<SkyImage>(image), b.camera = a.camera,
        b.max_depth = a.max_depth;
        prepare(b, 1);
        CHECK(is_black(b.sky));
        check_same_light(a, {b}, 8192);
    }
}

TEST_SUITE("law: agreement slow") {
    TEST_CASE("agreement: smoothed normals") {
        // Paths from lights against paths from the eye, over paint: few and large triangles, so
        // that normals lean far. At rest, and while the ball turns and is stretched.
        std::string sun =
            "LightSource \"distant\" \"point3 from\" [3 2 -1] \"point3 to\" [0 0 0]\n";
        std::string ball = "Material \"diffuse\" \"rgb reflectance\" [.7 .7 .7]\n" +
                           smooth_ball({0.4f, 0, 0}, 0.9f);
        std::string leans = "[.5646 .8253 0 .5646 .8253 0 .5646 .8253 0 .5646 .8253 0]";
        for (std::string light :
             {sun, std::string("LightSource \"point\" \"point3 from\" [2 1 -3]\n"),
              std::string("LightSource \"infinite\"\n"),
              sun + "ActiveTransform EndTime Rotate 100 1 0 1 Scale 1.2 0.6 1 ActiveTransform "
                    "All\n"}) {
            CAPTURE(light);
            Scene scene = world_of(
                "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
                "[-9 -1 -9  -9 -1 9  9 -1 9  9 -1 -9] \"normal N\" " +
                leans + "\n" + light + ball);
            scene.max_depth = 3;
            CHECK(check_classes_agree(scene, 400000) > 9);
        }
    }

    TEST_CASE("agreement: photons under an image of the sky, and behind a lens") {
        CHECK(check_classes_agree(under(sunny_sky(), true), 200000, 1, true) > 60);
        CHECK(check_classes_agree(scene_from("scenes/bokeh.pbrt", 32, 4), 200000, 1, true) > 20);
    }
}
