#include "common/options/loading.h"

#include <unistd.h>

#include <cstdio>

#include "common/base/position.h"
#include "common/options/loading_progress.h"
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

/// The chapters that render scenes with this feature, such as "16 to 19, 23 and 24".
std::string chapters_with(bool Features::*feature) {
    std::vector<std::string> parts;
    for (int first = 1, last; first <= 26; first = last + 1) {
        for (last = first; features_of(last).*feature && features_of(last + 1).*feature;) last++;
        if (!(features_of(first).*feature)) continue;
        parts.push_back(std::to_string(first));
        if (last > first + 1) parts.back() += " to " + std::to_string(last);
        if (last == first + 1) parts.push_back(std::to_string(last));
    }
    std::string text = parts[0];
    for (size_t i = 1; i < parts.size(); i++)
        text += (i + 1 < parts.size() ? ", " : " and ") + parts[i];
    return text;
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
    if (!features.lens && camera.lens_radius > 0) {
        fail({scene.file, camera.line, camera.column}, "only chapters " +
                                                           chapters_with(&Features::lens) +
                                                           " have a lens: lensradius must be 0");
    }
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (features.dispersion || m.glass == nullptr) continue;
        char eta[32];
        std::snprintf(eta, sizeof eta, "%.5g", double{m.ior});
        fail({scene.file, m.line, m.column}, "glass disperses in chapters " +
                                                 chapters_with(&Features::dispersion) +
                                                 " only: try \"float eta\" " + eta);
    }
    if (!features.shutter && !scene.movers.empty()) {
        fail({scene.file, scene.movers[0].line, scene.movers[0].column},
             "shapes move in chapters " + chapters_with(&Features::shutter) + " only");
    }
    if (!features.sky_image && scene.sky_image) {
        fail({scene.file, scene.sky_image->line, scene.sky_image->column},
             "the sky has an image in chapters " + chapters_with(&Features::sky_image) + " only");
    }
}
