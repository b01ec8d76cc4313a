// What the scene reader makes of each feature of the language.
#include "common/scene_file/reader.h"

#include <doctest/doctest.h>

#include "common/base/error.h"
#include "tests/support/described.h"

namespace {

/// Reads what stands before the world, with ' for ".
Scene read_options(const std::string& text, std::vector<std::string>* notes = nullptr) {
    return parse_scene("scene.pbrt",
                       unquoted(text + " WorldBegin LightSource 'point' Shape 'sphere'"), notes);
}
const std::string camera = " Camera 'perspective' ";

/// The line that begins with `word`, last of those that describe the world.
std::string last_line(const Scene& scene, const std::string& word) {
    std::string text = "\n" + in_words(scene);
    size_t at = text.rfind("\n" + word) + 1;
    return text.substr(at, text.find('\n', at) - at);
}

const std::string triangle = "Shape 'trianglemesh' 'point3 P' [0 0 0 1 0 0 0 1 0]";

/// The normal of the last triangle, from the order of its corners.
Vec3 last_normal(const std::string& world) {
    Scene scene = read_world(world);
    return normalize(normal_of(scene.geometry, scene.geometry.triangles.back()));
}

}  // namespace

TEST_SUITE("reader: language") {
    TEST_CASE("input: what is not given has pbrt's defaults") {
        std::vector<std::string> notes;
        Scene scene = read_options(camera, &notes);
        CHECK(scene.file == "scene.pbrt");
        CHECK(settings_of(scene) == "1280x720 16 5 90");
        CHECK(!scene.camera.frame_aspect);
        CHECK(!scene.camera.screen_window);
        CHECK(scene.camera.o == Vec3{0, 0, 0});
        CHECK(scene.camera.right == Vec3{1, 0, 0});
        CHECK(scene.camera.up == Vec3{0, 1, 0});
        CHECK(scene.camera.forward == Vec3{0, 0, 1});
        CHECK(in_words(scene) == "sphere 0 0 0, 1 0.5 0.5 0.5\npoint 1 1 1, 0 0 0\n");
        REQUIRE(notes.size() == 1);
        CHECK(notes[0].starts_with("scene.pbrt: note: no PixelFilter"));
    }

    TEST_CASE("input: comments, line ends, brackets and blanks do not matter") {
        auto read = [](const std::string& text) {
            Scene s = parse_scene("scene.pbrt", text, nullptr);
            return settings_of(s) + '\n' + in_words(s.camera.o) + '\n' + in_words(s);
        };
        const std::string plain = unquoted(
            "Film 'rgb' 'integer xresolution' 64 'integer yresolution' 32\n"
            "Sampler 'independent' 'integer pixelsamples' 7\n"
            "Integrator 'path' 'integer maxdepth' 9\n"
            "LookAt 0 0 -4 0 0 0 0 1 0\nCamera 'perspective' 'float fov' 40\n"
            "WorldBegin\nLightSource 'infinite' 'rgb L' [1 2 3]\n"
            "Material 'diffuse' 'rgb reflectance' [.25 .5 .75]\n"
            "Shape 'trianglemesh' 'point3 P' [0 0 0 1 0 0 0 1 0] 'normal N' [0 0 1 0 0 1 0 0 1]\n");
        const std::string odd = unquoted(
            "\xef\xbb\xbf# a scene\r\n"
            "Film\t'rgb''integer   xresolution'[64]# the width\r\n"
            "#'integer xresolution' 128\r"
            "'integer yresolution' # between\r\n [ # inside\r\n +32 ]\r\n"
            "Sampler 'independent' 'integer pixelsamples' [ 7 ]\r\n"
            "Integrator 'path' 'integer maxdepth' [\r\n9\r\n]\r\n"
            "LookAt +0e0 0 -4.E0 0 0 0 0 1.0 0\r"
            "Camera 'perspective' 'float fov' [.4e2] WorldBegin\r\n\r\n"
            "LightSource 'infinite' 'rgb L' [1 2000.e-3 30E-1]\r\n"
            "Material 'diffuse' 'rgb\treflectance' [ 25e-2 +.5 0.75 ]\r\n"
            "Shape 'trianglemesh' 'normal N' [ 0 -0 1 0 0 1 0 0 1 ]"
            "'point3 P'[0 0 0 1 0 0 0 1 0]#the end");
        CHECK(read(plain) == read(odd));
        CHECK(read(plain) ==
              "64x32 7 9 40\n0 0 -4\n"
              "triangle 0 0 0 (0 0 1) 1 0 0 (0 0 1) 0 1 0 (0 0 1) 0.25 0.5 0.75\n"
              "infinite 1 2 3\n");
    }

    TEST_CASE("input: samplers and integrators set the samples and the depth") {
        auto spp = [](const std::string& text) {
            return read_options("Sampler " + text + camera).spp;
        };
        CHECK(spp("'independent'") == 4);
        CHECK(spp("'stratified'") == 16);
        CHECK(spp("'stratified' 'integer xsamples' 3 'integer ysamples' 5 'bool jitter' false") ==
              15);
        CHECK(spp("'pmj02bn' 'integer pixelsamples' 9") == 9);
        auto depth = [](const std::string& text) {
            return read_options("Integrator " + text + camera).max_depth;
        };
        CHECK(depth("'path'") == 5);
        CHECK(depth("'path' 'integer maxdepth' 0 'string lightsampler' 'bvh'") == 0);
        CHECK(depth("'bdpt' 'integer maxdepth' 64 'bool visualizeweights' true") == 64);
    }

    TEST_CASE("input: what is replaced, ignored or given twice is noted with its place") {
        std::vector<std::string> notes;
        parse_scene(
            "s",
            unquoted("PixelFilter 'gaussian' 'float sigma' 1\nSampler 'halton'\n"
                     "Integrator 'bdpt'\n  Accelerator 'kdtree' ColorSpace 'rec2020'\n"
                     "Option 'Disable-Pixel_Jitter' true\n"
                     "Film 'rgb' 'float maxcomponentvalue' 10 'bool savefp16' false\n"
                     "Camera 'perspective' 'float fov' 9 'float fov' 45\n"
                     "  Camera 'perspective' WorldBegin LightSource 'point' Shape 'sphere'\n"
                     "Shape 'trianglemesh' 'point3 P' [0 0 0 1 0 0 2 0 0]"),
            &notes);
        std::string places;
        for (const std::string& note : notes) {
            size_t end = note.find(": note: ");
            REQUIRE(end != std::string::npos);
            places += note.substr(1, end - 1) + " ";
        }
        CHECK(places == ":1:1 :2:1 :3:1 :4:3 :4:24 :5:8 :6:1 :7:36 :8:3 :9:1 ");
    }
}

TEST_SUITE("reader: transforms and camera") {
    TEST_CASE("input: every transform directive does what pbrt's does") {
        const struct {
            std::string directives, place;  // of the point (1, 2, 3)
        } cases[] = {
            {"", "1 2 3"},
            {"Translate 10 20 30", "11 22 33"},
            {"Scale 2 -3 4", "2 -6 12"},
            {"Rotate 90 0 0 7", "-2 1 3"},
            {"Rotate 90 1 0 0", "1 -3 2"},
            {"Rotate 90 0 1 0", "3 2 -1"},
            {"Rotate -120 1 1 1", "2 3 1"},
            // Columns of the matrix one after the other: the translation is in places 13 to 15.
            {"Transform [2 0 0 0  0 0 1 0  0 -1 0 0  10 20 30 1]", "12 17 32"},
            {"Translate 1 1 1 Transform [1 0 0 0 0 1 0 0 0 0 1 0 5 5 5 1]", "6 7 8"},
            {"Translate 1 1 1 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 5 5 5 1]", "7 8 9"},
            {"Translate 1 1 1 Identity", "1 2 3"},
            {"AttributeBegin Translate 9 9 9 AttributeEnd", "1 2 3"},
            {"TransformBegin Scale 9 9 9 TransformEnd", "1 2 3"},
            {"Translate 1 1 1 AttributeBegin Scale 9 9 9 AttributeBegin Identity AttributeEnd "
             "AttributeEnd Translate 1 1 1",
             "3 4 5"},
            {"Translate 1 2 3 CoordinateSystem 'here' Identity CoordSysTransform 'here'", "2 4 6"},
            // For both ends of the shutter: no motion.
            {"ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 1 0 0 "
             "ActiveTransform All Translate 1 0 0",
             "3 2 3"},
            {"AttributeBegin ActiveTransform EndTime AttributeEnd Translate 1 0 0", "2 2 3"},
        };
        for (const auto& c : cases) {
            CAPTURE(c.directives);
            Scene scene = read_world(c.directives + " LightSource 'point' 'point3 from' [1 2 3]");
            CHECK(in_words(scene.lights.back().p) == c.place);
        }
        CHECK_THROWS_AS(read_world("ActiveTransform StartTime Translate 1 0 0 LightSource 'point'"),
                        InputError);
    }

    TEST_CASE("input: AttributeEnd restores what AttributeBegin saved") {
        Scene scene = read_world(
            "AttributeBegin Material 'diffuse' 'rgb reflectance' [1 0 0] AreaLightSource 'diffuse' "
            "ReverseOrientation Shape 'sphere' AttributeEnd Shape 'sphere'");
        CHECK(
            in_words(scene).starts_with("sphere 0 0 0, 1 1 0 0 reversed light 1\n"
                                        "sphere 0 0 0, 1 0.5 0.5 0.5\n"));
    }

    TEST_CASE("input: the camera takes the transform where it stands, left-handed") {
        auto axes = [](const std::string& before) {
            Camera c = read_options(before + camera + "Translate 1 1 1").camera;
            return in_words(c.right) + ", " + in_words(c.up) + ", " + in_words(c.forward) + ", " +
                   in_words(c.o);
        };
        CHECK(axes("LookAt 1 2 3  1 2 -7  0 9 0") == "-1 0 0, 0 1 0, 0 0 -1, 1 2 3");
        CHECK(axes("LookAt 0 0 0  0 0 1  0 1 0") == "1 0 0, 0 1 0, 0 0 1, 0 0 0");
        // Scale -1 1 1 in front mirrors the picture and nothing else.
        CHECK(axes("Scale -1 1 1 LookAt 1 2 3  1 2 -7  0 9 0") == "1 0 0, 0 1 0, 0 0 -1, 1 2 3");
        Scene moved =
            parse_scene("scene.pbrt",
                        unquoted("Translate 0 0 5 Camera 'perspective' WorldBegin "
                                 "LightSource 'infinite' CoordSysTransform 'camera' "
                                 "Shape 'sphere' CoordSysTransform 'world' Shape 'sphere'"),
                        nullptr);
        CHECK(moved.geometry.spheres[0].c == Vec3{0, 0, -5});
        CHECK(moved.geometry.spheres[1].c == Vec3{0, 0, 0});
    }

    TEST_CASE("input: the camera's and the film's parameters") {
        Scene scene = read_options(
            "Film 'rgb' 'integer xresolution' 320 'integer yresolution' 200 "
            "'string filename' 'a.exr' 'float diagonal' 35 'float iso' 400 "
            "Camera 'perspective' 'float fov' 19.5 'float frameaspectratio' 2 "
            "'float screenwindow' [-1 2 -3 4] 'float lensradius' .5 'float focaldistance' 7 "
            "'float shutteropen' 1 'float shutterclose' 1.5");
        const Camera& c = scene.camera;
        CHECK(settings_of(scene) == "320x200 16 5 19.5");
        CHECK(in_words({*c.frame_aspect, c.lens_radius, c.focal_distance}) == "2 0.5 7");
        CHECK(*c.screen_window == std::array<float, 4>{-1, 2, -3, 4});
        // The shutter and the film's speed scale the lights as they scale pbrt's film.
        CHECK(scene.lights[0].L == Rgb{2, 2, 2});
    }
}

TEST_SUITE("reader: shapes") {
    TEST_CASE("input: the order of a triangle's corners is the side that shines") {
        // A transform that mirrors does not change the side: the normal is carried along. The
        // vertices' normals decide, whatever the corners say, unless they say nothing.
        for (auto [normals, sign] : {std::pair("", 1.0f),
                                     {"'normal N' [0 0 -1 0 0 -1 0 0 -1]", -1},
                                     {"'normal N' [0 0 0 0 0 0 0 0 0]", 1},
                                     {"'normal N' [1 0 0 0 1 0 1 1 0]", 1}}) {
            const Vec3 up = Vec3{0, 0, 1} * sign;
            const std::string shape = " " + triangle + normals;
            CAPTURE(shape);
            CHECK(last_normal(shape) == up);
            CHECK(last_normal("ReverseOrientation" + shape) == -up);
            CHECK(last_normal("ReverseOrientation ReverseOrientation" + shape) == up);
            CHECK(last_normal("Scale -1 1 1" + shape) == up);
            CHECK(last_normal("Scale 1 1 -1" + shape) == -up);
        }
    }

    TEST_CASE("input: vertex normals are carried as normals, and turned by ReverseOrientation") {
        const std::string slanted = " " + triangle + " 'normal N' [0 .6 .8 0 .6 .8 0 .6 .8] ";
        auto normal = [&](const std::string& before) {
            return in_words(normalize(read_world(before + slanted).geometry.normals[0]));
        };
        CHECK(normal("Scale 1 2 1") == in_words(normalize(Vec3{0, .3f, .8f})));
        CHECK(normal("Scale 10 10 10") == "0 0.6 0.8");
        CHECK(normal("ReverseOrientation") == "0 -0.6 -0.8");
        // Lengths are kept, by which pbrt weighs them, unless their squares would leave a float.
        Scene scene = read_world(triangle + "'normal N' [0 0 2  0 0 3e30  0 0 1e-30]");
        CHECK(scene.geometry.normals == std::vector<Vec3>{{0, 0, 2}, {0, 0, 1}, {0, 0, 1}});
        // Every position has a normal once one has; meshes without get zeros.
        scene = read_world(triangle + slanted + triangle);
        REQUIRE(scene.geometry.normals.size() == 9);
        CHECK(scene.geometry.normals[2] == Vec3{0, 0, 0});
        CHECK(in_words(scene.geometry.normals[5]) == "0 0.6 0.8");
        CHECK(scene.geometry.normals[8] == Vec3{0, 0, 0});
    }

    TEST_CASE("input: each shape in world space, and meshes with their triangles in order") {
        const std::string mesh =
            "Shape 'trianglemesh' 'integer indices' [0 1 2 0 2 3] 'point3 P' [0 0 0 1 0 0 1 1 0 0 "
            "1 "
            "0] 'point2 uv' [0 0 1 0 1 1 0 1] 'vector3 S' [1 0 0 1 0 0 1 0 0 1 0 0] "
            "'integer faceIndices' [7 8]";
        const std::string disk =
            " Shape 'disk' 'float radius' 2 'float height' 3 'float innerradius' 0 'float phimax' "
            "360";
        const struct {
            std::string world, kind, last;
        } cases[] = {
            {"Translate 10 0 0 " + mesh, "triangle", "triangle 10 0 0 11 1 0 10 1 0"},
            {"Translate 1 2 3 Rotate 30 1 2 3 Scale -2 2 2 Shape 'sphere' 'float radius' 1.5 "
             "'float zmin' -1.5 'float zmax' 1.5 'float phimax' 360",
             "sphere", "sphere 1 2 3, 3"},
            {disk, "disk", "disk 0 0 3, 0 0 1, 2"},
            {"ReverseOrientation" + disk, "disk", "disk 0 0 3, 0 0 -1, 2"},
            {"Scale -1 1 1" + disk, "disk", "disk 0 0 3, 0 0 1, 2"},
            {"Scale 1 1 -1" + disk, "disk", "disk 0 0 -3, 0 0 -1, 2"},
            {"Rotate 90 0 1 0" + disk, "disk", "disk 3 0 0, 1 0 0, 2"},
            // Only what lies in the disk's plane must be scaled alike.
            {"Scale 3 3 10" + disk, "disk", "disk 0 0 30, 0 0 1, 6"},
            {"ConcatTransform [1 0 0 0 0 1 0 0 5 0 1 0 0 0 0 1]" + disk, "disk",
             "disk 15 0 3, 0 0 1, 2"},
            {"Shape 'bilinearmesh' 'point3 P' [0 0 0 2 0 0 0 1 0 2 1 0]", "triangle",
             "triangle 0 0 0 2 1 0 0 1 0"},
        };
        for (const auto& c : cases) {
            CAPTURE(c.world);
            CHECK(last_line(read_world(c.world), c.kind) == c.last + " 0.5 0.5 0.5");
        }
    }

    TEST_CASE("input: triangles without area are left out, also as lights") {
        Scene scene = read_world(
            "AreaLightSource 'diffuse' 'float power' 1 Shape 'trianglemesh' "
            "'integer indices' [0 0 1  0 1 2  0 1 3] 'point3 P' [0 0 0 1 0 0 0 1 0 2 0 0] "
            "Shape 'trianglemesh' 'point3 P' [0 0 0 1 0 0 2 0 0]");
        CHECK(scene.geometry.triangles.size() == 1);
        CHECK(scene.lights.size() == 2);  // with the sky
    }

    TEST_CASE("input: a shape is whole where pbrt clamps its limits to the whole") {
        auto is_whole = [](const std::string& shape) {
            try {
                return read_world("Shape " + shape).geometry.size() > 1;
            } catch (const InputError&) {
                return false;
            }
        };
        for (const char* limits :
             {"'float zmin' -2", "'float zmax' 7", "'float zmin' 1 'float zmax' -1",
              "'float zmin' 3 'float zmax' -3", "'float phimax' 360.5"})
            CHECK(is_whole(std::string("'sphere' ") + limits));
        for (const char* limits :
             {"'float zmin' -.99", "'float zmax' .5", "'float zmin' 2", "'float zmax' -2",
              "'float zmin' .5 'float zmax' -1", "'float zmin' 3 'float zmax' 5",
              "'float phimax' 359", "'float phimax' 0", "'float phimax' -360"})
            CHECK(!is_whole(std::string("'sphere' ") + limits));
        CHECK(is_whole("'disk' 'float phimax' 1e9"));
        CHECK(!is_whole("'disk' 'float innerradius' -.5"));
        CHECK(is_whole("'cylinder' 'float phimax' 400"));
    }

    TEST_CASE("input: a cylinder is read as triangles, which a note says") {
        std::vector<std::string> notes;
        Scene scene =
            read_world("Shape 'cylinder' 'float radius' 2 'float zmin' 1 'float zmax' 4", &notes);
        const Geometry& g = scene.geometry;
        double area = 0;
        for (const Triangle& t : g.triangles) {
            Vec3 p = g.positions[t.v[0]], n = normal_of(g, t);
            CHECK(dot(n, {p.x, p.y, 0}) > 0);
            CHECK(std::abs(std::hypot(p.x, p.y) - 2) < 1e-5f);
            area += double{length(n)} / 2;
        }
        CHECK(area == doctest::Approx(2 * double{pi} * 2 * 3).scale(0).epsilon(2e-4));
        CHECK(notes[0].find(":2:1: note: ") != std::string::npos);
    }
}

TEST_SUITE("reader: shortcuts of scene files") {
    TEST_CASE("input: Attribute gives parameters to what comes after it, up to AttributeEnd") {
        Scene scene = read_world(
            "AttributeBegin Attribute 'shape' 'float radius' 2 'float height' 3 "
            "Attribute 'material' 'rgb reflectance' [1 0 0] Material 'diffuse' "
            "Shape 'sphere' Shape 'sphere' 'float radius' 4 Shape 'disk' "
            "AttributeEnd Shape 'sphere'");
        CHECK(in_words(scene) ==
              "sphere 0 0 0, 2 1 0 0\nsphere 0 0 0, 4 1 0 0\nsphere 0 0 0, 1 0.5 0.5 0.5\n"
              "disk 0 0 0, 0 0 1, 1 0.5 0.5 0.5\ndisk 0 0 3, 0 0 1, 2 1 0 0\ninfinite 1 1 1\n");
    }

    TEST_CASE("input: an object is copied to each of its instances, within the limits") {
        const std::string object =
            "Material 'diffuse' 'rgb reflectance' [1 0 0] ObjectBegin 'two' Translate 1 0 0 "
            "Shape 'sphere' AreaLightSource 'diffuse' Scale 2 2 2 Shape 'disk' ObjectEnd "
            "Material 'diffuse' ";
        const std::string twice =
            "ObjectInstance 'two' Rotate 90 0 0 1 Scale 3 3 3 ObjectInstance 'two' ";
        const std::string expected =
            "sphere 1 0 0, 1 1 0 0\nsphere 0 3 0, 3 1 0 0\ndisk 0 0 0, 0 0 1, 1 0.5 0.5 0.5\n"
            "disk 1 0 0, 0 0 1, 2 1 0 0\ndisk 0 3 0, 0 0 1, 6 1 0 0\ninfinite 1 1 1\n";
        std::vector<std::string> notes;
        CHECK(in_words(read_world(object + twice, &notes)) == expected);
        CHECK(notes[0].ends_with("lights inside an object are left out, as in pbrt"));
        CHECK(read_world(object).geometry.size() == 1);
        CHECK(in_words(read_world(twice + "Identity " + object)) == expected);
        Limits limits;
        limits.primitives = 4;
        CHECK_THROWS_WITH(read_world(object + twice, nullptr, limits),
                          doctest::Contains("the scene has more than 4"));
    }
}
