#include "common/scene/intersect.h"

namespace hit_details {

std::optional<Hit> nearest_kept(const Scene& scene, Ray ray) {
    std::optional<Hit> x = nearest(scene, ray);
    rays_kept->push_back({ray, false, x.has_value(), x ? x->t : infinity});
    return x;
}

bool any_kept(const Scene& scene, Ray ray) {
    bool met = any(scene, ray);
    rays_kept->push_back({ray, true, met, NAN});
    return met;
}

}  // namespace hit_details
