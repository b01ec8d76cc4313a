#include "common/light/light_shapes.h"

#include "common/light/solid_angle.h"
#include "common/scene/prepare.h"

namespace {

/// The light's primitive number `index`.
Emitter emitter_of(const Scene& scene, size_t light, uint32_t index) {
    if (index == 0) return scene.light_shapes[light].first;
    return emitter_of(scene, scene.lights[light].first_prim + index);
}

Vec3d unit(Vec3d a) { return (1 / std::sqrt(dot(a, a))) * a; }

/// Chooses a primitive of the light in proportion to its area; u is then rescaled to [0,1).
uint32_t choose_by_area(const LightShape& shape, float& u) {
    if (shape.area_up_to.empty()) return 0;
    float target = u * shape.area;
    auto found = std::upper_bound(shape.area_up_to.begin(), shape.area_up_to.end() - 1, target);
    auto i = found - shape.area_up_to.begin();
    float before = i > 0 ? *(found - 1) : 0;
    u = std::clamp((target - before) / (*found - before), 0.0f, 0x1.fffffep-1f);
    return static_cast<uint32_t>(i);
}

/// sin^2 of the half angle of the cone in which x sees a sphere; 1 for inside and other shapes.
float sin2_of_cone(const LightShape& shape, Vec3 x) {
    const Emitter& e = shape.first;
    bool one_sphere = e.kind == Emitter::sphere && !e.inward && shape.area_up_to.empty();
    float d2 = length_squared(x - e.p0), touching = e.r + e.eps;
    if (!one_sphere || d2 <= touching * touching) return 1;
    return std::max(e.r * e.r / d2, 1 / densest);
}

/// Samples a direction of the cone in which x sees the sphere; returns the point seen there.
LightPoint sample_sphere(const Emitter& e, Vec3 x, float sin2, Vec2 u) {
    Vec3 to_centre = e.p0 - x, w = sample_cone(sin2, u);
    float d2 = length_squared(to_centre), d = std::sqrt(d2);
    // Where the ray enters the sphere: from sines, which lose no digits for a narrow cone.
    float sin2_y = std::min((w.x * w.x + w.y * w.y) / sin2, 1.0f), cos_y = std::sqrt(1 - sin2_y);
    float t = (d2 - e.r * e.r) / (d * w.z + e.r * cos_y);
    Frame frame(to_centre / d);
    Vec3 n = {t / e.r * w.x, t / e.r * w.y, -(w.z * cos_y + sin2_y * e.r / d)};
    float eps = e.eps + rounding_error(d);  // rounding errors of t and of the direction
    return {x + t * frame.to_world(w), frame.to_world(n), eps, pdf_cone(sin2)};
}

/// A triangle, or a quadrangle of two triangles, to sample directions from.
struct Plan {
    Emitter e;             // the primitive, or the first of two
    Vec3d p[4], w[4];      // corners relative to x, in order; w: unit
    double omega[2] = {};  // sr: of the triangles of corners 0 1 2 and 0 3 2
    float pdf = 0;         // sr^-1; 0: by area, where directions are not possible or not needed
};

/// The corners of a disk's bounding square, relative to x; c: its centre, relative to x. One side
/// faces x, so that an x in the disk's plane beside the disk is also beside the square.
void put_square_around(const Emitter& e, Vec3d c, Vec3d (&p)[4]) {
    Vec3d n = unit(Vec3d(e.n)), away = c - dot(c, n) * n;
    bool beside = dot(away, away) > 1e-12 * dot(c, c);
    Vec3d s = beside ? unit(away) : Vec3d(Frame(e.n).s), t = cross(n, s);
    s = double{e.r} * s, t = double{e.r} * t;
    p[0] = c - s - t, p[1] = c + s - t, p[2] = c + s + t, p[3] = c - s + t;
}

/// Chooses how to sample the whole light, or primitive number `index` of a larger mesh.
///
/// Coordinates relative to x, in double: shapes that are near or seen edge-on lose no digits.
Plan plan(const Scene& scene, size_t light, Vec3 x, uint32_t index) {
    const LightShape& shape = scene.light_shapes[light];
    Plan plan;
    if (!light_shape_details::is_near(shape, x)) return plan;
    const Emitter& e = plan.e = emitter_of(scene, light, index);
    float eps = e.off_plane + rounding_error(dot(abs(e.n), abs(x)));
    if (std::abs(dot(e.n, e.p0 - x)) <= eps) return plan;  // on the light

    auto from_x = [&](Vec3 p) { return Vec3d(p) - Vec3d(x); };
    auto &p = plan.p, &w = plan.w;
    size_t corners = 4;
    float share = 1;  // the probability of sampling this piece
    if (shape.parallelogram) {
        for (size_t i = 0; i < 4; i++) p[i] = from_x(shape.corners[i]);
    } else if (e.kind == Emitter::disk && scene.lights[light].prims == 1) {
        put_square_around(e, from_x(e.p0), p);
    } else if (e.kind == Emitter::triangle) {
        p[0] = from_x(e.p0), p[1] = from_x(e.p1), p[2] = from_x(e.p2);
        share = area_of(e) / shape.area;
        corners = 3;
    } else {
        return plan;
    }
    for (size_t i = 0; i < corners; i++) w[i] = unit(p[i]);
    plan.omega[0] = triangle_solid_angle(w[0], w[1], w[2]);
    if (corners == 4) plan.omega[1] = triangle_solid_angle(w[0], w[3], w[2]);
    double omega = plan.omega[0] + plan.omega[1];
    if (omega > 0) plan.pdf = std::min(static_cast<float>(double{share} / omega), densest);
    return plan;
}

/// The point, relative to x, in a direction sampled from a plan's triangles.
Vec3d sample_seen(const Plan& plan, Vec2 u) {
    // Choose one of two by its solid angle; its corners are 0 1 2 or 0 3 2.
    float first = static_cast<float>(plan.omega[0] / (plan.omega[0] + plan.omega[1]));
    size_t i = u.x < first ? 1 : 3;
    u.x = u.x < first ? u.x / first : (u.x - first) / (1 - first);
    u.x = std::min(u.x, 0x1.fffffep-1f);

    const auto &p = plan.p, &w = plan.w;
    Vec3d to_y = sample_spherical_triangle(w[0], w[i], w[2], plan.omega[i / 2], u);
    Vec3d n = cross(p[i] - p[0], p[2] - p[0]);
    return dot(n, p[0]) / dot(n, to_y) * to_y;
}

}  // namespace

float pdf_area(const Scene& scene, size_t light) { return 1 / scene.light_shapes[light].area; }

LightPoint light_shape_details::sample_pieces(const Scene& scene, size_t light, Vec2 u) {
    const LightShape& shape = scene.light_shapes[light];
    if (!(shape.area > 0)) return {};
    float pdf = 1 / shape.area;
    Emitter e = emitter_of(scene, light, choose_by_area(shape, u.x));
    switch (e.kind) {
        case Emitter::triangle: {
            float s = std::sqrt(u.x);
            Vec3 p = (1 - s) * e.p0 + s * (1 - u.y) * e.p1 + s * u.y * e.p2;
            return {p, e.n, e.eps, pdf};
        }
        case Emitter::sphere: {
            float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z));
            Vec3 n = from_cylindrical(r, u.y, z);
            return {e.p0 + e.r * n, e.inward ? -n : n, e.eps, pdf};
        }
        case Emitter::disk: {
            Vec3 to_p = from_cylindrical(e.r * std::sqrt(u.x), u.y, 0);
            return {e.p0 + Frame(e.n).to_world(to_p), e.n, e.eps, pdf};
        }
    }
    return {};
}

LightPoint light_shape_details::sample_near(const Scene& scene, size_t light, Vec3 x, Vec2 u) {
    const LightShape& shape = scene.light_shapes[light];
    if (!(shape.area > 0)) return {};
    if (float sin2 = sin2_of_cone(shape, x); sin2 < 1)
        return sample_sphere(shape.first, x, sin2, u);
    Vec2 v = u;
    uint32_t index = shape.parallelogram ? 0 : choose_by_area(shape, v.x);
    Plan way = plan(scene, light, x, index);
    if (way.pdf == 0) {
        LightPoint y = sample_area(scene, light, u);
        y.pdf = area_to_solid_angle(y.pdf, x, y.p, y.n);
        return y;
    }
    Vec3 y = x + to_vec3(sample_seen(way, v));
    bool beside = length_squared(y - way.e.p0) > way.e.r * way.e.r;
    if (way.e.kind == Emitter::disk && beside) return {};
    return {y, way.e.n, way.e.eps, way.pdf};
}

float pdf_solid_angle(const Scene& scene, size_t light, Vec3 x, const Hit& y) {
    const LightShape& shape = scene.light_shapes[light];
    if (float sin2 = sin2_of_cone(shape, x); sin2 < 1) return pdf_cone(sin2);
    uint32_t index = shape.parallelogram ? 0 : y.prim - scene.lights[light].first_prim;
    Plan way = plan(scene, light, x, index);
    if (way.pdf == 0) return area_to_solid_angle(1 / shape.area, x, y.p, y.ng);
    return way.pdf;
}
