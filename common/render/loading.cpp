#include "common/render/loading.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/scene/mover.h"
#include "common/scene/prepare.h"
#include "common/scene/sky_image.h"
#include "common/scene_file/reader.h"

namespace {

/// A place in the scene file that uses a feature which the chapter lacks.
struct Use {
    const Position* at;
    const char *error, *stand_in;  // or none
};
std::vector<Use> uses_not_in(Features features, const Scene& scene) {
    std::vector<Use> uses;
    if (!features.lens && scene.camera.lens_radius > 0)
        uses.push_back({scene.camera.at,
                        "only chapters 16 to 19 and 21 to 25 have a lens: lensradius must be 0",
                        "a lens, in a chapter without one"});
    std::set<size_t> materials;
    for (const Shape& shape : scene.shapes) materials.insert(shape.material);
    for (size_t i : materials)
        if (!features.dispersion && scene.materials[i].glass)
            uses.push_back({scene.materials[i].at,
                            "glass disperses in chapters 18 and 19 only: try a number as its "
                            "\"float eta\"",
                            "glass that disperses, in a chapter without it"});
    for (const Mover& mover : scene.movers)
        if (!features.shutter)
            uses.push_back({mover.at, "shapes move in chapters 16 to 22 only",
                            "a shape that moves, in a chapter where all rest"});
    if (!features.sky_image && scene.sky_image)
        uses.push_back({scene.sky_image->at_file, "the sky has an image in chapters 17 to 25 only",
                        "a picture of the sky, in a chapter without one"});
    for (size_t i : materials)
        if (!features.rough && is_rough(scene.materials[i]))
            uses.push_back({scene.materials[i].at,
                            "rough conductors are not supported before chapter 13", nullptr});
    return uses;
}

/// The mean radiance from all directions.
Rgb mean_of(const SkyImage& sky) {
    Rgbd sum;
    double weights = 0;
    for (size_t i = 0; i < sky.pixels.size(); i++) {
        double w = static_cast<double>(solid_angle_per_area(sky, sky.middle_of(i)));
        sum += w * Rgbd(sky.pixels[i]);
        weights += w;
    }
    return to_rgb({sum.r / weights, sum.g / weights, sum.b / weights});
}

}  // namespace

Scene load(const RenderOptions& options, Features features) {
    Progress progress(10);
    Report report;
    std::vector<std::string> notes;
    auto tell_notes = [&] {
        progress.clear();
        for (const std::string& line : notes) tell(line + "\n");
        notes.clear();
    };
    if (!options.quiet)
        report = [&](const std::string& what, double share) { progress.show(what, share); };
    Scene scene;
    try {
        scene =
            load_scene(options.scene, options.quiet ? nullptr : &notes, report, options.stand_in);
    } catch (const std::bad_alloc&) {
        fail({options.scene}, "out of memory while it was read, with the files that it names");
    } catch (...) {
        tell_notes();
        throw;
    }
    tell_notes();
    if (options.stand_in) stand_in_for_features(scene, features);
    refuse_features(scene, features, options.stand_in);
    if (options.width > 0) scene.width = options.width, scene.height = options.height;
    if (options.spp > 0) scene.spp = options.spp;
    if (options.max_depth >= 0) scene.max_depth = options.max_depth;
    size_t prims = scene.geometry.size();
    // About, while it is built: 300 bytes for each.
    needing_memory("the hierarchy of " + std::to_string(prims) + " triangles, spheres and disks",
                   300 * prims, [&] { prepare(scene, options.threads, report); });
    if (!options.quiet) notes = notes_of_coincident(scene);
    tell_notes();
    return scene;
}

void stand_in_for_features(Scene& scene, Features features) {
    std::vector<Use> uses = uses_not_in(features, scene);
    Origin origin = *scene.origin;
    for (const auto& [what, instead] : all_stand_ins()) {
        UsedStandIn used{what, instead, 0, {}};
        for (const Use& use : uses) {
            if (!use.stand_in || use.stand_in != what) continue;
            if (used.places++ == 0) used.first = scene.place(use.at);
        }
        if (used.places > 0) origin.stand_ins.push_back(used);
    }
    scene.origin = std::make_shared<Origin>(std::move(origin));
    if (!features.lens) scene.camera.lens_radius = 0;
    for (Material& m : scene.materials)
        if (!features.dispersion) m.glass = nullptr;
    // What moves rests, since the rays have time 0.
    if (!features.sky_image && scene.sky_image) {
        Light sky;
        sky.type = LightType::infinite;
        sky.at = scene.sky_image->at_file;
        sky.L = mean_of(*scene.sky_image);
        scene.lights.push_back(sky);
        scene.sky_image = {};
    }
}

void refuse_features(const Scene& scene, Features features, bool stand_ins) {
    for (const Use& use : uses_not_in(features, scene)) {
        if (stand_ins && use.stand_in) continue;
        fail(scene.place(use.at), use.error + (use.stand_in ? or_stand_in(use.stand_in) : ""));
    }
}

float radius_within(const Scene& scene, double radius) {
    double low = 1e-6 * double{scene.radius}, high = 2 * double{scene.radius};
    if (radius > 0 && high > 0 && (radius < low || radius > high)) {
        char wanted[64], given[32];
        std::snprintf(wanted, sizeof wanted, "a length from %.3g to %.3g m in this scene", low,
                      high);
        std::snprintf(given, sizeof given, "%g", radius);
        fail_value("radius", given, wanted);
    }
    return static_cast<float>(radius);
}

void refuse_delta_lights(const Scene& scene) {
    for (const Light& light : scene.lights)
        if (light.type == LightType::point || light.type == LightType::distant)
            fail(scene.place(light.at),
                 "a point or distant light has no size, so no path can hit it; chapters "
                 "from 09 on sample it");
}
