// The tests of a ray against each kind of primitive, and against all of them in turn: the formulas
// of chapter 05, made safe against rounding.
#pragma once
#include <optional>

#include "common/geometry/geometry.h"

/// What a triangle test returns: the distance, and the weights of the second and third vertex.
struct TriangleHit {
    float t, b1, b2;
};

/// The shear that turns a ray into the z axis, worked out once for a ray and used on every
/// triangle.
struct Shear {
    int kx, ky, kz;  // kz: the axis along which d is longest
    float sx, sy, sz;
};

inline Shear shear_to_ray(const Vec3& d) {
    Vec3 size = abs(d);
    int kz = 0;
    if (size.y >= size.x) kz = 1;
    if (size.z >= std::max(size.x, size.y)) kz = 2;
    int kx = (kz + 1) % 3, ky = (kz + 2) % 3;
    return {kx, ky, kz, d[kx] / d[kz], d[ky] / d[kz], 1 / d[kz]};
}

/// Where the line of the ray meets the plane of the triangle p0 p1 p2: t and the weights.
///
///   o + t d = p0 + b1 (p1 - p0) + b2 (p2 - p0), by Cramer's rule, with n = (p1 - p0) x (p2 - p0):
///   t = n.(p0 - o) / n.d
///
/// In double precision: in float, t is off by as much as 1e-6 (longest side)^2 / height, so that a
/// ray would meet the long thin triangle that it leaves. Seen edge-on n.d is 0: infinity or NaN.
/// source  Moeller, Trumbore 1997      tested by  "truth: every hit as in double precision"
inline TriangleHit meet_plane(const Ray& ray, Vec3 p0, Vec3 p1, Vec3 p2) {
    Vec3d d(ray.d), corner(p0);
    Vec3d side1 = Vec3d(p1) - corner, side2 = Vec3d(p2) - corner, from = Vec3d(ray.o) - corner;
    Vec3d across = cross(d, side2), up = cross(from, side1);
    double inverse = 1 / dot(side1, across);
    return {static_cast<float>(dot(side2, up) * inverse),
            static_cast<float>(dot(from, across) * inverse),
            static_cast<float>(dot(d, up) * inverse)};
}

/// Whether the weights are those of a point of the triangle, or of one very near to it.
inline bool is_within(const TriangleHit& hit) {
    constexpr float slack = -1e-3f;
    return hit.b1 >= slack && hit.b2 >= slack && 1 - hit.b1 - hit.b2 >= slack;
}

/// Where the ray meets the triangle p0 p1 p2, from either side, edges and corners included.
///
///   shear space so that the ray is the z axis; e_i = signed area of the origin with edge i;
///   hit when no two e_i differ in sign; t from the plane
///
/// Watertight: each corner is sheared once, and the sign of a difference of two rounded products
/// is either right or 0, so that two triangles cannot both lose a ray on the edge they share.
/// A triangle of which the ray sees next to nothing may have its e_i by rounding alone, wherever it
/// is: so it is met only if the ray passes within its box, and t is that of one of its points.
/// NaN or a triangle seen exactly edge-on: no hit.
/// source  Woop, Benthin, Wald 2013      tested by  "brute: no ray leaks through a closed mesh"
inline std::optional<TriangleHit> intersect_triangle(const Ray& ray, const Shear& shear, Vec3 p0,
                                                     Vec3 p1, Vec3 p2) {
    auto [kx, ky, kz, sx, sy, sz] = shear;
    Vec3 a = p0 - ray.o, b = p1 - ray.o, c = p2 - ray.o;
    float ax = a[kx] - sx * a[kz], ay = a[ky] - sy * a[kz];
    float bx = b[kx] - sx * b[kz], by = b[ky] - sy * b[kz];
    float cx = c[kx] - sx * c[kz], cy = c[ky] - sy * c[kz];
    float e0 = cx * by - cy * bx, e1 = ax * cy - ay * cx, e2 = bx * ay - by * ax;
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return {};
    TriangleHit hit = meet_plane(ray, p0, p1, p2);
    if (!is_within(hit)) {
        auto [x_low, x_high] = std::minmax({ax, bx, cx});
        auto [y_low, y_high] = std::minmax({ay, by, cy});
        auto [t_low, t_high] = std::minmax({a[kz] * sz, b[kz] * sz, c[kz] * sz});
        bool in_box = x_low <= 0 && x_high >= 0 && y_low <= 0 && y_high >= 0;
        if (!(in_box && hit.t > 0 && hit.t < infinity)) return {};
        float det = e0 + e1 + e2;
        hit = {std::clamp(hit.t, t_low, t_high), e1 / det, e2 / det};
    }
    if (!(hit.t > 0 && hit.t < ray.t_max && hit.b1 >= -1)) return {};  // NaN: no hit
    return hit;
}

/// The nearest t at which the ray meets the sphere from outside or from inside.
///
///   |o + t d - c|^2 = r^2, with the discriminant taken from the point of the line that is nearest
///   to the centre, and in double precision: a ball of a billionth of its distance is still met.
///
/// source  Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection"
inline std::optional<float> intersect_sphere(const Ray& ray, Vec3 c, float r) {
    Vec3d d(ray.d), f = Vec3d(ray.o) - Vec3d(c);
    double a = dot(d, d), b = -dot(f, d), r2 = double{r} * double{r};
    Vec3d nearest = f + (b / a) * d;
    double discriminant = r2 - dot(nearest, nearest);
    if (!(discriminant >= 0)) return {};
    double q = b + std::copysign(std::sqrt(a * discriminant), b);
    double t0 = (dot(f, f) - r2) / q, t1 = q / a;
    if (t0 > t1) std::swap(t0, t1);
    auto t = static_cast<float>(t0 > 0 ? t0 : t1);
    if (!(t > 0 && t < ray.t_max)) return {};
    return t;
}

/// Where the ray crosses the disk of radius r around c with normal n.
inline std::optional<float> intersect_disk(const Ray& ray, Vec3 c, Vec3 n, float r) {
    float t = dot(n, c - ray.o) / dot(n, ray.d);
    if (!(t > 0 && t < ray.t_max)) return {};
    if (!(length_squared(ray.o + t * ray.d - c) <= r * r)) return {};
    return t;
}

/// Where the ray meets one primitive; PrimHit::none where it does not.
inline PrimHit intersect_primitive(const Geometry& g, uint32_t prim, const Ray& ray,
                                   const Shear& shear) {
    auto at = [&](std::optional<float> t) { return t ? PrimHit{prim, *t} : PrimHit{}; };
    return visit(
        g, prim,
        [&](const Triangle& triangle) {
            auto [a, b, c] = triangle.v;
            auto hit =
                intersect_triangle(ray, shear, g.positions[a], g.positions[b], g.positions[c]);
            return hit ? PrimHit{prim, hit->t, hit->b1, hit->b2} : PrimHit{};
        },
        [&](const Sphere& s) { return at(intersect_sphere(ray, s.c, s.r)); },
        [&](const Disk& d) { return at(intersect_disk(ray, d.c, d.n, d.r)); });
}

/// Tests every primitive in turn: the slow and certain way, which every hierarchy must agree with.
/// Of two hits at the same t the lower number wins.
inline PrimHit linear_scan(const Geometry& g, Ray ray) {
    PrimHit best;
    Shear shear = shear_to_ray(ray.d);
    for (uint32_t prim = 0, end = g.size(); prim < end; prim++) {
        PrimHit hit = intersect_primitive(g, prim, ray, shear);
        if (hit.prim == PrimHit::none) continue;
        best = hit;
        ray.t_max = hit.t;
    }
    return best;
}
