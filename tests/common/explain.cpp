// --explain: a path in words, as a table that adds up, and as a drawing.
#include "common/explaining/explain.h"

#include <doctest/doctest.h>

#include <cstring>
#include <map>
#include <numbers>
#include <sstream>

#include "common/picture/stats_file.h"
#include "tests/support/run_program.h"
#include "tests/support/scenes.h"

namespace {

struct Sum {
    double r = 0, g = 0, b = 0;
};

/// What the table says that each pixel gets, "x,y": of its rows, added up here, and its last row.
struct Told {
    Sum rows, printed;
    double scattered = 0;  // of the rows with a D in their class, all channels
};
size_t significant_digits(std::string number) {
    std::erase(number, '.');
    number.erase(0, number.find_first_not_of("-0"));
    return std::min(number.find_first_not_of("0123456789"), number.size());
}
std::map<std::string, Told> read_table(const std::string& text) {
    std::map<std::string, Told> pixels;
    std::istringstream lines(text.substr(text.rfind("\npixel ")));
    std::string line;
    std::getline(lines, line), std::getline(lines, line);  // a blank one, and the head
    while (std::getline(lines, line)) {
        if (line.starts_with("wrote ") || line.starts_with("warning: ")) break;
        std::istringstream words(line);
        std::vector<std::string> cells;
        for (std::string word; words >> word;) cells.push_back(word);
        REQUIRE(cells.size() >= 5);
        size_t n = cells.size();
        for (size_t i = n - 3; i < n; i++) CHECK(significant_digits(cells[i]) <= 7);
        bool is_sum = cells[n - 4] == "sum";
        if (!is_sum && cells[n - 5].find('D') != std::string::npos) {
            for (size_t i = n - 3; i < n; i++) pixels[cells[0]].scattered += std::stod(cells[i]);
        }
        Sum& to = is_sum ? pixels[cells[0]].printed : pixels[cells[0]].rows;
        to.r += std::stod(cells[n - 3]), to.g += std::stod(cells[n - 2]);
        to.b += std::stod(cells[n - 1]);
    }
    return pixels;
}

constexpr double pi_exact = std::numbers::pi;
bool near(double a, double b) { return std::abs(a - b) <= 1e-5 * std::abs(b) + 1e-12; }

/// How many elements of an SVG are opened, less those closed: 0 for one that is well-formed.
std::ptrdiff_t left_open(const std::string& svg) {
    std::ptrdiff_t open = std::count(svg.begin(), svg.end(), '<');
    for (size_t i = 0; i + 1 < svg.size(); i++) {
        open -= svg[i] == '/' && svg[i + 1] == '>';
        open -= svg[i] == '<' && svg[i + 1] == '/' ? 2 : 0;
    }
    return open;
}

}  // namespace

TEST_SUITE("explain") {
    TEST_CASE("identity: the table of an explained path adds up to the picture, in each chapter" *
              doctest::skip()) {
        TemporaryFolder folder;
        Words words = {spheres, "--size", "3x2", "--max-depth", "5", "--spp", "1", "--seed", "4"};
        for (const std::string& program : programs(true)) {
            CAPTURE(program);
            Words render = words;
            render.insert(render.end(), {"--quiet", "--out", folder / "a.pfm"});
            append(render, few_photons(program));
            REQUIRE(run(program, render).code == 0);
            Image image = read_image(folder / "a.pfm"), sum(3, 2);
            int seen = 0;
            for (int i = 0; i < 6; i++) {
                Words explain = words;
                std::string pixel = std::to_string(i % 3) + "," + std::to_string(i / 3);
                explain.insert(explain.end(), {"--explain", pixel, "--out", folder / "b.ppm"});
                append(explain, few_photons(program));
                Finished end = run(program, explain);
                CHECK(end.code == 0);
                CHECK(end.err == "");
                CHECK(end.out.starts_with("pixel " + pixel + " sample 0 of " + spheres + ": "));
                CHECK(end.out.find("No sample was named") != std::string::npos);
                bool has_vertex = end.out.find("\nvertex 1  ") != std::string::npos;
                seen += has_vertex;
                CHECK(end.out.find("warning") == std::string::npos);
                bool has_own_rays = program == "05_ray_casting";
                CHECK((end.out.find("    ends: ") != std::string::npos) == !has_own_rays);
                for (const auto& [at, told] : read_table(end.out)) {
                    CHECK(near(told.rows.r, told.printed.r));
                    CHECK(near(told.rows.g, told.printed.g));
                    CHECK(near(told.rows.b, told.printed.b));
                    int x = 0, y = 0;
                    REQUIRE(std::sscanf(at.c_str(), "%d,%d", &x, &y) == 2);
                    sum.at(x, y) +=
                        Rgb{static_cast<float>(told.rows.r), static_cast<float>(told.rows.g),
                            static_cast<float>(told.rows.b)};
                }
                CHECK(end.out.find("\nwrote " + folder / "b.svg") != std::string::npos);
                std::string svg = read_file(folder / "b.svg");
                CHECK(svg.starts_with("<svg xmlns='http://www.w3.org/2000/svg' "));
                CHECK(svg.ends_with("</svg>\n"));
                CHECK(svg.find("nan") == std::string::npos);
                std::string drawn = svg.substr(0, svg.find("path from the eye"));
                bool has_line = drawn.find("stroke='#c03' stroke-width='2'") != std::string::npos;
                if (has_vertex && program != light_tracer) CHECK(has_line);
                CHECK(left_open(svg) == 0);
            }
            for (size_t i = 0; i < sum.pixels.size(); i++) {
                double a = static_cast<double>(sum.pixels[i].g);
                double b = static_cast<double>(image.pixels[i].g);
                CHECK(std::abs(a - b) <= 1e-4 * b);
            }
            CHECK(seen > 2);
            CHECK_FALSE(folder.names().contains("b.ppm"));
        }
    }

    TEST_CASE("truth: the densities told of a light sample are those of a lamp over a floor") {
        TemporaryFolder folder;
        write_file_atomically(
            folder / "a.pbrt",
            "LookAt 0 1 -4 0 0 0 0 1 0 Camera \"perspective\" WorldBegin Material \"diffuse\" "
            "Shape "
            "\"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [-9 0 -9 0 0 30 9 0 -9] "
            "AreaLightSource \"diffuse\" Translate 0 3 0 Shape \"sphere\" \"float radius\" 0.5");
        int told = 0;
        for (const std::string& program : programs(true)) {
            if (program < "09" || program == "26_radiosity") continue;
            CAPTURE(program);
            Words words = {folder / "a.pbrt", "--size", "8x8",   "--spp",         "4",
                           "--explain",       "4,4,1",  "--out", folder / "a.pfm"};
            append(words, few_photons(program));
            std::string text = run(program, words).out;
            double x = 0, z = 0, y = 0, pdf_l = 0, pdf_b = 0;
            size_t at = text.find("    samples a light along wi (");
            if (at == text.npos) continue;
            size_t vertex = text.rfind("\nvertex ", at);
            REQUIRE(std::sscanf(text.c_str() + vertex, "\nvertex %*d diffuse at (%lf, 0, %lf)", &x,
                                &z) == 2);
            REQUIRE(
                std::sscanf(text.c_str() + at,
                            "    samples a light along wi (%*f, %lf, %*f): pdf_l %lf, pdf_b %lf",
                            &y, &pdf_l, &pdf_b) == 3);
            // The lamp fills a cone whose half angle has the sine 0.5 / distance.
            double cos_cone = std::sqrt(1 - 0.25 / (x * x + 9 + z * z));
            CHECK(near(1 / (2 * pi_exact * (1 - cos_cone)), pdf_l));
            // 09 samples the hemisphere evenly; 23 and 24 stop here, and sample no direction.
            if (program < "10")
                CHECK(near(1 / (2 * pi_exact), pdf_b));
            else
                CHECK(near(few_photons(program).empty() ? y / pi_exact : 0, pdf_b));
            told++;
        }
        CHECK(told >= 14);
    }

    TEST_CASE("identity: a path from the eye is the same, however many numbers the light's took") {
        TemporaryFolder folder;
        const std::string room =
            "LookAt 0 0 -0.5 0 0 0 0 1 0 Camera \"perspective\" WorldBegin Material \"diffuse\" "
            "\"rgb reflectance\" [.5 .5 .5] Shape \"sphere\" \"float radius\" 2 ";
        auto eye_path = [&](const std::string& program, const char* light) {
            write_file_atomically(folder / "a.pbrt", room + light);
            Words words = {folder / "a.pbrt", "--size", "8x8",           "--spp", "4",
                           "--sampler",       "sobol",  "--max-depth",   "4",     "--explain",
                           "3,3,1",           "--out",  folder / "a.pfm"};
            std::string text = run(program, words).out, path;
            std::istringstream lines(text.substr(text.find("from the eye:\n")));
            for (std::string line; std::getline(lines, line);) {
                if (line.starts_with("vertex ")) path += line.substr(line.find("  ")) + "\n";
                if (line.starts_with("    goes on ")) path += line + "\n";
                if (line.starts_with("    s ")) break;
            }
            return path;
        };
        std::vector<std::string> paths;
        for (const char* program :
             {"21_bidirectional", "22_fast_bidirectional", "25_vertex_merging"}) {
            CAPTURE(program);
            std::string path = eye_path(program, "LightSource \"point\"");
            CHECK(std::count(path.begin(), path.end(), '\n') >= 4);
            CHECK(path == eye_path(program,
                                   "AreaLightSource \"diffuse\" Translate 0 1 0 Shape \"sphere\" "
                                   "\"float radius\" 0.01"));
            paths.push_back(path);
        }
        CHECK(paths[0] == paths[1]);
    }

    TEST_CASE("identity: --explain-brightest explains the largest sample of the picture" *
              doctest::skip()) {
        TemporaryFolder folder;
        for (const std::string& program : programs(true)) {
            if (program == "05_ray_casting") continue;  // all its samples of a lamp are alike
            CAPTURE(program);
            Words words = {spheres, "--size", "9x8", "--spp", "4", "--out", folder / "a.ppm"};
            words.insert(words.end(), {"--max-depth", "6"});
            append(words, few_photons(program));
            Words render = words, explain = words;
            render.insert(render.end(),
                          {"--quiet", "--stats", folder / "a.json", "--paths", "L.*D.*E"});
            REQUIRE(run(program, render).code == 0);
            double largest =
                StatsFile::beside(folder / "a.ppm").value().number("largest_sample").value();
            explain.push_back("--explain-brightest");
            Finished end = run(program, explain);
            CHECK(end.code == 0);
            CHECK(end.err == "");
            double sum = 0;
            for (const auto& [pixel, told] : read_table(end.out)) {
                sum += told.scattered / 3;
            }
            CHECK(near(sum, largest));

            // The command that it names prints the same path.
            size_t at = end.out.find("To see it again: ") + std::strlen("To see it again: ");
            std::string command = end.out.substr(at, end.out.find('\n', at) - at);
            std::string place = command.substr(command.find("--explain ") + 10);
            Words again = words;
            again.insert(again.end(), {"--explain", place});
            CHECK(end.out.ends_with("\n\n" + run(program, again).out));
        }
    }

    TEST_CASE("input: a path that is not of the picture cannot be explained") {
        struct {
            const char *path, *error;
        } cases[] = {
            {"24,0", "error: pixel 24,0 lies outside the picture of 24x12\n"},
            {"0,12", "error: pixel 0,12 lies outside the picture of 24x12\n"},
            {"0,0,2", "error: sample 2 is not one of the 2 of a pixel; they count from 0\n"},
        };
        for (const auto& c : cases) {
            Finished end =
                run(path_tracer, {spheres, "--size", "24x12", "--spp", "2", "--explain", c.path});
            CHECK(end.code == 2);
            CHECK(end.err == c.error);
        }
        TemporaryFolder folder;
        Finished end = run(path_tracer, {spheres, "--size", "4x4", "--max-depth", "0",
                                         "--explain-brightest", "--out", folder / "a.ppm"});
        CHECK(end.code == 1);
        CHECK(end.err ==
              "error: --explain-brightest: no path of class L.*D.*E brings light; --paths names "
              "others\n");
    }
}
