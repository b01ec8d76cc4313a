// Large scenes: how far reading is, and where it ends.
#include <doctest/doctest.h>

#include <sstream>

#include "common/base/files.h"
#include "common/base/percent.h"
#include "common/geometry/bvh_build.h"
#include "common/scene_file/reader.h"
#include "tests/support/folder.h"
#include "tests/support/run_program.h"

namespace {

const std::string world = "Camera \"perspective\" WorldBegin LightSource \"infinite\"\n";

std::string refuse(const std::string& text, const Limits& limits, const std::string& folder = "") {
    return error_of([&] { parse_scene(folder + "scene.pbrt", text, nullptr, {}, limits); });
}

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; i++) all += text;
    return all;
}

/// A square of two triangles, as text, and something to make the file larger.
std::string square_ply(size_t padding = 0) {
    return "ply\nformat ascii 1.0\ncomment " + std::string(padding, 'x') +
           "\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
}

struct Told {
    std::string what;
    double share;
};

}  // namespace

TEST_SUITE("reader: large scenes") {
    TEST_CASE("input: a scene ends at the limits, each with its place") {
        Limits limits;
        limits.primitives = 3;
        std::string sphere = "Shape \"sphere\"\n", disk = "Shape \"disk\"\n";
        CHECK(refuse(world + repeated(sphere, 3), limits) == "");
        CHECK(refuse(world + repeated(sphere, 2) + repeated(disk, 2), limits) ==
              "scene.pbrt:5:1: error: the scene has more than 3 triangles, spheres and disks");
        std::string triangles =
            "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] "
            "\"integer indices\" [0 1 2 0 2 3]\n";
        CHECK(refuse(world + triangles + sphere, limits) == "");
        CHECK(refuse(world + triangles + triangles, limits) ==
              "scene.pbrt:3:1: error: the scene has more than 3 triangles, spheres and disks");
        limits.vertices = 3;
        CHECK(refuse(world + triangles, limits) ==
              "scene.pbrt:2:1: error: the scene has more than 3 vertices");

        limits = {};
        limits.directives = 5;
        CHECK(refuse(world + "Identity Shape \"sphere\"", limits) == "");
        CHECK(refuse(world + "Identity Identity\nShape \"sphere\"", limits) ==
              "scene.pbrt:3:1: error: more than 5 directives");
        CHECK(refuse(world + repeated("AttributeBegin ", 1001), {}) ==
              "scene.pbrt:2:15001: error: AttributeBegin more than 1000 deep");
        std::string many = "Shape \"sphere\"";
        for (int i = 0; i <= 100; i++) many += " \"float x" + std::to_string(i) + "\" 1";
        CHECK(refuse(world + many, {})
                  .ends_with("error: Shape \"sphere\" has more than 100 parameters"));
    }

    TEST_CASE("files: all files together end at their limit, and a file read twice counts twice") {
        TemporaryFolder folder;
        write_file_atomically(folder / "part.pbrt", "Shape \"sphere\"" + std::string(986, ' '));
        std::string include = "Include \"part.pbrt\"\n";
        Limits limits;
        limits.file_bytes = 3000;
        CHECK(refuse(world + repeated(include, 3), limits, folder.path() + "/") == "");
        CHECK(refuse(world + repeated(include, 4), limits, folder.path() + "/") ==
              folder / "scene.pbrt" +
                  ":5:9: error: more than 3000 bytes are read, from all files together");
    }

    TEST_CASE("files: a mesh that is named a hundred times is read once") {
        TemporaryFolder folder;
        std::string ply = square_ply(5000);
        write_file_atomically(folder / "a.ply", ply);
        std::string shape = "Shape \"plymesh\" \"string filename\" \"a.ply\" Translate 0 0 1\n",
                    other = "Shape \"plymesh\" \"string filename\" \"./a.ply\"\n";
        Limits limits;
        limits.file_bytes = ply.size();
        Scene scene = parse_scene(folder / "scene.pbrt", world + repeated(shape, 99) + other,
                                  nullptr, {}, limits);
        REQUIRE(scene.geometry.triangles.size() == 200);
        REQUIRE(scene.geometry.positions.size() == 400);
        for (size_t i = 0; i < 400; i++) {
            CHECK(scene.geometry.positions[i].z == static_cast<float>(i / 4));
        }
        // Too many are refused where they are, before any of the last one is stored.
        limits.primitives = 100;
        CHECK(refuse(world + repeated(shape, 99), limits, folder.path() + "/") ==
              folder / "scene.pbrt" +
                  ":52:1: error: the scene has more than 100 triangles, spheres and disks");
    }

    TEST_CASE("truth: reading and building tell what they are at, and how far") {
        TemporaryFolder folder;
        write_file_atomically(folder / "a.ply", square_ply());
        std::string text = world + "Shape \"plymesh\" \"string filename\" \"a.ply\"\n" +
                           repeated("Translate 0 0 1 Shape \"sphere\"\n", 150'000);
        std::vector<Told> told;
        auto report = [&](const std::string& what, double share) { told.push_back({what, share}); };
        Scene scene = parse_scene(folder / "scene.pbrt", text, nullptr, report);
        std::vector<double> of_scene, of_mesh;
        for (const Told& t : told) {
            CHECK((t.share >= 0 && t.share <= 1));
            if (t.what == "reading " + folder / "scene.pbrt") of_scene.push_back(t.share);
            if (t.what == "reading " + folder / "a.ply") of_mesh.push_back(t.share);
        }
        CHECK(of_scene.size() >= 4);  // of 4.6 MB, one each MiB
        CHECK(std::is_sorted(of_scene.begin(), of_scene.end()));
        CHECK(of_scene.back() > 0.7);
        CHECK(of_mesh.size() >= 2);

        told.clear();
        build_bvh(scene.geometry, 1, report);
        CHECK(told.size() >= 9);  // of 16384 references at most
        CHECK(told.back().share == 1);
    }

    TEST_CASE("input: a program prints notes and all errors of a scene, and with --quiet errors") {
        TemporaryFolder folder;
        std::string scene = folder / "scene.pbrt";
        write_file_atomically(scene, "Sampler \"halton\"\nMakeNamedMedium \"a\"\nCamra");
        for (const char* quiet : {"--quiet", "--spp=1"}) {
            Finished end = run(path_tracer, {scene, quiet});
            CHECK(end.code == 1);
            CHECK(end.out == "");
            std::vector<std::string> places = {":1:1: note: ", ":2:1: error: ", ":3:1: error: "};
            if (std::string(quiet) == "--quiet") places.erase(places.begin());
            std::istringstream lines(end.err);
            std::string line;
            for (const std::string& place : places) {
                std::getline(lines, line);
                CHECK(line.starts_with(scene + place));
            }
            CHECK(!std::getline(lines, line));
        }
    }

    TEST_CASE("truth: large shares are written without an exponent") {
        CHECK(percent(0.0123) == "1.23 %");
        CHECK(percent(0.5) == "50 %");
        CHECK(percent(0.9994) == "99.9 %");
        CHECK(percent(0.9999) == "100 %");
        CHECK(percent(1) == "100 %");
        CHECK(percent(-52.345) == "-5234 %");
        CHECK(percent(1e-7) == "1e-05 %");
    }
}
