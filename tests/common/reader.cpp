// What the scene reader makes of each feature of the language.
#include "common/scene_file/reader.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "common/base/error.h"

namespace {

Scene parse(const std::string& text, std::vector<std::string>* notes = nullptr) {
    return parse_scene("scene.pbrt", text, notes);
}

// A scene of which only the world matters.
Scene parse_world(const std::string& text) {
    return parse("Camera \"perspective\" WorldBegin LightSource \"infinite\" Shape \"disk\" " +
                 text);
}

// A scene of which only the lines before the world matter.
Scene parse_options(const std::string& text) {
    return parse(text +
                 " Camera \"perspective\" WorldBegin LightSource \"infinite\" Shape \"disk\"");
}

bool near(float a, double b) { return std::abs(a - b) <= 1e-6 * std::max(1.0, std::abs(b)); }
bool near(Vec3 a, Vec3 b) { return near(a.x, b.x) && near(a.y, b.y) && near(a.z, b.z); }

// Where the directives take the point (1,2,3): that of a light that stands there.
Vec3 moved(const std::string& directives) {
    return parse_world(directives + " LightSource \"point\" \"point3 from\" [1 2 3]")
        .lights.back()
        .p;
}

const std::string triangle = " Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ";

// The normal of the last triangle, from the order of its corners.
Vec3 normal_of(const std::string& directives) {
    Scene scene = parse_world(directives);
    const Geometry& g = scene.geometry;
    const uint32_t* v = g.triangles.back().v;
    return normalize(
        cross(g.positions[v[1]] - g.positions[v[0]], g.positions[v[2]] - g.positions[v[0]]));
}

// Two scenes that the reader must not tell apart, but for where things stand in the file.
void check_same(const Scene& a, const Scene& b) {
    CHECK(a.width == b.width);
    CHECK(a.height == b.height);
    CHECK(a.spp == b.spp);
    CHECK(a.max_depth == b.max_depth);
    CHECK(a.camera.fov == b.camera.fov);
    CHECK(a.camera.o == b.camera.o);
    CHECK(a.camera.forward == b.camera.forward);
    CHECK(a.geometry.positions == b.geometry.positions);
    CHECK(a.geometry.normals == b.geometry.normals);
    CHECK(a.geometry.triangles.size() == b.geometry.triangles.size());
    CHECK(a.materials.size() == b.materials.size());
    CHECK(a.materials.back().reflectance == b.materials.back().reflectance);
    CHECK(a.lights.size() == b.lights.size());
    CHECK(a.lights.back().L == b.lights.back().L);
}

}  // namespace

TEST_SUITE("reader: language") {
    TEST_CASE("input: what is not given has pbrt's defaults") {
        std::vector<std::string> notes;
        Scene scene = parse(
            "Camera \"perspective\" WorldBegin LightSource \"point\" Shape \"sphere\"", &notes);
        CHECK(scene.file == "scene.pbrt");
        CHECK(scene.width == 1280);
        CHECK(scene.height == 720);
        CHECK(scene.spp == 16);
        CHECK(scene.max_depth == 5);
        CHECK(scene.camera.fov == 90);
        CHECK(!scene.camera.frame_aspect);
        CHECK(!scene.camera.screen_window);
        CHECK(scene.camera.o == Vec3{0, 0, 0});
        CHECK(scene.camera.right == Vec3{1, 0, 0});
        CHECK(scene.camera.up == Vec3{0, 1, 0});
        CHECK(scene.camera.forward == Vec3{0, 0, 1});
        REQUIRE(scene.materials.size() == 1);
        CHECK(scene.materials[0].type == MaterialType::diffuse);
        CHECK(scene.materials[0].reflectance == Rgb{0.5f, 0.5f, 0.5f});
        REQUIRE(scene.lights.size() == 1);
        CHECK(scene.lights[0].L == Rgb{1, 1, 1});
        REQUIRE(scene.geometry.spheres.size() == 1);
        CHECK(scene.geometry.spheres[0].r == 1);
        CHECK(scene.geometry.normals.empty());
        CHECK(notes == std::vector<std::string>{
                           "scene.pbrt: note: no PixelFilter: pbrt's \"gaussian\" is replaced by "
                           "the box"});
    }

    TEST_CASE("input: comments, line ends, brackets and blanks do not matter") {
        const std::string plain =
            "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 32\n"
            "Sampler \"independent\" \"integer pixelsamples\" 7\n"
            "Integrator \"path\" \"integer maxdepth\" 9\n"
            "LookAt 0 0 -4 0 0 0 0 1 0\n"
            "Camera \"perspective\" \"float fov\" 40\n"
            "WorldBegin\n"
            "LightSource \"infinite\" \"rgb L\" [1 2 3]\n"
            "Material \"diffuse\" \"rgb reflectance\" [.25 .5 .75]\n"
            "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1 0 0 1 0 0 "
            "1]\n";
        const std::string odd =
            "\xef\xbb\xbf# a scene\r\n"
            "Film\t\"rgb\"\"integer   xresolution\"[64]# the width\r\n"
            "#\"integer xresolution\" 128\r"
            "\"integer yresolution\" # between\r\n [ # inside\r\n +32 ]\r\n"
            "Sampler \"independent\" \"integer pixelsamples\" [ 7 ]\r\n"
            "Integrator \"path\" \"integer maxdepth\" [\r\n9\r\n]\r\n"
            "LookAt +0e0 0 -4.E0 0 0 0 0 1.0 0\r"
            "Camera \"perspective\" \"float fov\" [.4e2] WorldBegin\r\n\r\n"
            "LightSource \"infinite\" \"rgb L\" [1 2000.e-3 30E-1]\r\n"
            "Material \"diffuse\" \"rgb\treflectance\" [ 25e-2 +.5 0.75 ]\r\n"
            "Shape \"trianglemesh\" \"normal N\" [ 0 -0 1 0 0 1 0 0 1 ]"
            "\"point3 P\"[0 0 0 1 0 0 0 1 0]#the end";
        check_same(parse(plain), parse(odd));
        CHECK(parse(plain).camera.o == Vec3{0, 0, -4});
    }

    TEST_CASE("input: what is given twice is noted") {
        std::vector<std::string> notes;
        parse(
            "PixelFilter \"box\" Camera \"perspective\" \"float fov\" 9 \"float fov\" 45\n"
            "  Camera \"perspective\" Option \"seed\" 1 Option \"seed\" 2\n"
            "WorldBegin LightSource \"point\" Shape \"sphere\" Shape \"sphere\"",
            &notes);
        CHECK(notes ==
              std::vector<std::string>{
                  "scene.pbrt:1:54: note: \"fov\" of Camera \"perspective\" is given twice: "
                  "the last one counts",
                  "scene.pbrt:2:3: note: a second Camera: the last one counts",
                  "scene.pbrt:2:31: note: Option \"seed\" is ignored"});
    }

    TEST_CASE("input: escapes in a name mean what they say") {
        Scene scene = parse_world(
            "MakeNamedMaterial \"a\\\"b\\\\c\" \"string type\" \"diffuse\" \"rgb reflectance\" [1 "
            "0 0] "
            "NamedMaterial \"a\\\"b\\\\c\" Shape \"sphere\"");
        uint32_t shape = scene.geometry.spheres[0].shape;
        CHECK(scene.materials[scene.shapes[shape].material].reflectance == Rgb{1, 0, 0});
    }

    TEST_CASE("input: samplers and integrators set the samples and the depth") {
        auto spp = [](const std::string& text) { return parse_options("Sampler " + text).spp; };
        CHECK(spp("\"independent\"") == 4);
        CHECK(spp("\"stratified\"") == 16);
        CHECK(spp("\"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5 \"bool jitter\" "
                  "false") == 15);
        CHECK(spp("\"pmj02bn\" \"integer pixelsamples\" 9") == 9);
        auto depth = [](const std::string& text) {
            return parse_options("Integrator " + text).max_depth;
        };
        CHECK(depth("\"path\"") == 5);
        CHECK(depth("\"path\" \"integer maxdepth\" 0 \"string lightsampler\" \"bvh\"") == 0);
        CHECK(depth("\"bdpt\" \"integer maxdepth\" 64 \"bool visualizeweights\" true") == 64);
    }

    TEST_CASE("input: what is replaced or ignored is noted with its place") {
        std::vector<std::string> notes;
        parse(
            "PixelFilter \"gaussian\" \"float sigma\" 1\nSampler \"halton\"\n"
            "Integrator \"bdpt\"\n  Accelerator \"kdtree\" ColorSpace \"rec2020\"\n"
            "Option \"Disable-Pixel_Jitter\" true\n"
            "Film \"rgb\" \"float maxcomponentvalue\" 10 \"bool savefp16\" false\n"
            "Camera \"perspective\" WorldBegin LightSource \"point\" Shape \"sphere\"\n"
            "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 2 0 0]",
            &notes);
        const char* begins[] = {"1:1: note: PixelFilter \"gaussian\" is replaced",
                                "2:1: note: Sampler \"halton\" only",
                                "3:1: note: Integrator \"bdpt\" only",
                                "4:3: note: Accelerator \"kdtree\" is ignored",
                                "4:24: note: ColorSpace \"rec2020\" is read",
                                "5:8: note: Option \"Disable-Pixel_Jitter\"",
                                "6:1: note: Film \"rgb\" maxcomponentvalue is ignored",
                                "8:1: note: left out triangles without area: 1, which is all"};
        REQUIRE(notes.size() == std::size(begins));
        for (size_t i = 0; i < notes.size(); i++)
            CHECK(notes[i].starts_with(std::string("scene.pbrt:") + begins[i]));
    }
}

TEST_SUITE("reader: transforms and camera") {
    TEST_CASE("input: every transform directive does what pbrt's does") {
        CHECK(moved("") == Vec3{1, 2, 3});
        CHECK(moved("Translate 10 20 30") == Vec3{11, 22, 33});
        CHECK(moved("Scale 2 -3 4") == Vec3{2, -6, 12});
        CHECK(near(moved("Rotate 90 0 0 1"), {-2, 1, 3}));
        CHECK(near(moved("Rotate 90 0 0 7"), {-2, 1, 3}));
        CHECK(near(moved("Rotate 90 1 0 0"), {1, -3, 2}));
        CHECK(near(moved("Rotate 90 0 1 0"), {3, 2, -1}));
        CHECK(near(moved("Rotate -120 1 1 1"), {2, 3, 1}));
        // Columns of the matrix one after the other: the translation is in places 13 to 15.
        CHECK(moved("Transform [2 0 0 0  0 0 1 0  0 -1 0 0  10 20 30 1]") == Vec3{12, 17, 32});
        CHECK(moved("Translate 1 1 1 Transform [1 0 0 0 0 1 0 0 0 0 1 0 5 5 5 1]") ==
              Vec3{6, 7, 8});
        CHECK(moved("Translate 1 1 1 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 5 5 5 1]") ==
              Vec3{7, 8, 9});
        CHECK(moved("Translate 1 1 1 Identity") == Vec3{1, 2, 3});
    }

    TEST_CASE("input: AttributeEnd restores what AttributeBegin saved") {
        CHECK(moved("AttributeBegin Translate 9 9 9 AttributeEnd") == Vec3{1, 2, 3});
        CHECK(moved("TransformBegin Scale 9 9 9 TransformEnd") == Vec3{1, 2, 3});
        CHECK(
            moved("Translate 1 1 1 AttributeBegin Scale 9 9 9 AttributeBegin Identity AttributeEnd "
                  "AttributeEnd Translate 1 1 1") == Vec3{3, 4, 5});
        Scene scene = parse_world(
            "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [1 0 0] "
            "AreaLightSource \"diffuse\" ReverseOrientation Shape \"sphere\" AttributeEnd "
            "Shape \"sphere\"");
        const Shape& inside = scene.shapes[scene.geometry.spheres[0].shape];
        const Shape& outside = scene.shapes[scene.geometry.spheres[1].shape];
        CHECK(scene.materials[inside.material].reflectance == Rgb{1, 0, 0});
        CHECK(inside.light == 1);
        CHECK(inside.reverse);
        CHECK(outside.material == 0);
        CHECK(outside.light == -1);
        CHECK(!outside.reverse);
    }

    TEST_CASE("input: the camera takes the transform where it stands, left-handed") {
        Camera camera = parse_options("LookAt 1 2 3  1 2 -7  0 9 0").camera;
        CHECK(near(camera.o, {1, 2, 3}));
        CHECK(near(camera.forward, {0, 0, -1}));
        CHECK(near(camera.up, {0, 1, 0}));
        CHECK(near(camera.right, {-1, 0, 0}));
        // Looking along +z, world x is on the right.
        CHECK(near(parse_options("LookAt 0 0 0  0 0 1  0 1 0").camera.right, {1, 0, 0}));
        // Scale -1 1 1 in front mirrors the picture and nothing else.
        Camera mirrored = parse_options("Scale -1 1 1 LookAt 1 2 3  1 2 -7  0 9 0").camera;
        CHECK(near(mirrored.right, -camera.right));
        CHECK(near(mirrored.up, camera.up));
        CHECK(near(mirrored.forward, camera.forward));
        CHECK(near(mirrored.o, camera.o));
        Scene later = parse(
            "Camera \"perspective\" Translate 1 1 1 WorldBegin "
            "LightSource \"point\" Shape \"sphere\"");
        CHECK(later.camera.o == Vec3{0, 0, 0});
    }

    TEST_CASE("input: the camera's and the film's parameters") {
        Scene scene = parse(
            "Film \"rgb\" \"integer xresolution\" 320 \"integer yresolution\" 200 "
            "\"string filename\" \"a.exr\" \"float diagonal\" 35 "
            "\"string sensor\" \"cie1931\" "
            "Camera \"perspective\" \"float fov\" 19.5 \"float frameaspectratio\" 2 "
            "\"float screenwindow\" [-1 2 -3 4] \"float lensradius\" 0 "
            "\"float focaldistance\" 7 WorldBegin LightSource \"point\" "
            "Shape \"sphere\"");
        CHECK(scene.width == 320);
        CHECK(scene.height == 200);
        CHECK(scene.camera.fov == 19.5f);
        CHECK(scene.camera.frame_aspect == 2);
        CHECK(scene.camera.screen_window == std::array<float, 4>{-1, 2, -3, 4});
    }

    TEST_CASE(
        "input: the shutter and the film's speed scale the lights as they scale pbrt's film") {
        Scene scene = parse(
            "Film \"rgb\" \"float iso\" 400 Camera \"perspective\" \"float shutteropen\" "
            "1 \"float shutterclose\" 1.5 WorldBegin LightSource \"point\" "
            "Shape \"sphere\"");
        CHECK(scene.lights[0].L == Rgb{2, 2, 2});
    }

    TEST_CASE("input: a transform for both ends of the shutter is no motion") {
        CHECK(moved("ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime "
                    "Translate 1 0 0 ActiveTransform All Translate 1 0 0") == Vec3{3, 2, 3});
        CHECK_THROWS_AS(moved("ActiveTransform StartTime Translate 1 0 0"), InputError);
        CHECK(moved("AttributeBegin ActiveTransform EndTime AttributeEnd Translate 1 0 0") ==
              Vec3{2, 2, 3});
    }
}

TEST_SUITE("reader: shapes") {
    TEST_CASE("input: the order of a triangle's corners is the side that shines") {
        const Vec3 up = {0, 0, 1}, down = {0, 0, -1};
        const std::string with_normals = triangle + " \"normal N\" [0 0 -1 0 0 -1 0 0 -1] ";
        CHECK(normal_of(triangle) == up);
        CHECK(normal_of("ReverseOrientation" + triangle) == down);
        CHECK(normal_of("ReverseOrientation ReverseOrientation" + triangle) == up);
        // A transform that mirrors does not change the side: the normal is carried along.
        CHECK(normal_of("Scale -1 1 1" + triangle) == up);
        CHECK(normal_of("Scale 1 1 -1" + triangle) == down);
        // The vertices' normals decide, whatever the corners say.
        CHECK(normal_of(with_normals) == down);
        CHECK(normal_of("ReverseOrientation" + with_normals) == up);
        CHECK(normal_of("Scale -1 1 1" + with_normals) == down);
        CHECK(normal_of("Scale 1 1 -1" + with_normals) == up);
        // Normals that say nothing leave the decision to the corners.
        CHECK(normal_of(triangle + "\"normal N\" [0 0 0 0 0 0 0 0 0]") == up);
        CHECK(normal_of(triangle + "\"normal N\" [1 0 0 0 1 0 1 1 0]") == up);
        CHECK(normal_of("ReverseOrientation" + triangle + "\"normal N\" [1 0 0 0 1 0 1 1 0]") ==
              down);
    }

    TEST_CASE("input: vertex normals are carried as normals, and turned by ReverseOrientation") {
        const std::string slanted = triangle + " \"normal N\" [0 .6 .8 0 .6 .8 0 .6 .8] ";
        Scene scene = parse_world("Scale 1 2 1" + slanted);
        REQUIRE(scene.geometry.normals.size() == 3);
        CHECK(near(normalize(scene.geometry.normals[0]), normalize(Vec3{0, .3f, .8f})));
        scene = parse_world("Scale 10 10 10" + slanted);
        CHECK(near(scene.geometry.normals[0], {0, .6f, .8f}));
        scene = parse_world("ReverseOrientation" + slanted);
        CHECK(near(scene.geometry.normals[0], {0, -.6f, -.8f}));
        // Lengths are kept, by which pbrt weighs them, unless their squares would leave a float.
        scene = parse_world(triangle + "\"normal N\" [0 0 2  0 0 3e30  0 0 1e-30]");
        CHECK(scene.geometry.normals == std::vector<Vec3>{{0, 0, 2}, {0, 0, 1}, {0, 0, 1}});
        // Every position has a normal once one has; meshes without get zeros.
        scene = parse_world(triangle + slanted + triangle);
        REQUIRE(scene.geometry.positions.size() == 9);
        REQUIRE(scene.geometry.normals.size() == 9);
        CHECK(scene.geometry.normals[2] == Vec3{0, 0, 0});
        CHECK(near(scene.geometry.normals[5], {0, .6f, .8f}));
        CHECK(scene.geometry.normals[8] == Vec3{0, 0, 0});
    }

    TEST_CASE("input: meshes keep their triangles in order, in world space") {
        Scene scene =
            parse_world("Translate 10 0 0" + triangle +
                        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
                        "\"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"point2 uv\" [0 0 1 0 1 1 0 1] "
                        "\"vector3 S\" [1 0 0 1 0 0 1 0 0 1 0 0] \"integer faceIndices\" [7 8]");
        const Geometry& g = scene.geometry;
        REQUIRE(g.triangles.size() == 3);
        REQUIRE(g.positions.size() == 7);
        CHECK(g.positions[1] == Vec3{11, 0, 0});
        CHECK(g.triangles[2].v[0] == 3);
        CHECK(g.triangles[2].v[1] == 5);
        CHECK(g.triangles[2].v[2] == 6);
        CHECK(g.triangles[0].shape != g.triangles[1].shape);
        CHECK(g.triangles[1].shape == g.triangles[2].shape);
    }

    TEST_CASE("input: triangles without area are left out, also as lights") {
        Scene scene = parse_world(
            "AreaLightSource \"diffuse\" \"float power\" 1 Shape \"trianglemesh\" "
            "\"integer indices\" [0 0 1  0 1 2  0 1 3] \"point3 P\" [0 0 0 1 0 0 0 1 0 2 0 0] "
            "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 2 0 0]");
        CHECK(scene.geometry.triangles.size() == 1);
        CHECK(scene.lights.size() == 2);  // with the sky
    }

    TEST_CASE(
        "input: spheres take uniform scaling, and shine inwards only under ReverseOrientation") {
        Scene scene = parse_world(
            "Translate 1 2 3 Rotate 30 1 2 3 Scale -2 2 2 Shape \"sphere\" \"float radius\" 1.5 "
            "\"float zmin\" -1.5 \"float zmax\" 1.5 \"float phimax\" 360 "
            "ReverseOrientation Shape \"sphere\"");
        const Geometry& g = scene.geometry;
        REQUIRE(g.spheres.size() == 2);
        CHECK(near(g.spheres[0].c, {1, 2, 3}));
        CHECK(near(g.spheres[0].r, 3));
        CHECK(!scene.shapes[g.spheres[0].shape].reverse);
        CHECK(near(g.spheres[1].r, 2));
        CHECK(scene.shapes[g.spheres[1].shape].reverse);
    }

    TEST_CASE(
        "input: a sphere, disk or cylinder is whole where pbrt clamps its limits to the whole") {
        auto is_whole = [](const std::string& shape) {
            try {
                return parse_world("Shape " + shape).geometry.size() > 0;
            } catch (const InputError&) {
                return false;
            }
        };
        for (const char* limits :
             {"\"float zmin\" -2", "\"float zmax\" 7", "\"float zmin\" -9 \"float zmax\" 9",
              "\"float zmin\" 1 \"float zmax\" -1", "\"float zmin\" 3 \"float zmax\" -3",
              "\"float phimax\" 360.5"})
            CHECK(is_whole(std::string("\"sphere\" ") + limits));
        for (const char* limits :
             {"\"float zmin\" -.99", "\"float zmax\" .5", "\"float zmin\" 2", "\"float zmax\" -2",
              "\"float zmin\" .5 \"float zmax\" -1", "\"float zmin\" 3 \"float zmax\" 5",
              "\"float phimax\" 359", "\"float phimax\" 0", "\"float phimax\" -360"})
            CHECK(!is_whole(std::string("\"sphere\" ") + limits));
        CHECK(is_whole("\"disk\" \"float phimax\" 1e9"));
        CHECK(!is_whole("\"disk\" \"float innerradius\" -.5"));
        const std::string cylinder = "Shape \"cylinder\"";
        check_same(parse_world(cylinder), parse_world(cylinder + " \"float phimax\" 400"));
    }

    TEST_CASE("input: a disk faces its own z axis") {
        auto disk = [](const std::string& before) {
            return parse_world(before +
                               " Shape \"disk\" \"float radius\" 2 \"float height\" 3 "
                               "\"float innerradius\" 0 \"float phimax\" 360")
                .geometry.disks.back();
        };
        CHECK(disk("").c == Vec3{0, 0, 3});
        CHECK(disk("").n == Vec3{0, 0, 1});
        CHECK(disk("").r == 2);
        CHECK(disk("ReverseOrientation").n == Vec3{0, 0, -1});
        CHECK(disk("Scale -1 1 1").n == Vec3{0, 0, 1});
        CHECK(disk("Scale 1 1 -1").n == Vec3{0, 0, -1});
        CHECK(near(disk("Rotate 90 0 1 0").n, {1, 0, 0}));
        CHECK(near(disk("Rotate 90 0 1 0").c, {3, 0, 0}));
        // Only what lies in the disk's plane must be scaled alike.
        CHECK(near(disk("Scale 3 3 10").r, 6));
        CHECK(near(disk("Scale 3 3 10").c, {0, 0, 30}));
        CHECK(disk("ConcatTransform [1 0 0 0 0 1 0 0 5 0 1 0 0 0 0 1]").n == Vec3{0, 0, 1});
    }
}

TEST_SUITE("reader: shortcuts of scene files") {
    const std::string start = "Camera \"perspective\" WorldBegin LightSource \"infinite\" ";
    auto read = [](const std::string& text, std::vector<std::string>* notes = nullptr) {
        return parse_scene("scene.pbrt", start + text, notes);
    };

    TEST_CASE("input: Attribute gives parameters to what comes after it, up to AttributeEnd") {
        Scene scene = read(
            "AttributeBegin Attribute \"shape\" \"float radius\" 2 \"float height\" 3 "
            "Attribute \"material\" \"rgb reflectance\" [1 0 0] Material \"diffuse\" "
            "Shape \"sphere\" Shape \"sphere\" \"float radius\" 4 Shape \"disk\" "
            "AttributeEnd Shape \"sphere\"");
        REQUIRE(scene.geometry.spheres.size() == 3);
        CHECK(scene.geometry.spheres[0].r == 2);
        CHECK(scene.geometry.spheres[1].r == 4);
        CHECK(scene.geometry.spheres[2].r == 1);
        CHECK(scene.geometry.disks[0].c == Vec3{0, 0, 3});
        CHECK(scene.materials[scene.shapes[0].material].reflectance == Rgb{1, 0, 0});
    }

    TEST_CASE("input: coordinate systems by name, those of the camera and the world too") {
        Scene scene = parse_scene("scene.pbrt",
                                  "Translate 0 0 5 Camera \"perspective\" WorldBegin "
                                  "LightSource \"infinite\" Translate 1 2 3 "
                                  "CoordinateSystem \"here\" CoordSysTransform \"camera\" "
                                  "Shape \"sphere\" CoordSysTransform \"world\" Shape \"sphere\" "
                                  "CoordSysTransform \"here\" Shape \"sphere\"",
                                  nullptr);
        CHECK(scene.geometry.spheres[0].c == Vec3{0, 0, -5});
        CHECK(scene.geometry.spheres[1].c == Vec3{0, 0, 0});
        CHECK(scene.geometry.spheres[2].c == Vec3{1, 2, 3});
    }

    TEST_CASE("input: an object is copied to each of its instances, within the limits") {
        const std::string object =
            "Material \"diffuse\" \"rgb reflectance\" [1 0 0] ObjectBegin \"two\" Translate 1 0 0 "
            "Shape \"sphere\" AreaLightSource \"diffuse\" Scale 2 2 2 Shape \"disk\" ObjectEnd "
            "Material \"diffuse\" ";
        const std::string twice =
            "ObjectInstance \"two\" Rotate 90 0 0 1 Scale 3 3 3 ObjectInstance \"two\" ";
        std::vector<std::string> notes;
        Scene scene = read(object + twice, &notes);
        REQUIRE(scene.geometry.spheres.size() == 2);
        REQUIRE(scene.geometry.disks.size() == 2);
        CHECK(scene.geometry.spheres[0].c == Vec3{1, 0, 0});
        CHECK(length(scene.geometry.spheres[1].c - Vec3{0, 3, 0}) < 1e-6f);
        CHECK(scene.geometry.spheres[1].r == doctest::Approx(3).scale(0));
        CHECK(scene.geometry.disks[1].r == doctest::Approx(6).scale(0));
        CHECK(scene.materials[scene.shapes[3].material].reflectance == Rgb{1, 0, 0});
        CHECK(scene.lights.size() == 1);  // the sky
        CHECK(notes[0].ends_with("lights inside an object are left out, as in pbrt"));
        CHECK_THROWS_WITH(read(object), "scene.pbrt: error: no Shape");
        check_same(read(twice + "Identity " + object), scene);  // instances before the object
        Limits limits;
        limits.primitives = 3;
        CHECK_THROWS_WITH(parse_scene("scene.pbrt", start + object + twice, nullptr, {}, limits),
                          doctest::Contains("the scene has more than 3"));
    }

    TEST_CASE("input: patches and cylinders as triangles, which a note says") {
        std::vector<std::string> notes;
        Scene scene = read(
            "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0 0  0 1 0  2 1 0] "
            "Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 1 \"float zmax\" 4",
            &notes);
        const Geometry& g = scene.geometry;
        REQUIRE(g.triangles.size() == 2 + 256);
        double area = 0;
        for (size_t i = 0; i < g.triangles.size(); i++) {
            Vec3 p0 = g.positions[g.triangles[i].v[0]];
            Vec3 n =
                cross(g.positions[g.triangles[i].v[1]] - p0, g.positions[g.triangles[i].v[2]] - p0);
            if (i < 2) {
                CHECK(n == Vec3{0, 0, 2});
                continue;
            }
            CHECK(dot(n, {p0.x, p0.y, 0}) > 0);
            CHECK(std::abs(std::hypot(p0.x, p0.y) - 2) < 1e-5f);
            area += double{length(n)} / 2;
        }
        CHECK(area == doctest::Approx(2 * std::numbers::pi * 2 * 3).scale(0).epsilon(2e-4));
        CHECK(notes[0].ends_with("a bilinear patch is read as two triangles"));
        CHECK(notes[1].ends_with("a cylinder is read as 256 triangles"));
    }
}
