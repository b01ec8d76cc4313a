#include "common/program/loading.h"

#include <unistd.h>

#include <cstdio>

#include "common/base/position.h"
#include "common/program/loading_progress.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"

namespace {

/// Reads the scene, and prints its notes even if an error follows.
Scene load_and_tell(const RenderOptions& options, const Report& report, LoadingProgress& progress) {
    struct Notes {
        LoadingProgress& progress;
        std::vector<std::string> lines = {};
        ~Notes() {
            progress.clear();
            for (const std::string& line : lines) std::fprintf(stderr, "%s\n", line.c_str());
        }
    } notes{progress};
    return load_scene(options.scene, &notes.lines, report, options.stand_in);
}

}  // namespace

Scene load(const RenderOptions& options, Features features) {
    constexpr double pause = 10;  // s
    LoadingProgress progress(stderr, isatty(STDERR_FILENO), pause);
    Report report;
    if (!options.quiet) {
        report = [&](const std::string& what, double share) { progress.show(what, share); };
    }
    Scene scene;
    try {
        scene = options.quiet ? load_scene(options.scene, nullptr, {}, options.stand_in)
                              : load_and_tell(options, report, progress);
    } catch (const std::bad_alloc&) {
        fail({options.scene}, "out of memory while it was read, with the files that it names");
    }
    refuse_features(scene, features);
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

void refuse_features(const Scene& scene, Features features) {
    const Camera& camera = scene.camera;
    if (features < Features::lens_and_shutter && camera.lens_radius > 0) {
        fail({scene.file, camera.line, camera.column},
             "only chapters 16 to 19 have a lens: lensradius must be 0");
    }
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (features >= Features::dispersion || m.glass == nullptr) continue;
        char eta[32];
        std::snprintf(eta, sizeof eta, "%.5g", double{m.ior});
        fail({scene.file, m.line, m.column},
             std::string("glass disperses in chapters 18 and 19 only: try \"float eta\" ") + eta);
    }
    if (features < Features::lens_and_shutter && !scene.movers.empty()) {
        fail({scene.file, scene.movers[0].line, scene.movers[0].column},
             "shapes move in chapters 16 to 19 only");
    }
    if (features < Features::sky_image && scene.sky_image) {
        fail({scene.file, scene.sky_image->line, scene.sky_image->column},
             "the sky has an image in chapters 17 to 19 only");
    }
}
