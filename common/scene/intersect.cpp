#include "common/scene/intersect.h"

#include <algorithm>

#include "common/base/ray_count.h"
#include "common/geometry/bvh.h"
#include "common/scene/mover.h"
#include "common/scene/texture.h"

namespace {

/// Turns the normal of what is met edge-on towards the ray, so that no cosine is 0.
[[gnu::noinline]] float tilt(const Ray& ray, Vec3& n) {
    n = normalize(n - 0x1p-20f * normalize(ray.d));
    return dot(ray.d, n);
}

/// Puts x where the ray meets the primitive found, with the normals there, and returns its shape.
const Shape& place_hit(const Scene& scene, const Geometry& g, const Ray& ray, const PrimHit& found,
                       Hit& x) {
    Vec3 p = ray.o + found.t * ray.d;  // on a triangle its weights are more exact
    uint32_t shape = visit(
        g, found.prim,
        [&](const Triangle& tri) {
            Vec3 p0 = g.positions[tri.v[0]], p1 = g.positions[tri.v[1]], p2 = g.positions[tri.v[2]];
            float b0 = 1 - found.b1 - found.b2;
            x.p = b0 * p0 + found.b1 * p1 + found.b2 * p2;
            x.eps = rounding_error(
                max_component(b0 * abs(p0) + found.b1 * abs(p1) + found.b2 * abs(p2)));
            x.n = x.ng = g.facet_normals[found.prim];
            if (!g.normals.empty()) {
                Vec3 n = b0 * g.normals[tri.v[0]] + found.b1 * g.normals[tri.v[1]] +
                         found.b2 * g.normals[tri.v[2]];
                if (dot(n, n) > 0) x.n = normalize(n);
            }
            return tri.shape;
        },
        [&](const Sphere& sphere) {
            x.n = x.ng = normalize(p - sphere.c);
            x.p = sphere.c + sphere.r * x.ng;
            x.eps = rounding_error(max_component(abs(sphere.c)) + sphere.r);
            return sphere.shape;
        },
        [&](const Disk& disk) {
            x.n = x.ng = disk.n;
            x.p = p - dot(p - disk.c, disk.n) * disk.n;
            x.eps = rounding_error(max_component(abs(disk.c)) + disk.r);
            return disk.shape;
        });
    return scene.shapes[shape];
}

/// Turns the normals to the side that the ray came from, and fills in the rest but for the texture.
void finish_hit(const Scene& scene, const Shape& shape, const Ray& ray, const PrimHit& found,
                Hit& x) {
    float away = dot(ray.d, x.ng);
    if (away == 0) [[unlikely]]
        away = tilt(ray, x.ng);
    x.front = away < 0;
    if (shape.reverse) x.front = !x.front;
    if (away > 0) x.ng = -x.ng;
    if (dot(x.n, x.ng) < 0) x.n = -x.n;
    if (dot(ray.d, x.n) >= 0) x.n = x.ng;  // a smoothed normal that looks away cannot be used

    x.t = found.t;
    x.time = ray.time;
    x.material = &scene.materials[shape.material];
    x.light = shape.light;
    x.prim = found.prim;
}

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

/// The normal of the mesh at p, a point of this primitive, of any length; 0 where there is none.
Vec3 interpolated_normal(const Geometry& g, uint32_t prim, Vec3 p) {
    if (g.normals.empty() || prim >= g.triangles.size()) return {};
    const auto& v = g.triangles[prim].v;
    Vec3 n0 = g.normals[v[0]], n1 = g.normals[v[1]], n2 = g.normals[v[2]];
    if (n0 == Vec3{} && n1 == n0 && n2 == n0) return {};
    Vec3 p0 = g.positions[v[0]], e1 = g.positions[v[1]] - p0, e2 = g.positions[v[2]] - p0;
    Vec3 area = cross(e1, e2);
    float b1 = dot(cross(p - p0, e2), area) / dot(area, area);
    float b2 = dot(cross(e1, p - p0), area) / dot(area, area);
    return (1 - b1 - b2) * n0 + b1 * n1 + b2 * n2;
}

/// intersect() with movers, or where rays are kept: x becomes what is met first at the ray's time.
[[gnu::noinline]] void intersect_more(const Scene& scene, const Ray& ray, std::optional<Hit>& x) {
    Ray rest = ray;
    if (x) rest.t_max = x->t;
    for (const auto& mover : scene.movers) {
        if (!meets(rest, mover->box.low, mover->box.high)) continue;
        Transform world_from_start = mover->world_from_start(static_cast<double>(ray.time));
        Ray back = carried_back(*mover, rest, world_from_start);
        PrimHit found = closest_hit(*mover->bvh, mover->geometry, back);
        if (found.prim == PrimHit::none) continue;
        x.emplace();
        const Shape& shape = place_hit(scene, mover->geometry, back, found, *x);
        x->material = &scene.materials[shape.material];
        if (x->material->texture != 0) look_up_texture(scene, mover->geometry, found, *x);
        carry_on(world_from_start, *x);
        rest.t_max = found.t;
        found.prim += mover->first_prim;
        finish_hit(scene, shape, rest, found, *x);
    }
    if (rays_kept) rays_kept->push_back({ray, false, x.has_value(), x ? x->t : infinity});
}

/// occluded() with movers, or where rays are kept.
[[gnu::noinline]] bool occluded_more(const Scene& scene, const Ray& ray) {
    bool met = any_hit(*scene.bvh, scene.geometry, ray);
    for (const auto& mover : scene.movers) {
        if (met || !meets(ray, mover->box.low, mover->box.high)) continue;
        Transform world_from_start = mover->world_from_start(static_cast<double>(ray.time));
        met = any_hit(*mover->bvh, mover->geometry, carried_back(*mover, ray, world_from_start));
    }
    if (rays_kept) rays_kept->push_back({ray, true, met, NAN});
    return met;
}

}  // namespace

void make_hit(const Scene& scene, const Ray& ray, const PrimHit& found, Hit& x) {
    finish_hit(scene, place_hit(scene, scene.geometry, ray, found, x), ray, found, x);
    if (scene.textures && x.material->texture != 0)
        look_up_texture(scene, scene.geometry, found, x);
}

[[gnu::flatten]] std::optional<Hit> intersect(const Scene& scene, const Ray& ray) {
    rays_traced++;
    PrimHit found = closest_hit(*scene.bvh, scene.geometry, ray);
    std::optional<Hit> x;
    if (found.prim != PrimHit::none) make_hit(scene, ray, found, x.emplace());
    if (scene.moves || rays_kept) [[unlikely]]
        intersect_more(scene, ray, x);
    return x;
}

bool occluded(const Scene& scene, const Ray& ray) {
    rays_traced++;
    bool more = scene.moves || rays_kept;
    return more ? occluded_more(scene, ray) : any_hit(*scene.bvh, scene.geometry, ray);
}

Vec3 mesh_normal(const Scene& scene, const Hit& x) {
    const Mover* mover = nullptr;
    for (const auto& each : scene.movers)
        if (x.prim >= each->first_prim) mover = each.get();
    Vec3 n;
    if (!mover) n = interpolated_normal(scene.geometry, x.prim, x.p);
    if (mover) {
        Transform t = mover->world_from_start(static_cast<double>(x.time));
        Vec3 back = to_vec3(transform_point(inverse(t), Vec3d(x.p)));
        uint32_t prim = x.prim - mover->first_prim;
        n = to_vec3(transform_normal(t, Vec3d(interpolated_normal(mover->geometry, prim, back))));
    }
    if (!(dot(n, n) > 0)) return x.ng;
    n = normalize(n);
    return dot(n, x.ng) < 0 ? -n : n;
}
