// How the time grows with samples, pixels, threads, triangles and lights, with fitted exponents.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/measure/lines.h"
#include "tests/measure/measure.h"
#include "tests/support/work.h"

namespace {

/// What the program measures: the methods, and how far it goes.
struct Growth {
    MeasureOptions o;
    std::vector<Method> methods;
    double largest;  // of what grows, as a share of the full size
    Work& work;
};

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

/// One line for each method: seconds(method, x) over x = 1, factor, factor^2, ... times first.
template <class Seconds>
LinePanel panel_of(const Growth& growth, const std::string& title, const std::string& x_label,
                   const std::string& theory, double first, double last, double factor,
                   Seconds seconds) {
    LinePanel panel{title, x_label, "seconds", {}};
    for (const Method& m : growth.methods)
        panel.lines.push_back({m.label, m.color, theory, {}, {}});
    double sum = 0;
    for (double x = first; x <= 1.001 * last; x *= factor) sum += x;
    for (double x = first; x <= 1.001 * last; x *= factor) {
        growth.work.next("seconds against " + x_label + ", " + short_number(x), x / sum);
        auto seconds_at = seconds(x);
        for (size_t i = 0; i < growth.methods.size(); i++) {
            panel.lines[i].x.push_back(x);
            panel.lines[i].y.push_back(seconds_at(growth.methods[i]));
        }
    }
    return panel;
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

/// Triangles: the time of rendering, and that of building the hierarchy.
LinePanel over_triangles(const Growth& growth) {
    Line building{"building the hierarchy", "#000000", "1", {}, {}};
    LinePanel panel = panel_of(
        growth, "triangles", "triangles", "log", 100, 1e7 * growth.largest, 10, [&](double n) {
            Stopwatch watch;
            Scene scene = scene_of(world + ceiling_of_lights(1), n, growth.o);
            building.x.push_back(n);
            building.y.push_back(watch.seconds() / growth.o.threads);
            return [&growth, scene](const Method& m) { return seconds_of(m, scene, growth.o, 16); };
        });
    panel.lines.push_back(building);
    return panel;
}

LinePanel over_lights(const Growth& growth) {
    return panel_of(growth, "lights", "lights", "0", 1, 1e5 * growth.largest, 10, [&](double n) {
        int side = static_cast<int>(std::lround(std::sqrt(n)));
        Scene scene = scene_of(world + ceiling_of_lights(side), 1000, growth.o);
        return [&growth, scene](const Method& m) { return seconds_of(m, scene, growth.o, 16); };
    });
}

std::vector<LinePanel> over_samples_pixels_threads(const Growth& growth) {
    MeasureOptions o = growth.o;
    Scene scene = load_scene_for("scenes/cornell.pbrt", o);
    auto spp = [&](double x) {
        return
            [&, x](const Method& m) { return seconds_of(m, scene, growth.o, static_cast<int>(x)); };
    };
    auto pixels = [&](double x) {
        Scene sized = scene;
        sized.width = sized.height = static_cast<int>(std::lround(std::sqrt(x)));
        return [&, sized](const Method& m) { return seconds_of(m, sized, growth.o, 4); };
    };
    auto threads = [&](double x) {
        MeasureOptions with = o;
        with.threads = static_cast<int>(x);
        Scene sized = scene;
        sized.width = sized.height = 256;  // tiles enough to share them out evenly
        return [&, with, sized](const Method& m) { return seconds_of(m, sized, with, 8, true); };
    };
    std::vector<LinePanel> panels = {
        panel_of(growth, "samples", "samples per pixel", "1", 1, 1024 * growth.largest, 4, spp),
        panel_of(growth, "pixels", "pixels", "1", 1024, (1 << 20) * growth.largest, 4, pixels),
        panel_of(growth, "threads (wall clock)", "threads", "-1", 1, o.threads, 2, threads)};

    // What else the machine does comes and goes: let few and many threads take turns.
    for (int turn = 1; turn < 5; turn++) {
        LinePanel again = panel_of(growth, "", "threads", "", 1, o.threads, 2, threads);
        for (size_t line = 0; line < again.lines.size(); line++) {
            for (size_t i = 0; i < again.lines[line].y.size(); i++) {
                double& least = panels[2].lines[line].y[i];
                least = std::min(least, again.lines[line].y[i]);
            }
        }
    }
    panels[2].x_axis =
        "set xtics (1,2,4,8,16,32,64)\nset xrange [0.9:" + digits(1.1 * std::max(2, o.threads)) +
        "]\nset format x '%g'";
    return panels;
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
        constexpr int panels_measured = 9;  // five, one of them five times
        Work work("growth: seconds against samples, pixels, threads, triangles and lights",
                  panels_measured);
        Growth growth{o, methods_named(o.methods), share, work};
        std::vector<LinePanel> panels = over_samples_pixels_threads(growth);
        panels.push_back(over_triangles(growth));
        panels.push_back(over_lights(growth));
        write_table(o.out, "chart-growth", points_table(panels));
        draw_panels(
            o.out + "/chart-growth",
            "Time grows with samples and pixels in proportion, hardly with triangles and lights",
            panels, 3);
        std::printf("exponents of the time\n%s", markdown(slopes_table(panels)).c_str());
        return 0;
    });
}
