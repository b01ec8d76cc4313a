#include "common/light/light_shapes.h"

#include "common/light/solid_angle.h"

using light_shape_details::is_near;

namespace {

/// The light's primitive number `index`.
Emitter emitter_of(const Scene& scene, size_t light, uint32_t index) {
    if (index == 0) return scene.light_shapes[light].first;
    return emitter_of(scene, scene.lights[light].first_prim + index);
}

LightPoint sample_emitter_area(const Emitter& e, Vec2 u) {
    switch (e.kind) {
        case Emitter::triangle: {
            float s = std::sqrt(u.x);
            Vec3 p = (1 - s) * e.p0 + s * (1 - u.y) * e.p1 + s * u.y * e.p2;
            return {p, e.n, e.eps, 1};
        }
        case Emitter::sphere: {
            float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z));
            Vec3 n = from_cylindrical(r, u.y, z);
            return {e.p0 + e.r * n, e.inward ? -n : n, e.eps, 1};
        }
        case Emitter::disk: {
            Vec3 to_p = from_cylindrical(e.r * std::sqrt(u.x), u.y, 0);
            return {e.p0 + Frame(e.n).to_world(to_p), e.n, e.eps, 1};
        }
    }
    return {};
}

/// Corners of a triangle as seen from x.
struct Seen {
    Vec3 a, b, c;
    float omega;
};

Seen see(Vec3 x, Vec3 p0, Vec3 p1, Vec3 p2) {
    Vec3 a = normalize(p0 - x), b = normalize(p1 - x), c = normalize(p2 - x);
    return {a, b, c, triangle_solid_angle(a, b, c)};
}

/// Below this, a spherical triangle is too thin to be sampled in float: taken by area instead.
constexpr float thinnest = 1e-4f;

/// The point of the plane of e that lies from x in a direction drawn from the spherical triangle.
Vec3 sample_seen(const Emitter& e, const Seen& seen, Vec3 x, Vec2 u) {
    Vec3 w = sample_spherical_triangle(seen.a, seen.b, seen.c, seen.omega, u);
    return x + dot(e.n, e.p0 - x) / dot(e.n, w) * w;
}

/// The number of the primitive under u of the light's running areas; u is stretched to [0,1) anew.
uint32_t choose_by_area(const LightShape& shape, float& u) {
    if (shape.area_up_to.empty()) return 0;
    float target = u * shape.area;
    auto found = std::upper_bound(shape.area_up_to.begin(), shape.area_up_to.end() - 1, target);
    auto i = found - shape.area_up_to.begin();
    float before = i > 0 ? *(found - 1) : 0;
    u = std::clamp((target - before) / (*found - before), 0.0f, 0x1.fffffep-1f);
    return static_cast<uint32_t>(i);
}

/// The two halves of a disk's bounding square, as triangles.
std::array<std::array<Vec3, 3>, 2> square_around(const Emitter& e) {
    Frame frame(e.n);
    Vec3 s = e.r * frame.s, t = e.r * frame.t;
    Vec3 a = e.p0 - s - t, b = e.p0 + s - t, c = e.p0 + s + t, d = e.p0 - s + t;
    return {{{a, b, c}, {a, c, d}}};
}

/// Draws from two spherical triangles together as from one piece.
LightPoint sample_two(const Emitter& e, const Seen& first, const Seen& second, Vec3 x, Vec2 u) {
    float omega = first.omega + second.omega, share = first.omega / omega;
    const Seen& chosen = u.x < share ? first : second;
    u.x = u.x < share ? u.x / share : (u.x - share) / (1 - share);
    u.x = std::min(u.x, 0x1.fffffep-1f);
    return {sample_seen(e, chosen, x, u), e.n, e.eps, 1 / omega};
}

/// How x can draw from the light by solid angle; `area` where it cannot, or need not.
enum class Way : uint8_t { area, two, square, one };

struct Plan {
    Way way = Way::area;
    Emitter e;  // the primitive, or the first of two
    Seen seen[2];
};

/// Chooses the way for the light as a whole, or for one primitive (`index`) of a larger mesh.
Plan plan(const Scene& scene, size_t light, Vec3 x, uint32_t index) {
    const Light& l = scene.lights[light];
    const LightShape& shape = scene.light_shapes[light];
    Plan plan{Way::area, emitter_of(scene, light, index), {}};
    float off_plane = std::abs(dot(plan.e.n, plan.e.p0 - x));
    float eps = plan.e.eps + rounding_error(max_component(abs(x)));
    if (!is_near(shape, x) || off_plane <= eps) return plan;  // far away, or edge-on
    auto look = [&](size_t i, Vec3 p0, Vec3 p1, Vec3 p2) { plan.seen[i] = see(x, p0, p1, p2); };
    if (shape.parallelogram) {
        Vec3 p = shape.corner + shape.e1, q = shape.corner + shape.e2;
        look(0, shape.corner, p, q), look(1, p + shape.e2, q, p);
        if (std::min(plan.seen[0].omega, plan.seen[1].omega) > thinnest) plan.way = Way::two;
    } else if (plan.e.kind == Emitter::disk && l.prims == 1) {
        auto square = square_around(plan.e);
        for (size_t i = 0; i < 2; i++) look(i, square[i][0], square[i][1], square[i][2]);
        if (std::min(plan.seen[0].omega, plan.seen[1].omega) > thinnest) plan.way = Way::square;
    } else if (plan.e.kind == Emitter::triangle) {
        look(0, plan.e.p0, plan.e.p1, plan.e.p2);
        if (plan.seen[0].omega > thinnest) plan.way = Way::one;
    }
    return plan;
}

}  // namespace

float pdf_area(const Scene& scene, size_t light) { return 1 / scene.light_shapes[light].area; }

LightPoint light_shape_details::sample_pieces(const Scene& scene, size_t light, Vec2 u) {
    const LightShape& shape = scene.light_shapes[light];
    if (!(shape.area > 0)) return {};
    uint32_t i = choose_by_area(shape, u.x);
    LightPoint y = sample_emitter_area(emitter_of(scene, light, i), u);
    y.pdf = 1 / shape.area;
    return y;
}

LightPoint light_shape_details::sample_sphere(const Emitter& e, Vec3 x, float sin2, Vec2 u) {
    Vec3 to_centre = e.p0 - x, w = sample_cone(sin2, u);
    float d = length(to_centre), sin2_w = std::max(0.0f, 1 - w.z * w.z);
    float t = d * w.z - std::sqrt(std::max(0.0f, e.r * e.r - d * d * sin2_w));
    Vec3 n = normalize(x + t * Frame(to_centre / d).to_world(w) - e.p0);
    return {e.p0 + e.r * n, n, e.eps, pdf_cone(sin2)};
}

LightPoint light_shape_details::sample_near(const Scene& scene, size_t light, Vec3 x, Vec2 u) {
    const LightShape& shape = scene.light_shapes[light];
    if (!(shape.area > 0)) return {};
    Vec2 v = u;
    uint32_t index = shape.parallelogram ? 0 : choose_by_area(shape, v.x);
    Plan way = plan(scene, light, x, index);
    switch (way.way) {
        case Way::area: return sample_far(scene, light, x, u);
        case Way::two: return sample_two(way.e, way.seen[0], way.seen[1], x, u);
        case Way::square: {
            LightPoint y = sample_two(way.e, way.seen[0], way.seen[1], x, u);
            if (length_squared(y.p - way.e.p0) > way.e.r * way.e.r) y.pdf = 0;
            return y;
        }
        case Way::one: {
            float share = area_of(way.e) / shape.area;
            return {sample_seen(way.e, way.seen[0], x, v), way.e.n, way.e.eps,
                    share / way.seen[0].omega};
        }
    }
    return {};
}

float pdf_solid_angle(const Scene& scene, size_t light, Vec3 x, const Hit& y) {
    const LightShape& shape = scene.light_shapes[light];
    if (float sin2 = light_shape_details::sin2_of_cone(shape, x); sin2 < 1) return pdf_cone(sin2);
    uint32_t index = shape.parallelogram ? 0 : y.prim - scene.lights[light].first_prim;
    Plan way = plan(scene, light, x, index);
    switch (way.way) {
        case Way::area: return area_to_solid_angle(1 / shape.area, x, y.p, y.ng);
        case Way::two:
        case Way::square: return 1 / (way.seen[0].omega + way.seen[1].omega);
        case Way::one: return area_of(way.e) / shape.area / way.seen[0].omega;
    }
    return 0;
}
