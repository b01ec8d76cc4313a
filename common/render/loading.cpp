#include "common/render/loading.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "common/base/position.h"
#include "common/base/progress.h"
#include "common/base/report.h"
#include "common/scene/coincident.h"
#include "common/scene/mover.h"
#include "common/scene/origin.h"
#include "common/scene/prepare.h"
#include "common/scene/sky_image.h"
#include "common/scene_file/reader.h"
#include "common/scene_file/stand_ins.h"

namespace {

/// Reads the scene, and prints its notes even if an error follows.
Scene load_and_tell(const RenderOptions& options, const Report& report, Progress& progress) {
    struct Notes {
        ~Notes() {
            progress.clear();
            for (const std::string& line : lines) tell(line + "\n");
        }
        Progress& progress;
        std::vector<std::string> lines = {};
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
    return listed(parts, " and ");
}

const std::string lens_here = "a lens, in a chapter without one";
const std::string glass_here = "glass that disperses, in a chapter without it";
const std::string motion_here = "a shape that moves, in a chapter where all rest";
const std::string sky_image_here = "a picture of the sky, in a chapter without one";

/// The mean radiance from all directions.
Rgb mean_of(const SkyImage& sky) {
    double sum[3] = {}, weights = 0;
    for (size_t i = 0; i < sky.pixels.size(); i++) {
        double w = static_cast<double>(solid_angle_per_area(sky, sky.middle_of(i)));
        Rgb L = sky.pixels[i];
        sum[0] += w * double{L.r}, sum[1] += w * double{L.g}, sum[2] += w * double{L.b};
        weights += w;
    }
    return {static_cast<float>(sum[0] / weights), static_cast<float>(sum[1] / weights),
            static_cast<float>(sum[2] / weights)};
}

}  // namespace

Scene load(const RenderOptions& options, Features features) {
    Progress progress(10);
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
    if (options.stand_in) {
        stand_in_for_features(scene, features);
    } else {
        refuse_features(scene, features);
    }
    if (options.width > 0) scene.width = options.width, scene.height = options.height;
    if (options.spp > 0) scene.spp = options.spp;
    if (options.max_depth >= 0) scene.max_depth = options.max_depth;
    size_t prims = scene.geometry.size();
    std::vector<std::string> notes;
    // About, while it is built: 300 bytes for each.
    needing_memory("the hierarchy of " + std::to_string(prims) + " triangles, spheres and disks",
                   300 * prims, [&] {
                       prepare(scene, options.threads, report);
                       if (!options.quiet) notes = notes_of_coincident(scene);
                   });
    progress.clear();
    for (const std::string& note : notes) std::fprintf(stderr, "%s\n", note.c_str());
    return scene;
}

void stand_in_for_features(Scene& scene, Features features) {
    std::map<std::string, UsedStandIn> used;
    auto stand_in = [&](const std::string& what, const Position* at) {
        auto [place, is_new] = used.try_emplace(what, UsedStandIn{what, "", 0, scene.place(at)});
        place->second.places++;
    };
    if (!features.lens && scene.camera.lens_radius > 0) {
        stand_in(lens_here, scene.camera.at);
        scene.camera.lens_radius = 0;
    }
    for (Material& m : scene.materials) {
        if (features.dispersion || m.glass == nullptr) continue;
        stand_in(glass_here, m.at);
        m.glass = nullptr;
    }
    // Their rays have time 0.
    for (const Mover& mover : scene.movers) {
        if (!features.shutter) stand_in(motion_here, mover.at);
    }
    if (!features.sky_image && scene.sky_image) {
        stand_in(sky_image_here, scene.sky_image->at_file);
        Light sky;
        sky.type = LightType::infinite;
        sky.at = scene.sky_image->at_file;
        sky.L = mean_of(*scene.sky_image);
        scene.lights.push_back(sky);
        scene.sky_image = {};
    }
    Origin origin = *scene.origin;
    for (const auto& [what, instead] : all_stand_ins()) {
        auto found = used.find(what);
        if (found == used.end()) continue;
        found->second.instead = instead;
        origin.stand_ins.push_back(found->second);
    }
    scene.origin = std::make_shared<Origin>(std::move(origin));
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
    for (const Light& light : scene.lights) {
        if (light.type != LightType::point && light.type != LightType::distant) continue;
        fail(scene.place(light.at),
             std::string("a ") + (light.type == LightType::point ? "point" : "distant") +
                 " light has no size, so no path can hit it; chapters from 09 on sample it");
    }
}

void refuse_glossy(const Scene& scene) {
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (!is_rough(m)) continue;
        fail(scene.place(m.at), "rough conductors are not supported before chapter 13");
    }
}

void refuse_features(const Scene& scene, Features features) {
    const Camera& camera = scene.camera;
    if (!features.lens && camera.lens_radius > 0) {
        fail(scene.place(camera.at), "only chapters " + chapters_with(&Features::lens) +
                                         " have a lens: lensradius must be 0" +
                                         or_stand_in(lens_here));
    }
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (features.dispersion || m.glass == nullptr) continue;
        char eta[32];
        std::snprintf(eta, sizeof eta, "%.5g", double{m.ior});
        fail(scene.place(m.at), "glass disperses in chapters " +
                                    chapters_with(&Features::dispersion) +
                                    " only: try \"float eta\" " + eta + or_stand_in(glass_here));
    }
    if (!features.shutter && !scene.movers.empty()) {
        fail(scene.place(scene.movers[0].at), "shapes move in chapters " +
                                                  chapters_with(&Features::shutter) + " only" +
                                                  or_stand_in(motion_here));
    }
    if (!features.sky_image && scene.sky_image) {
        fail(scene.place(scene.sky_image->at_file), "the sky has an image in chapters " +
                                                        chapters_with(&Features::sky_image) +
                                                        " only" + or_stand_in(sky_image_here));
    }
}
