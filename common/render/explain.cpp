#include <algorithm>
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/progress.h"
#include "common/base/text.h"
#include "common/path/camera_sample.h"
#include "common/recording/class_filter.h"
#include "common/recording/path_story.h"
#include "common/render/path_drawing.h"
#include "common/render/render.h"
#include "common/render/table.h"
#include "common/scene/origin.h"

namespace {

void check_sample(const Scene& scene, const RenderOptions& o, bool halves) {
    std::string given = std::to_string(o.explain_x) + "," + std::to_string(o.explain_y),
                size = std::to_string(scene.width) + "x" + std::to_string(scene.height);
    if (o.explain_x >= scene.width || o.explain_y >= scene.height)
        fail_value("explain", given, "a pixel of the picture of " + size);
    if (o.time == 0 && o.explain_sample >= scene.spp && !halves)
        fail_value("explain", given + "," + std::to_string(o.explain_sample),
                   "a sample below " + std::to_string(scene.spp) + ", as they count from 0");
}

Vec3d numbers_of(Rgb L) { return {double{L.r}, double{L.g}, double{L.b}}; }

/// The words, and three numbers.
std::vector<std::string> row(std::vector<std::string> words, Vec3d L) {
    for (double x : {L.x, L.y, L.z}) words.push_back(digits(x, 7));
    return words;
}

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
    for (size_t pixel : pixels) {
        Vec3d sum;
        for (const Contribution& added : additions) {
            if (added.pixel != pixel) continue;
            sum = sum + numbers_of(added.L);
            table.rows.push_back(row({place(scene, pixel), std::to_string(added.vertex), added.way,
                                      added.path_class, digits(double{added.mis}, 4)},
                                     numbers_of(added.L)));
        }
        table.rows.push_back(row({place(scene, pixel), "", "", "", "sum"}, sum));
    }
    return table;
}

/// Prints a warning if the contributions do not add up to the radiance that the chapter returned.
void warn_of_gaps(const std::vector<Contribution>& additions, Rgb L, const Splats& splats) {
    auto total = [](Rgb c) { return double{c.r} + double{c.g} + double{c.b}; };
    double told = 0, returned = total(L);
    for (const Contribution& added : additions) told += total(added.L);
    for (const Splat& splat : splats) returned += total(splat.L);
    if (std::abs(told - returned) > 1e-4 * std::abs(returned))
        std::printf(
            "warning: the sample is %.6g of all colours, and this is %.6g: the chapter has not "
            "reported a part\n",
            returned, told);
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
    } catch (const TracingEnds&) {
        story.step("    given up here: the path goes on, but the program was stopped\n");
    }
    story.ends();

    std::printf(
        "pixel %d,%d sample %d of %s: camera at (%.6g, %.6g, %.6g), film point +%.4f +%.4f\n", x, y,
        s, printable(scene.origin->file).c_str(), double{ray.o.x}, double{ray.o.y}, double{ray.o.z},
        double{film.x} - x, double{film.y} - y);
    std::printf("%s", story.text.c_str());
    std::vector<Contribution> counted = recorder.contributions();
    ClassFilter chosen(options.paths);
    std::erase_if(counted, [&](const auto& added) { return !chosen.matches(added.path_class); });
    std::printf("\n%s", aligned(table_of(scene, counted, pixel)).c_str());
    if (L) warn_of_gaps(recorder.contributions(), *L, splats);

    std::string file = drawing_path(options);
    // Of a very long path only the beginning.
    auto first = [](auto list) {
        list.resize(std::min<size_t>(list.size(), 1000));
        return list;
    };
    std::string drawn = draw_path(scene, ray.o, first(recorder.vertices()), first(story.rays));
    write_file_atomically(file, drawn);
    if (!options.quiet) std::printf("wrote %s\n", file.c_str());
    if (!L) return 3;
    bool finite = std::all_of(counted.begin(), counted.end(),
                              [](const Contribution& added) { return is_finite(added.L); });
    return finite ? 0 : 1;
}
