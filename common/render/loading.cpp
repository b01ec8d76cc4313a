#include <map>
#include <set>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/render/render.h"
#include "common/scene/mover.h"
#include "common/scene/prepare.h"
#include "common/scene/sky_image.h"
#include "common/scene_file/reader.h"

/// The mean radiance from all directions.
static Rgb mean_of(const SkyImage& sky) {
    Rgbd sum;
    double weights = 0;
    for (size_t i = 0; i < sky.pixels.size(); i++) {
        double w = static_cast<double>(solid_angle_per_area(sky, sky.middle_of(i)));
        sum += w * Rgbd(sky.pixels[i]);
        weights += w;
    }
    return to_rgb({sum.r / weights, sum.g / weights, sum.b / weights});
}

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
    fit_features(scene, features, options.stand_in);
    if (options.width > 0) scene.width = options.width, scene.height = options.height;
    if (options.spp > 0) scene.spp = options.spp;
    if (options.max_depth >= 0) scene.max_depth = options.max_depth;
    check_outputs(scene, options);
    prepare(scene, options.threads, report);
    if (!options.quiet) tell_all(notes_of_coincident(scene));
    return scene;
}

void fit_features(Scene& scene, Features features, bool stand_ins) {
    std::map<std::string, std::set<Position>> used;  // the stand-ins, and where
    auto without = [&](bool is_lacking, const Position* at, const char* error,
                       const std::string& stand_in) {
        if (!is_lacking) return;
        Position place = scene.place(at);
        if (!stand_ins || stand_in.empty()) fail(place, error + or_stand_in(stand_in));
        used[stand_in].insert(place);
    };
    without(!features.lens && scene.camera.lens_radius > 0, scene.camera.at,
            "only chapters 16 to 19 and 21 to 25 have a lens: lensradius must be 0",
            "a lens, in a chapter without one");
    std::set<size_t> materials;
    for (const Shape& shape : scene.shapes) materials.insert(shape.material);
    for (size_t i : materials) {
        const Material& m = scene.materials[i];
        without(!features.dispersion && m.glass, m.at,
                "glass disperses in chapters 18 and 19 only: try a number as its \"float eta\"",
                "glass that disperses, in a chapter without it");
        without(!features.rough && is_rough(m), m.at,
                "rough conductors are not supported before chapter 13", "");
    }
    for (const auto& mover : scene.movers)
        without(!features.shutter, mover->at, "shapes move in chapters 16 to 22 only",
                "a shape that moves, in a chapter where all rest");
    bool lacks_sky = !features.sky_image && scene.sky_image;
    without(lacks_sky, lacks_sky ? scene.sky_image->at_file : nullptr,
            "the sky has an image in chapters 17 to 25 only",
            "a picture of the sky, in a chapter without one");
    if (used.empty()) return;

    Origin origin = *scene.origin;
    for (const auto& [what, places] : used)
        origin.stand_ins.push_back(
            {what, all_stand_ins().at(what), places.size(), *places.begin()});
    scene.origin = std::make_shared<Origin>(std::move(origin));
    if (!features.lens) scene.camera.lens_radius = 0;
    for (Material& m : scene.materials)
        if (!features.dispersion) m.glass = nullptr;
    // What moves rests, since the rays have time 0.
    if (lacks_sky) {
        Light sky;
        sky.type = LightType::infinite;
        sky.at = scene.sky_image->at_file;
        sky.L = mean_of(*scene.sky_image);
        scene.lights.push_back(sky);
        scene.sky_image = {};
    }
}

void refuse_delta_lights(const Scene& scene) {
    for (const Light& light : scene.lights)
        if (light.type == LightType::point || light.type == LightType::distant)
            fail(scene.place(light.at),
                 "a point or distant light has no size, so no path can hit it; chapters "
                 "from 09 on sample it");
}
