#include "common/scene/mover.h"

#include <algorithm>

#include "common/geometry/bvh.h"
#include "common/scene/smooth_normal.h"

namespace {

/// Whether the ray comes through the box before t_max.
bool meets(const Ray& ray, Vec3 low, Vec3 high) {
    float near = 0, far = ray.t_max;
    for (int axis = 0; axis < 3; axis++) {
        float inv = 1 / ray.d[axis];
        float a = (low[axis] - ray.o[axis]) * inv, b = (high[axis] - ray.o[axis]) * inv;
        near = std::max(near, std::min(a, b));  // NaN, on a face: leaves near and far alone
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

/// The ray as the mover sees it, whose primitives stay where they are at time 0.
Ray carried_back(const Mover& mover, const Ray& ray, const Transform& world_from_start) {
    Transform back = inverse(world_from_start);
    return {to_vec3(transform_point(back, Vec3d(ray.o))),
            to_vec3(transform_vector(back, Vec3d(ray.d))), ray.t_max, ray.time,
            ray.from - mover.first_prim};
}

/// What was met, carried to where it is at the ray's time.
void carry_on(const Transform& t, Hit& x) {
    float before = max_component(abs(x.p));
    x.p = to_vec3(transform_point(t, Vec3d(x.p)));
    x.n = to_vec3(normalize(transform_normal(t, Vec3d(x.n))));
    x.ng = to_vec3(normalize(transform_normal(t, Vec3d(x.ng))));
    double stretch = std::max({length(t.x), length(t.y), length(t.z)});
    x.eps = static_cast<float>(stretch) * (x.eps + rounding_error(before)) +
            rounding_error(max_component(abs(x.p)));
}

Vec3 interpolated_normal(const Geometry& g, uint32_t prim, Vec3 p) {
    if (g.normals.empty() || prim >= g.triangles.size()) return {};
    const auto& v = g.triangles[prim].v;
    Vec3 p0 = g.positions[v[0]], e1 = g.positions[v[1]] - p0, e2 = g.positions[v[2]] - p0;
    Vec3 area = cross(e1, e2);
    float b1 = dot(cross(p - p0, e2), area) / dot(area, area);
    float b2 = dot(cross(e1, p - p0), area) / dot(area, area);
    return (1 - b1 - b2) * g.normals[v[0]] + b1 * g.normals[v[1]] + b2 * g.normals[v[2]];
}

/// Replaces x by what the ray meets first among the movers, where that is nearer, at its time.
void intersect_movers(const Scene& scene, const Ray& ray, std::optional<Hit>& x) {
    Ray rest = ray;
    if (x) rest.t_max = x->t;
    for (const Mover& mover : scene.movers) {
        if (!meets(rest, mover.box.low, mover.box.high)) continue;
        Transform world_from_start = mover.world_from_start(static_cast<double>(ray.time));
        Ray back = carried_back(mover, rest, world_from_start);
        PrimHit found = closest_hit(*mover.bvh, mover.geometry, back);
        if (found.prim == PrimHit::none) continue;
        x.emplace();
        const Shape& shape = place_hit(scene, mover.geometry, back, found, *x);
        x->material = &scene.materials[shape.material];
        if (x->material->texture != 0) look_up_texture(scene, mover.geometry, found, *x);
        carry_on(world_from_start, *x);
        rest.t_max = found.t;
        found.prim += mover.first_prim;
        finish_hit(scene, shape, rest, found, *x);
    }
}

}  // namespace

Box box_over_time(const Mover& mover) {
    // Where the corners of its box come to: along straight lines, or somewhere on a sphere, since
    // turning keeps a point at its distance from the object's origin, which goes straight.
    Box box = bounds_of(mover.geometry);
    Vec3d low = {1e30, 1e30, 1e30}, high = -1 * low;
    auto add = [&](Vec3d p, double r) {
        for (size_t i = 0; i < 3; i++) {
            low[i] = std::min(low[i], p[i] - r), high[i] = std::max(high[i], p[i] + r);
        }
    };
    Vec3d origins[] = {mover.motion.at(0).o, mover.motion.at(1).o};
    for (int corner = 0; corner < 8; corner++) {
        Vec3d p =
            Vec3d(Vec3{corner & 1 ? box.low.x : box.high.x, corner & 2 ? box.low.y : box.high.y,
                       corner & 4 ? box.low.z : box.high.z});
        for (int end = 0; end < 2; end++) {
            Vec3d moved = transform_point(mover.world_from_start(end), p);
            double r = length(moved - origins[end]);
            if (!mover.motion.turns()) add(moved, 0);
            if (mover.motion.turns()) add(origins[0], r), add(origins[1], r);
        }
    }
    for (size_t i = 0; i < 3; i++) {
        double slack =
            1e-5 * (high[i] - low[i]) + 1e-6 * std::max(std::abs(high[i]), std::abs(low[i]));
        box.low[static_cast<int>(i)] = static_cast<float>(low[i] - slack);
        box.high[static_cast<int>(i)] = static_cast<float>(high[i] + slack);
    }
    return box;
}

Vec3 interpolated_normal(const Scene& scene, uint32_t prim, Vec3 p, float time) {
    if (prim < scene.geometry.size()) return interpolated_normal(scene.geometry, prim, p);
    auto behind = std::upper_bound(
        scene.movers.begin(), scene.movers.end(), prim,
        [](uint32_t number, const Mover& mover) { return number < mover.first_prim; });
    const Mover& mover = behind[-1];
    Transform world_from_start = mover.world_from_start(static_cast<double>(time));
    Vec3 back = to_vec3(transform_point(inverse(world_from_start), Vec3d(p)));
    Vec3 n = interpolated_normal(mover.geometry, prim - mover.first_prim, back);
    return to_vec3(transform_normal(world_from_start, Vec3d(n)));
}

namespace hit_details {

void vary_or_move(const Scene& scene, const Ray& ray, const PrimHit& found, std::optional<Hit>& x) {
    if (x && x->material->texture != 0) look_up_texture(scene, scene.geometry, found, *x);
    intersect_movers(scene, ray, x);
}

bool occluded_by_movers(const Scene& scene, const Ray& ray) {
    for (const Mover& mover : scene.movers) {
        if (!meets(ray, mover.box.low, mover.box.high)) continue;
        Transform world_from_start = mover.world_from_start(static_cast<double>(ray.time));
        if (any_hit(*mover.bvh, mover.geometry, carried_back(mover, ray, world_from_start)))
            return true;
    }
    return false;
}

}  // namespace hit_details
