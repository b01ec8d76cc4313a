// How the time grows with samples, pixels, threads, triangles and lights, with fitted exponents.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>

#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/measure/lines.h"
#include "tests/measure/measure.h"
#include "tests/support/work.h"

namespace {

double wall_clock() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// Median processor time of three renders over threads; by the clock on the wall the least, as what
/// else the machine does only adds to it.
double seconds_of(const Method& method, const Scene& scene, const MeasureOptions& o, int spp,
                  bool by_wall = false) {
    Scene own = scene;  // render_once sets its samples
    std::vector<double> seconds;
    for (uint32_t run = 0; run < 3; run++) {
        double start = wall_clock();
        Rendering r = render_once(method, own, o, spp, run);
        seconds.push_back(by_wall ? wall_clock() - start : r.stats.seconds);
    }
    return by_wall ? *std::min_element(seconds.begin(), seconds.end()) : median(seconds);
}

constexpr const char* world = R"(
LookAt 0 2 -3  0 0 0  0 1 0
Camera "perspective" "float fov" 50
WorldBegin
Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-9 -1 -9  0 -1 9  9 -1 -9]
)";

/// n x n square lights of one area together, over a floor.
std::string ceiling_of_lights(int n) {
    std::string text =
        "AttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
        "AreaLightSource \"diffuse\" \"rgb L\" [5 5 5]\n";
    double cell = 4.0 / n, side = 0.25 * cell;
    for (int i = 0; i < n * n; i++) {
        double x = (i % n + 0.5) * cell - 2, z = (i / n + 0.5) * cell - 2;
        char shape[300];
        std::snprintf(shape, sizeof shape,
                      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
                      "[%g 3 %g  %g 3 %g  %g 3 %g  %g 3 %g]\n",
                      x - side, z - side, x + side, z - side, x + side, z + side, x - side,
                      z + side);
        text += shape;
    }
    return text + "AttributeEnd\n";
}

/// A floor of about so many triangles, with bumps.
void add_bumpy_floor(Geometry& g, double triangles) {
    uint32_t n = static_cast<uint32_t>(std::sqrt(triangles / 2));
    uint32_t base = static_cast<uint32_t>(g.positions.size()), shape = g.triangles[0].shape;
    auto place = [&](uint32_t i) { return 4 * static_cast<float>(i) / static_cast<float>(n) - 2; };
    for (uint32_t j = 0; j <= n; j++) {
        for (uint32_t i = 0; i <= n; i++) {
            float x = place(i), z = place(j);
            g.positions.push_back({x, 0.2f * std::sin(5 * x) * std::sin(7 * z), z});
        }
    }
    for (uint32_t j = 0; j < n; j++) {
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = base + j * (n + 1) + i, b = a + n + 1;
            g.triangles.push_back({{a, b, b + 1}, shape});
            g.triangles.push_back({{a, b + 1, a + 1}, shape});
        }
    }
}

Scene scene_of(const std::string& text, double triangles, const MeasureOptions& o) {
    Scene scene = parse_scene("growth", text, nullptr);
    scene.width = scene.height = 128;
    if (triangles > 0) add_bumpy_floor(scene.geometry, triangles);
    prepare(scene, o.threads);
    return scene;
}

/// The seconds of each method at each x: a line for each method.
using Render = std::function<double(const Method&)>;
void add_lines(const std::vector<Method>& methods, const std::string& panel,
               const std::string& theory, const std::vector<double>& xs,
               const std::function<Render(double x)>& at, Work& work, std::vector<Line>& lines) {
    size_t first = lines.size();
    for (const Method& m : methods) lines.push_back({panel, m.label, m.color, theory});
    for (double x : xs) {
        work.next("seconds against " + panel + ", " + short_number(x));
        Render seconds = at(x);
        for (size_t i = 0; i < methods.size(); i++) {
            lines[first + i].x.push_back(x);
            lines[first + i].y.push_back(seconds(methods[i]));
        }
    }
}

/// first, first * factor, ... up to last.
std::vector<double> steps(double first, double last, double factor) {
    std::vector<double> xs;
    for (double x = first; x <= 1.001 * last; x *= factor) xs.push_back(x);
    return xs;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        double share = 1;
        Option quick = {"quick", "", "a tenth of the sizes",
                        [&](const std::string&) { share = 0.1; }};
        MeasureOptions o = parse_measure_options(
            argc, argv, "",
            "Seconds against samples, pixels, threads, triangles and lights. Writes "
            "chart-growth.svg, .png and .tsv.",
            {.methods = {"07", "09", "11", "15"}, .width = 64, .height = 64}, {quick});
        std::vector<Method> methods = methods_named(o.methods);
        std::vector<double> spp = steps(1, 1024 * share, 4),
                            pixels = steps(1024, (1 << 20) * share, 4),
                            threads = steps(1, o.threads, 2),
                            triangles = steps(100, 1e7 * share, 10),
                            lights = steps(1, 1e5 * share, 10);
        Work work("growth: seconds against samples, pixels, threads, triangles and lights",
                  static_cast<double>(spp.size() + pixels.size() + threads.size() +
                                      triangles.size() + lights.size()));
        std::vector<Line> lines;
        Scene cornell = load_scene_for("scenes/cornell.pbrt", o);
        auto add = [&](const char* panel, const char* theory, const std::vector<double>& xs,
                       const auto& at) { add_lines(methods, panel, theory, xs, at, work, lines); };
        add("samples per pixel", "1", spp, [&](double x) {
            return
                [&, x](const Method& m) { return seconds_of(m, cornell, o, static_cast<int>(x)); };
        });
        auto sized = [&](double x) {
            Scene scene = cornell;
            scene.width = scene.height = static_cast<int>(std::lround(std::sqrt(x)));
            return scene;
        };
        add("pixels", "1", pixels, [&](double x) {
            return [&, scene = sized(x)](const Method& m) { return seconds_of(m, scene, o, 4); };
        });
        add("threads (wall clock)", "-1", threads, [&](double x) {
            return [&, x, scene = sized(256 * 256)](const Method& m) {
                MeasureOptions with = o;
                with.threads = static_cast<int>(x);
                return seconds_of(m, scene, with, 8, true);
            };
        });
        add("triangles", "log", triangles, [&](double n) {
            return [&, scene = scene_of(world + ceiling_of_lights(1), n, o)](const Method& m) {
                return seconds_of(m, scene, o, 16);
            };
        });
        add("lights", "0", lights, [&](double n) {
            int side = static_cast<int>(std::lround(std::sqrt(n)));
            return [&, scene = scene_of(world + ceiling_of_lights(side), 1000, o)](
                       const Method& m) { return seconds_of(m, scene, o, 16); };
        });
        write_lines(o.out, "chart-growth",
                    "Time grows with samples and pixels in proportion, hardly with triangles and "
                    "lights",
                    "how many", "seconds", lines);
        std::printf("exponents of the time\n%s", markdown(slopes_table(lines)).c_str());
        return 0;
    });
}
