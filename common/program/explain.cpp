#include "common/program/explain.h"

#include <cstdio>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/path/camera_sample.h"
#include "common/program/path_drawing.h"

int explain(const Scene& scene, const RenderOptions& options, const SplatTrace& trace,
            bool halves) {
    int x = options.explain_x, y = options.explain_y, s = options.explain_sample;
    if (x >= scene.width || y >= scene.height) {
        throw UsageError("error: pixel " + std::to_string(x) + "," + std::to_string(y) +
                         " lies outside the picture of " + std::to_string(scene.width) + "x" +
                         std::to_string(scene.height));
    }

    if (options.time == 0 && s >= scene.spp && !halves) {
        throw UsageError("error: sample " + std::to_string(s) + " is not one of the " +
                         std::to_string(scene.spp) + " of a pixel; they count from 0");
    }

    // Trace the sample just as render_film does, with a log that listens.
    Sampler sampler(options.sampler, options.seed, static_cast<uint32_t>(scene.spp));
    uint32_t number = static_cast<uint32_t>(halves ? s / 2 : s);
    start_sample(sampler, static_cast<size_t>(y * scene.width + x), halves ? s % 2 : 0, number);
    PathLog log(options.paths, true);
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    auto [ray, film] = camera_sample(view, x, y, sampler, options.pixel_centre);
    Splats splats;
    Rgb L = trace(scene, ray, splats, sampler, log);

    std::printf(
        "pixel %d,%d sample %d of %s: camera at (%.6g, %.6g, %.6g), film point +%.4f +%.4f\n", x, y,
        s, scene.file.c_str(), double{ray.o.x}, double{ray.o.y}, double{ray.o.z},
        double{film.x} - x, double{film.y} - y);
    std::printf("%s", log.steps().c_str());
    if (log.paths_cut() > 0) std::printf("    is ended by the depth limit %d\n", scene.max_depth);
    std::printf("L (%.6g, %.6g, %.6g)\n", double{L.r}, double{L.g}, double{L.b});
    for (const Splat& splat : splats) {
        size_t w = static_cast<size_t>(scene.width);
        std::printf("and (%.6g, %.6g, %.6g) in pixel %zu,%zu\n", double{splat.L.r},
                    double{splat.L.g}, double{splat.L.b}, splat.pixel % w, splat.pixel / w);
        L += splat.L;
    }

    std::filesystem::path file = options.out[0];
    file.replace_extension(".svg");
    check_outputs({file.string()}, options.scene);
    write_file_atomically(file.string(), draw_path(scene, ray.o, log.vertices()));
    if (!options.quiet) std::printf("wrote %s\n", file.string().c_str());
    return is_finite(L) ? 0 : 1;
}
