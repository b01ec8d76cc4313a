// --explain: the table of a path, which adds up.
#include <doctest/doctest.h>

#include <map>
#include <numbers>
#include <sstream>

#include "common/base/vec.h"
#include "common/picture/comparison.h"
#include "common/picture/heat_map.h"
#include "tests/support/process.h"
#include "tests/support/scenes.h"

namespace {

/// What the table says that each pixel gets, "x,y": of its rows, added up here, and its last row.
struct Told {
    Vec3d rows, printed;
};
std::map<std::string, Told> read_table(const std::string& text) {
    std::map<std::string, Told> pixels;
    std::istringstream lines(text.substr(text.rfind("\npixel ")));
    std::string line;
    std::getline(lines, line), std::getline(lines, line);  // a blank one, and the head
    while (std::getline(lines, line) && !line.starts_with("wrote ")) {
        std::istringstream words(line);
        std::vector<std::string> cells;
        for (std::string word; words >> word;) cells.push_back(word);
        size_t n = cells.size();
        REQUIRE(n >= 5);
        Told& told = pixels[cells[0]];
        Vec3d L = {std::stod(cells[n - 3]), std::stod(cells[n - 2]), std::stod(cells[n - 1])};
        bool is_sum = cells[n - 4] == "sum";
        Vec3d& to = is_sum ? told.printed : told.rows;
        to = to + L;
    }
    return pixels;
}

bool near(double a, double b) { return std::abs(a - b) <= 1e-5 * std::abs(b) + 1e-12; }

}  // namespace

TEST_SUITE("explain") {
    TEST_CASE("truth: the densities that are told, under a small ball in the zenith") {
        TemporaryFolder folder;
        std::string scene = folder / "a.pbrt";
        write_file_atomically(scene, R"(LookAt 0 1 -2 0 0 0 0 1 0 PixelFilter "box"
            Camera "perspective" "float fov" 10
            Film "rgb" "integer xresolution" 3 "integer yresolution" 3 WorldBegin
            AttributeBegin Translate 0 2 0 AreaLightSource "diffuse" "rgb L" [10 10 10]
            Shape "sphere" "float radius" 0.01 AttributeEnd
            Material "diffuse" "rgb reflectance" [.5 .5 .5] 
            Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
            "point3 P" [-20 0 -20  -20 0 20  20 0 20  20 0 -20])");
        const double cone = 2 / (0.01 * 0.01 / 4) / (2 * std::numbers::pi);  // 1 / its solid angle
        for (const std::string& program : programs(true)) {
            int number = std::stoi(program.substr(0, 2));
            if (number < 7 || (number > 19 && number != 23 && number != 24)) continue;
            CAPTURE(program);
            Words words = {scene, "--explain", "1,1", "--out", folder / "a.ppm", "--spp", "1"};
            append(words, few_photons(program));
            std::string told = run(program, words).out;
            CHECK(told.find("\nvertex 1  diffuse at (") != std::string::npos);
            auto after = [&](const std::string& word) {
                size_t at = told.find(word);
                REQUIRE(at != std::string::npos);
                return std::stod(told.substr(at + word.size()));
            };
            double cosine = 1 / std::numbers::pi, uniform = cosine / 2;
            std::string on = "goes on along wi (";
            double y = std::stod(told.substr(told.find(", ", told.find(on)) + 2));
            CHECK(after("f (") == doctest::Approx(0.5 / std::numbers::pi).epsilon(1e-4).scale(0));
            CHECK(after("pdf_w ") ==
                  doctest::Approx(number < 10 ? uniform : cosine * y).epsilon(1e-3).scale(0));
            if (number < 9) continue;
            CHECK(after("pdf_l ") == doctest::Approx(cone).epsilon(1e-2).scale(0));
            // With photons only light samples find a lamp from here.
            double pdf_b = number < 10 ? uniform : number > 19 ? 0 : cosine;
            CHECK(std::abs(after("pdf_b ") - pdf_b) < 0.002);
            CHECK(after("mis ") == doctest::Approx(1).epsilon(1e-3).scale(0));
        }
    }

    TEST_CASE("identity: --explain tells the sample that the statistics name as the largest") {
        TemporaryFolder folder;
        for (const std::string& program : {path_tracer, light_tracer}) {
            Words words = {spheres, "--size", "9x8", "--spp", "4", "--out", folder / "a.ppm"};
            append(words, {"--paths", "L.*D.*E"});
            Words render = words;
            append(render, {"--stats", folder / "a.json"});
            Finished rendered = run(program, render);
            REQUIRE(rendered.code == 0);
            std::string stats = read_file(folder / "a.json"), see = "picture: see --explain ";
            size_t from = rendered.out.find(see);
            REQUIRE(from != std::string::npos);
            std::string at = rendered.out.substr(from + see.size());
            at.resize(at.find('\n'));
            CHECK(stats.find("\"largest_sample_at\": \"" + at + "\",\n") != std::string::npos);
            append(words, {"--explain", at});
            Finished end = run(program, words);
            CHECK(end.code == 0);
            double sum = 0;
            for (const auto& [pixel, told] : read_table(end.out)) {
                sum += (told.rows.x + told.rows.y + told.rows.z) / 3;
                for (size_t k = 0; k < 3; k++) CHECK(near(told.rows[k], told.printed[k]));
            }
            CHECK(near(sum, *StatsFile{stats}.number("largest_sample")));
        }
    }

    TEST_CASE("input: a path that is not of the picture cannot be explained") {
        for (const char* path : {"24,0", "0,12", "0,0,2"}) {
            Finished end =
                run(path_tracer, {spheres, "--size", "24x12", "--spp", "2", "--explain", path});
            CHECK(end.code == 2);
            CHECK(end.err.starts_with("error: "));
        }
    }
}

namespace {

/// A camera at (1, 3, -5) that looks about along +z and a little down, 40 x 20 pixels.
Scene room() {
    Scene scene = scene_of(
        "LookAt 1 3 -5  0.5 1 0  0 1 0 Camera \"perspective\" \"float fov\" 50\nWorldBegin\n"
        "LightSource \"point\" \"point3 from\" [0.5 1.5 1]\n" +
        square(0, true));
    scene.width = 40, scene.height = 20;
    return scene;
}

}  // namespace

TEST_SUITE("drawing") {
    TEST_CASE("truth: the colours of a heat map, and which pixel each has") {
        Image numbers(6, 1);
        for (int i = 0; i < 6; i++) numbers.at(i, 0).r = static_cast<float>(2 * i);
        numbers.at(0, 0).r = 5;
        Image map = heat_map(numbers, 8);
        const Rgb colours[] = {{0.5f, 0.5f, 0}, {0, 0, 1}, {0, 1, 0},
                               {1, 0, 0},       {1, 1, 1}, {1, 1, 1}};
        for (int i = 0; i < 6; i++) CHECK(map.at(i, 0) == colours[i]);
        // Of a scene: each pixel shows the number of its own ray.
        Scene scene = room();
        Ray ray = camera_ray(camera_view(scene.camera, 40, 20), {3.5f, 2.5f});
        Image of_work = heat_map(
            scene, 1, [&](const Ray& r) { return length(r.d - ray.d) < 1e-6f ? 1.0f : 0.0f; });
        for (size_t i = 0; i < 800; i++) CHECK(of_work.pixels[i].g == (i == 83 ? 1 : 0));
        CHECK(pixel_rays(scene, 7).size() == 115);
        // Of numbers from 0 to 1: black, red in the middle, white.
        CHECK(false_colour(0.5) == Rgb{0.6f, 0.06f, 0.1f});
        CHECK(false_colour(-1) == Rgb{0, 0, 0});
        CHECK(false_colour(9) == Rgb{1, 1, 1});
    }
}
