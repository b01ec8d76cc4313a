#include "common/results/black_picture.h"

#include <algorithm>

#include "common/base/position.h"
#include "common/light/lights.h"
#include "common/path/sampler.h"
#include "common/results/in_view.h"

namespace {

/// Whether no light and no surface in view face each other.
bool all_face_away(const Scene& scene, const InView& seen) {
    if (scene.sky_image) return false;
    Sampler sampler(SamplerType::independent, 1, 1);
    size_t lights = std::min<size_t>(scene.lights.size(), 64);
    for (uint32_t i = 0; i < seen.points.size(); i++) {
        sampler.start(0, i);
        for (size_t l = 0; l < lights; l++) {
            const Hit& x = seen.points[i].second;
            LightSample y = sample_one_light(scene, l, x, sampler.u2());
            if (y.pdf_w > 0 && dot(y.wi, x.n) > 0) return false;
        }
    }
    return true;
}

/// The place in the scene file that defines the first area light, in brackets.
std::string first_place(const Scene& scene) {
    for (const Light& light : scene.lights) {
        if (light.type == LightType::area && light.at)
            return " (" + printable(place_text(*light.at)) + ")";
    }
    return "";
}

}  // namespace

std::vector<std::string> causes_of_black(const Scene& scene, const RenderOptions& options) {
    std::vector<std::string> causes;
    InView seen = in_view(scene);
    if (!options.paths.empty())
        causes.push_back("--paths keeps no class of path that brings light");
    if (seen.hits == 0) {
        causes.push_back("the camera sees no surface: see its LookAt, fov and Scale");
    } else if (scene.max_depth == 0) {
        causes.push_back("with a depth of 0 only lights themselves are seen, and none is in view");
    } else {
        if (seen.backs == seen.hits) {
            causes.push_back(
                "all that the camera sees it sees from behind: it may be inside something");
        }
        if (seen.mirrors == seen.hits) {
            causes.push_back("the camera sees mirrors and glass alone, and no light in them");
        } else if (seen.mirrors + seen.receivers == 0) {
            causes.push_back("all surfaces in view are black: they reflect nothing");
        } else if (seen.receivers > 0 && all_face_away(scene, seen)) {
            causes.push_back("the lights and all that is in view face away from each other" +
                             first_place(scene) +
                             ": ReverseOrientation turns a light, \"bool twosided\" true lights "
                             "both sides");
        } else {
            causes.push_back(options.search == LightSearch::by_chance
                                 ? "this chapter finds lights only by chance: more samples find "
                                   "them, or a chapter that samples lights (from 09 on)"
                                 : "too few paths find a way from the lights to what is in view: "
                                   "more samples, or a chapter that finds light in another way");
        }
    }
    return causes;
}
