#include "common/program/loading.h"

#include <unistd.h>

#include <cstdio>

#include "common/base/position.h"
#include "common/program/loading_progress.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"

namespace {

/// Reads the scene, and prints the notes even when an error follows.
Scene load_and_tell(const std::string& path, const Report& report, LoadingProgress& progress) {
    struct Notes {
        LoadingProgress& progress;
        std::vector<std::string> lines = {};
        ~Notes() {
            progress.clear();
            for (const std::string& line : lines) std::fprintf(stderr, "%s\n", line.c_str());
        }
    } notes{progress};
    return load_scene(path, &notes.lines, report);
}

}  // namespace

Scene load(const RenderOptions& options, bool has_distribution) {
    constexpr double pause = 10;  // s
    LoadingProgress progress(stderr, isatty(STDERR_FILENO), pause);
    Report report;
    if (!options.quiet) {
        report = [&](const std::string& what, double share) { progress.show(what, share); };
    }
    Scene scene;
    try {
        scene = options.quiet ? load_scene(options.scene, nullptr)
                              : load_and_tell(options.scene, report, progress);
    } catch (const std::bad_alloc&) {
        fail({options.scene}, "out of memory while it was read, with the files that it names");
    }
    if (!has_distribution) refuse_distribution(scene);
    if (options.width > 0) scene.width = options.width, scene.height = options.height;
    if (options.spp > 0) scene.spp = options.spp;
    if (options.max_depth >= 0) scene.max_depth = options.max_depth;
    size_t prims = scene.geometry.size();
    // About, while it is built: 300 bytes for each.
    needing_memory("the hierarchy of " + std::to_string(prims) + " triangles, spheres and disks",
                   300 * prims, [&] { prepare(scene, options.threads, report); });
    return scene;
}

void refuse_delta_lights(const Scene& scene) {
    for (const Light& light : scene.lights) {
        if (light.type != LightType::point && light.type != LightType::distant) continue;
        fail(
            {scene.file, light.line, light.column},
            std::string("a ") + (light.type == LightType::point ? "point" : "distant") +
                " light has no size, so no path finds it by chance; chapters from 09 on sample it");
    }
}

void refuse_glossy(const Scene& scene) {
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (!is_rough(m)) continue;
        fail({scene.file, m.line, m.column},
             "rough conductors are not supported before chapter 13");
    }
}

void refuse_distribution(const Scene& scene) {
    const Camera& camera = scene.camera;
    if (camera.lens_radius > 0) {
        fail({scene.file, camera.line, camera.column},
             "all chapters but 16 and 19 have a pinhole: lensradius must be 0");
    }
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (m.glass == nullptr) continue;
        char eta[32];
        std::snprintf(eta, sizeof eta, "%.5g", double{m.ior});
        fail({scene.file, m.line, m.column},
             std::string("outside chapters 16 and 19 glass does not ") +
                 "disperse: try \"float eta\" " + eta);
    }
    if (!scene.movers.empty()) {
        fail({scene.file, scene.movers[0].line, scene.movers[0].column},
             "outside chapters 16 and 19 nothing moves");
    }
    if (scene.sky_image) {
        fail({scene.file, scene.sky_image->line, scene.sky_image->column},
             "outside chapters 16 and 19 the sky has no picture");
    }
}
