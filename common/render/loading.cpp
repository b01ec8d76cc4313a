#include "common/render/loading.h"

#include <map>
#include <set>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/render/options.h"
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
    auto add = [&](bool is_used, const Position* at, const char* error, const char* stand_in) {
        if (is_used) uses.push_back({at, error, stand_in});
    };
    add(!features.lens && scene.camera.lens_radius > 0, scene.camera.at,
        "only chapters 16 to 19 and 21 to 25 have a lens: lensradius must be 0",
        "a lens, in a chapter without one");
    std::set<size_t> materials;
    for (const Shape& shape : scene.shapes) materials.insert(shape.material);
    for (size_t i : materials) {
        const Material& m = scene.materials[i];
        add(!features.dispersion && m.glass, m.at,
            "glass disperses in chapters 18 and 19 only: try a number as its \"float eta\"",
            "glass that disperses, in a chapter without it");
        add(!features.rough && is_rough(m), m.at,
            "rough conductors are not supported before chapter 13", nullptr);
    }
    for (const auto& mover : scene.movers)
        add(!features.shutter, mover->at, "shapes move in chapters 16 to 22 only",
            "a shape that moves, in a chapter where all rest");
    if (scene.sky_image)
        add(!features.sky_image, scene.sky_image->at_file,
            "the sky has an image in chapters 17 to 25 only",
            "a picture of the sky, in a chapter without one");
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
    auto tell_all = [&](const std::vector<std::string>& notes) {
        progress.clear();
        for (const std::string& line : notes) tell(line + "\n");
    };
    std::vector<std::string> notes;
    Report report;
    if (!options.quiet)
        report = [&](const std::string& what, double share) { progress.show(what, share); };
    Scene scene = load_scene(options.scene, &notes, report, options.stand_in);
    if (!options.quiet) tell_all(notes);
    if (options.stand_in) stand_in_for_features(scene, features);
    refuse_features(scene, features, options.stand_in);
    if (options.width > 0) scene.width = options.width, scene.height = options.height;
    if (options.spp > 0) scene.spp = options.spp;
    if (options.max_depth >= 0) scene.max_depth = options.max_depth;
    prepare(scene, options.threads, report);
    if (!options.quiet) tell_all(notes_of_coincident(scene));
    return scene;
}

void stand_in_for_features(Scene& scene, Features features) {
    std::map<std::string, std::set<Position>> used;  // the stand-ins, and where
    for (const Use& use : uses_not_in(features, scene))
        if (use.stand_in) used[use.stand_in].insert(scene.place(use.at));
    Origin origin = *scene.origin;
    for (const auto& [what, places] : used)
        origin.stand_ins.push_back(
            {what, all_stand_ins().at(what), places.size(), *places.begin()});
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

void refuse_delta_lights(const Scene& scene) {
    for (const Light& light : scene.lights)
        if (light.type == LightType::point || light.type == LightType::distant)
            fail(scene.place(light.at),
                 "a point or distant light has no size, so no path can hit it; chapters "
                 "from 09 on sample it");
}
