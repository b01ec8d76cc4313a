#include "common/program/loading.h"

#include <cstdio>

#include "common/base/error.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"

Scene load(const RenderOptions& options) {
    std::vector<std::string> notes;
    Scene scene = load_scene(options.scene, &notes);
    if (!options.quiet) {
        for (const std::string& note : notes) std::fprintf(stderr, "%s\n", note.c_str());
    }
    if (options.width > 0) scene.width = options.width, scene.height = options.height;
    if (options.spp > 0) scene.spp = options.spp;
    if (options.max_depth >= 0) scene.max_depth = options.max_depth;
    prepare(scene, options.threads);
    return scene;
}

void refuse_delta_lights(const Scene& scene) {
    for (const Light& light : scene.lights) {
        if (light.type != LightType::point && light.type != LightType::distant) continue;
        throw InputError(scene.file + ":" + std::to_string(light.line) + ":" +
                         std::to_string(light.column) + ": error: a " +
                         (light.type == LightType::point ? "point" : "distant") +
                         " light has no size, so no path finds it by chance; "
                         "chapters from 08 on sample it");
    }
}

void refuse_glossy(const Scene& scene) {
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (!is_rough(m)) continue;
        throw InputError(scene.file + ":" + std::to_string(m.line) + ":" +
                         std::to_string(m.column) +
                         ": error: rough conductors are not supported before chapter 12");
    }
}
