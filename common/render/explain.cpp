#include "common/render/explain.h"

#include <algorithm>
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/numbers.h"
#include "common/base/position.h"
#include "common/base/report.h"
#include "common/path/camera_sample.h"
#include "common/recording/class_filter.h"
#include "common/recording/path_story.h"
#include "common/render/path_drawing.h"
#include "common/render/results.h"
#include "common/render/stop.h"
#include "common/render/table.h"
#include "common/scene/origin.h"

namespace {

void check_sample(const Scene& scene, const RenderOptions& o, bool halves) {
    if (o.explain_x >= scene.width || o.explain_y >= scene.height) {
        throw UsageError("error: pixel " + std::to_string(o.explain_x) + "," +
                         std::to_string(o.explain_y) + " lies outside the picture of " +
                         std::to_string(scene.width) + "x" + std::to_string(scene.height));
    }
    if (o.time == 0 && o.explain_sample >= scene.spp && !halves) {
        throw UsageError("error: sample " + std::to_string(o.explain_sample) +
                         " is not one of the " + std::to_string(scene.spp) +
                         " of a pixel; they count from 0");
    }
}

struct Sum {
    double r = 0, g = 0, b = 0;
    void add(Rgb L) { r += double{L.r}, g += double{L.g}, b += double{L.b}; }
    double total() const { return r + g + b; }
    std::vector<std::string> cells() const { return {digits(r, 7), digits(g, 7), digits(b, 7)}; }
};

std::string place(const Scene& scene, size_t pixel) {
    size_t w = static_cast<size_t>(scene.width);
    return std::to_string(pixel % w) + "," + std::to_string(pixel / w);
}

/// All contributions of the sample, with their sum for each pixel: first its own pixel, then those
/// that a path from a light was connected to.
Table table_of(const Scene& scene, std::vector<Contribution> additions, size_t own) {
    std::vector<size_t> pixels = {own};
    for (Contribution& added : additions) {
        if (added.pixel == Contribution::own_pixel) added.pixel = own;
        if (std::find(pixels.begin(), pixels.end(), added.pixel) == pixels.end())
            pixels.push_back(added.pixel);
    }
    Table table{{"pixel", "vertex", "found by", "class", "mis", "R", "G", "B"}, {}};
    auto add_row = [&](std::vector<std::string> cells, const Sum& sum) {
        for (const std::string& cell : sum.cells()) cells.push_back(cell);
        table.rows.push_back(cells);
    };
    for (size_t pixel : pixels) {
        Sum sum;
        for (const Contribution& added : additions) {
            if (added.pixel != pixel) continue;
            Sum one;
            one.add(added.L), sum.add(added.L);
            add_row({place(scene, pixel), std::to_string(added.vertex), added.way, added.path_class,
                     digits(double{added.mis}, 4)},
                    one);
        }
        add_row({place(scene, pixel), "", "", "", "sum"}, sum);
    }
    return table;
}

/// Prints a warning if the contributions do not add up to the radiance that the chapter returned.
void warn_of_gaps(const std::vector<Contribution>& additions, Rgb L, const Splats& splats) {
    Sum told, returned;
    for (const Contribution& added : additions) told.add(added.L);
    returned.add(L);
    for (const Splat& splat : splats) returned.add(splat.L);
    double difference = std::abs(told.total() - returned.total());
    if (difference > 1e-4 * std::abs(returned.total())) {
        std::printf("warning: the sample is (%s), though: the chapter has not reported a part\n",
                    (returned.cells()[0] + ", " + returned.cells()[1] + ", " + returned.cells()[2])
                        .c_str());
    }
}

}  // namespace

int explain(const Scene& scene, const RenderOptions& options, const Method& method) {
    bool halves = method.allocation.pilot > 0;
    check_sample(scene, options, halves);
    int x = options.explain_x, y = options.explain_y, s = std::max(0, options.explain_sample);
    size_t pixel = static_cast<size_t>(y * scene.width + x);

    Limit limit(0);
    TracingLimit tracing([&] { return limit.overdue(); });
    if (method.prepare && !prepare_pass(method, static_cast<uint32_t>(s), options.threads, limit)) {
        tell("stopped before there was a path to explain\n");
        return 3;
    }

    // Trace the sample just as render_film does, and record all of it.
    Sampler sampler(options.sampler, options.seed, static_cast<uint32_t>(scene.spp));
    uint32_t number = static_cast<uint32_t>(halves ? s / 2 : s);
    start_sample(sampler, pixel, halves ? s % 2 : 0, number);
    PathStory story(scene.max_depth, options.search == LightSearch::photons);
    Recorder recorder(true, &story);
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    auto [ray, film] = camera_sample(view, x, y, sampler, scene.camera.pixel_centre);
    Splats splats;
    std::optional<Rgb> L;  // none: the path took too long
    try {
        L = method.trace(scene, ray, splats, sampler, recorder);
        story.ends();
    } catch (const TracingEnds&) {
        story.is_given_up();
    }

    std::printf(
        "pixel %d,%d sample %d of %s: camera at (%.6g, %.6g, %.6g), film point +%.4f +%.4f\n", x, y,
        s, printable(scene.origin->file).c_str(), double{ray.o.x}, double{ray.o.y}, double{ray.o.z},
        double{film.x} - x, double{film.y} - y);
    std::printf("%s", story.text().c_str());
    std::vector<Contribution> counted = recorder.contributions();
    ClassFilter chosen(options.paths);
    std::erase_if(counted, [&](const auto& added) { return !chosen.matches(added.path_class); });
    std::printf("\n%s", aligned(table_of(scene, counted, pixel)).c_str());
    if (L) warn_of_gaps(recorder.contributions(), *L, splats);

    std::string file = drawing_path(options);
    // Draw only the beginning of a very long path.
    constexpr size_t most_drawn = 1000;
    std::vector<PathVertex> vertices = recorder.vertices();
    std::vector<TracedRay> rays = story.rays();
    if (vertices.size() > most_drawn) vertices.resize(most_drawn);
    if (rays.size() > most_drawn) rays.resize(most_drawn);
    write_file_atomically(file, draw_path(scene, ray.o, vertices, rays));
    if (!options.quiet) std::printf("wrote %s\n", file.c_str());
    if (!L) return 3;
    bool finite = std::all_of(counted.begin(), counted.end(),
                              [](const Contribution& added) { return is_finite(added.L); });
    return finite ? 0 : 1;
}

RenderOptions explain_brightest(const RenderOptions& options, const Rendering& rendering) {
    const RenderStats& s = rendering.stats;
    if (!(s.largest > 0)) {
        throw InputError("error: --explain-brightest: no path of class " +
                         (options.paths.empty() ? "L.*D.*E" : options.paths) +
                         " brings light; --paths names others");
    }
    RenderOptions found = options;
    found.explain = true, found.explain_brightest = false;
    found.explain_x = s.largest_x, found.explain_y = s.largest_y;
    found.explain_sample = s.largest_sample;
    std::string place = std::to_string(s.largest_x) + "," + std::to_string(s.largest_y) + "," +
                        std::to_string(s.largest_sample);
    double all = rendering.film.mean() * static_cast<double>(rendering.film.samples());
    std::printf(
        "Of %llu samples the brightest brings %.4g, %s of all light that counts here: %s.\n",
        static_cast<unsigned long long>(rendering.film.samples()), s.largest,
        percent(s.largest / all).c_str(),
        options.paths.empty() ? "paths of class L.*D.*E, without lamps that are merely seen"
                              : "that of --paths");
    std::string again = options.command, brightest = " --explain-brightest";
    for (size_t at; (at = again.find(brightest)) != std::string::npos;)
        again.replace(at, brightest.size(), " --explain " + place);
    std::printf("To see it again: %s\n\n", again.c_str());
    return found;
}
