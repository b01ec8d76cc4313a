// Chapter 05: ray casting, and Whitted's ray tracing: what one ray from the eye can find out.
//
//   L = Le + sum over lamps of  f I cos / r^2 V     (diffuse: one shadow ray for each lamp)
//   L = Le + R L(reflected) + (1 - R) / eta^2 L(refracted)     (mirror and glass: every branch)
#pragma once
#include <optional>

#include "common/base/ray_count.h"
#include "common/material/hit.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

namespace ch05 {

/// The camera made ready for one picture size: film point (px, py), in pixels from the top left,
/// is seen along corner + px dx + py dy.
struct CameraView {
    Vec3 o, corner, dx, dy;
};

/// Lays the film at distance 1 in front of the camera.
///
///   half the shorter side = tan(fov / 2);  the longer side is as much longer as the picture's
///
/// source  pbrt-v4's "perspective" camera: left-handed, x right, y up, z forward
inline CameraView camera_view(const Camera& camera, int width, int height) {
    float aspect =
        camera.frame_aspect.value_or(static_cast<float>(width) / static_cast<float>(height));
    std::array<float, 4> window = {-1, 1, -1, 1};
    if (aspect > 1) window = {-aspect, aspect, -1, 1};
    if (aspect < 1) window = {-1, 1, -1 / aspect, 1 / aspect};
    auto [x0, x1, y0, y1] = camera.screen_window.value_or(window);

    float half = static_cast<float>(std::tan(double{camera.fov * pi / 360}));
    Vec3 right = half * camera.right, up = half * camera.up;
    return {camera.o, camera.forward + x0 * right + y1 * up,
            (x1 - x0) / static_cast<float>(width) * right,
            (y0 - y1) / static_cast<float>(height) * up};
}

/// The ray from the pinhole through the film point, in pixels.
inline Ray camera_ray(const CameraView& view, Vec2 film) {
    return {view.o, normalize(view.corner + film.x * view.dx + film.y * view.dy)};
}

/// What a triangle test returns: the distance, and the weights of the second and third vertex.
struct TriangleHit {
    float t, b1, b2;
};

/// Where the ray meets the triangle p0 p1 p2, from either side.
///
///   o + t d = p0 + b1 (p1 - p0) + b2 (p2 - p0), three equations for t, b1, b2: Cramer's rule
///   inside: b1 >= 0, b2 >= 0, b1 + b2 <= 1
///
/// Seen edge-on the determinant is 0, and t infinity or NaN: no hit.
/// source  Moeller, Trumbore 1997
/// tested by  "brute: in random scenes a ray hits what the hierarchy says", t within 1e-3
inline std::optional<TriangleHit> intersect_triangle(const Ray& ray, Vec3 p0, Vec3 p1, Vec3 p2) {
    Vec3d d(ray.d), corner(p0);
    Vec3d side1 = Vec3d(p1) - corner, side2 = Vec3d(p2) - corner, from = Vec3d(ray.o) - corner;
    Vec3d across = cross(d, side2), up = cross(from, side1);
    double inverse = 1 / dot(side1, across);
    double b1 = dot(from, across) * inverse, b2 = dot(d, up) * inverse;
    if (!(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1)) return {};
    auto t = static_cast<float>(dot(side2, up) * inverse);
    if (!(t > 0 && t < ray.t_max)) return {};
    return TriangleHit{t, static_cast<float>(b1), static_cast<float>(b2)};
}

/// The nearest t at which the ray meets the sphere from outside or from inside.
///
///   |o + t d - c|^2 = r^2:  a t^2 + 2 b t + |f|^2 - r^2 = 0,  f = o - c, a = d.d, b = f.d
///
/// tested by  "brute: in random scenes a ray hits what the hierarchy says", within 1e-3
inline std::optional<float> intersect_sphere(const Ray& ray, Vec3 c, float r) {
    Vec3d d(ray.d), f = Vec3d(ray.o) - Vec3d(c);
    double a = dot(d, d), b = dot(f, d);
    double discriminant = b * b - a * (dot(f, f) - double{r} * double{r});
    if (!(discriminant >= 0)) return {};
    double root = std::sqrt(discriminant), near = (-b - root) / a, far = (-b + root) / a;
    auto t = static_cast<float>(near > 0 ? near : far);
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

/// Tests every primitive in turn: the slow and certain way, which every hierarchy must agree with.
/// Of two hits at the same t the lower number wins.
inline PrimHit linear_scan(const Geometry& g, Ray ray) {
    PrimHit best;
    uint32_t prim = 0;
    for (const Triangle& tri : g.triangles) {
        auto [v0, v1, v2] = tri.v;
        if (auto hit = intersect_triangle(ray, g.positions[v0], g.positions[v1], g.positions[v2])) {
            best = {prim, hit->t, hit->b1, hit->b2};
            ray.t_max = hit->t;
        }
        prim++;
    }
    for (const Sphere& s : g.spheres) {
        if (auto t = intersect_sphere(ray, s.c, s.r)) {
            best = {prim, *t};
            ray.t_max = *t;
        }
        prim++;
    }
    for (const Disk& disk : g.disks) {
        if (auto t = intersect_disk(ray, disk.c, disk.n, disk.r)) {
            best = {prim, *t};
            ray.t_max = *t;
        }
        prim++;
    }
    return best;
}

/// The mirror direction of wo about n.      wi = 2 (n.wo) n - wo
inline Vec3 reflect(Vec3 wo, Vec3 n) { return 2 * dot(wo, n) * n - wo; }

/// The direction into which light from wo is refracted; eta: index there / index on wo's side.
///
///   sin_t = sin_i / eta  (Snell);  wi = -wo / eta + (cos_i / eta - cos_t) n
///
/// n is on wo's side. Nothing where all light is reflected (sin_t > 1).
inline std::optional<Vec3> refract(Vec3 wo, Vec3 n, float eta) {
    float cos_i = dot(wo, n);
    float sin2_t = std::max(0.0f, 1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return {};
    float cos_t = std::sqrt(1 - sin2_t);
    return normalize((-1 / eta) * wo + (cos_i / eta - cos_t) * n);
}

/// The share of unpolarised light that glass reflects; the rest, 1 - R, goes through.
///
///   r_s = (cos_i - eta cos_t) / (cos_i + eta cos_t)
///   r_p = (eta cos_i - cos_t) / (eta cos_i + cos_t)
///   R = (r_s^2 + r_p^2) / 2
///
/// cos_i in [0,1]; eta: index beyond the surface over index here. 1 under total reflection.
/// source  Fresnel 1823      tested by  "truth: Fresnel's equations for glass", within 1e-6 / cos_t
inline float fresnel_dielectric(float cos_i, float eta) {
    float sin2_t = std::max(0.0f, 1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return 1;
    float cos_t = std::sqrt(1 - sin2_t);
    float r_s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    float r_p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return (r_s * r_s + r_p * r_p) / 2;
}

/// A lamp in Whitted's method: each primitive that emits light is replaced by one point.
struct Lamp {
    Vec3 p = {};         // m, the centre of the primitive that shines
    Vec3 n = {};         // its normal; 0: shines the same to all sides (a sphere, a point light)
    Rgb intensity = {};  // along n, W sr^-1: radiance times the area that is seen
    float radius = 0;    // m, of a sphere
    bool two_sided = false;
};

/// The primitive of an area light as a lamp: a point in its middle.
inline Lamp lamp_of(const Geometry& g, const Light& light, uint32_t prim) {
    Lamp lamp{.two_sided = light.two_sided};
    float area = 0;  // that is seen along n
    visit(
        g, prim,
        [&](const Triangle& triangle) {
            auto [v0, v1, v2] = triangle.v;
            Vec3 p0 = g.positions[v0], p1 = g.positions[v1], p2 = g.positions[v2];
            Vec3 n = cross(p1 - p0, p2 - p0);  // twice the area long
            lamp.p = (p0 + p1 + p2) / 3;
            lamp.n = normalize(n);
            area = length(n) / 2;
        },
        [&](const Sphere& sphere) {
            lamp.p = sphere.c;
            lamp.radius = sphere.r;
            lamp.two_sided = true;
            area = pi * sphere.r * sphere.r;
        },
        [&](const Disk& disk) {
            lamp.p = disk.c;
            lamp.n = disk.n;
            area = pi * disk.r * disk.r;
        });
    lamp.intensity = light.L * area;
    return lamp;
}

/// What one lamp sends from the diffuse point x to the eye: f I cos cos_lamp / r^2 V.
inline Rgb shade(const Scene& scene, const Hit& x, const Lamp& lamp) {
    Vec3 to_lamp = lamp.p - x.p;
    float r = length(to_lamp);
    Vec3 wi = to_lamp / r;
    float cos_x = dot(wi, x.n), cos_lamp = lamp.n == Vec3{} ? 1 : -dot(wi, lamp.n);
    if (lamp.two_sided) cos_lamp = std::abs(cos_lamp);
    if (cos_x <= 0 || cos_lamp <= 0 || dot(wi, x.ng) <= 0) return {};

    // Stop the shadow ray short of the lamp itself.
    rays_traced++;
    Ray shadow = spawn_ray(x, wi, just_short_of(lamp.p, lamp.radius, r, cos_lamp, x.eps));
    if (linear_scan(scene.geometry, shadow).prim != PrimHit::none) return {};
    Rgb f = x.material->reflectance / pi;
    return f * lamp.intensity * (cos_x * cos_lamp / (r * r));
}

/// Direct light at x from all lamps, each as a point, times beta.
inline Rgb shade_all(const Scene& scene, const Hit& x, Rgb beta, Recorder& recorder) {
    Rgb L;
    auto add = [&](const Lamp& lamp) {
        Rgb Ld = shade(scene, x, lamp);
        L += beta * Ld;
        recorder.direct(Ld, normalize(lamp.p - x.p), 0, 0);
    };
    for (const Light& light : scene.lights) {
        switch (light.type) {
            case LightType::area:
                for (uint32_t i = 0; i < light.prims; i++) {
                    add(lamp_of(scene.geometry, light, light.first_prim + i));
                }
                break;
            case LightType::point:
                add({.p = light.p, .intensity = light.L, .two_sided = true});
                break;
            case LightType::distant: {  // a lamp so far away that its rays are parallel
                constexpr float far = 1e12f;
                add({.p = x.p + far * light.p,
                     .intensity = light.L * (far * far),
                     .two_sided = true});
                break;
            }
            case LightType::infinite: break;  // no point to aim at: only seen, never lighting
        }
    }
    return L;
}

inline Rgb follow(const Scene& scene, const Ray& ray, Rgb beta, int depth, Recorder& recorder);

/// Follows every branch at mirror and glass; beta: the factor with which x counts at the eye.
inline Rgb follow_specular(const Scene& scene, const Hit& x, Vec3 wo, Rgb beta, int depth,
                           Recorder& recorder) {
    auto branch = [&](Vec3 wi, Rgb share) {
        if (max_component(beta * share) < 1e-3f) return Rgb{};  // too faint to see
        recorder.scatter(wi, share / std::abs(dot(wi, x.n)), 1, true, beta * share);
        Rgb L = follow(scene, spawn_ray(x, wi), beta * share, depth + 1, recorder);
        recorder.step_back();
        return L;
    };
    float cos_o = dot(wo, x.n);
    if (x.material->type == MaterialType::conductor) {
        return branch(reflect(wo, x.n), fresnel_conductor(cos_o, x.material->eta, x.material->k));
    }
    float eta = x.front ? x.material->ior : 1 / x.material->ior;
    float R = fresnel_dielectric(cos_o, eta), T = (1 - R) / (eta * eta);
    Rgb L = branch(reflect(wo, x.n), {R, R, R});
    if (std::optional<Vec3> wi = refract(wo, x.n, eta)) L += branch(*wi, {T, T, T});
    return L;
}

/// Radiance along the ray, times beta, by Whitted's rules.
inline Rgb follow(const Scene& scene, const Ray& ray, Rgb beta, int depth, Recorder& recorder) {
    rays_traced++;
    PrimHit found = linear_scan(scene.geometry, ray);
    if (found.prim == PrimHit::none) {
        recorder.emitted(scene.sky);
        return beta * scene.sky;
    }
    Hit x;
    make_hit(scene, ray, found, x);
    recorder.vertex(x);

    Rgb Le = emission(scene, x), L = beta * Le;
    recorder.emitted(Le);
    if (depth == scene.max_depth) {
        recorder.cut();
        return L;
    }
    if (x.material->type == MaterialType::diffuse) return L + shade_all(scene, x, beta, recorder);
    return L + follow_specular(scene, x, -ray.d, beta, depth, recorder);
}

/// Estimates Li along the ray as Whitted did: without random numbers, from some classes of paths.
///
///   classes found:  LE, LDE, LS+E, LDS+E      missed:  any with two D, and LS+D...
///
/// Biased: lamps are points (no soft shadows), and no light arrives from other surfaces.
/// source  Whitted 1980      tested by  "ch05 classes of paths", within 5 standard errors
inline Rgb trace(const Scene& scene, Ray ray, Sampler&, Recorder& recorder) {
    return follow(scene, ray, {1, 1, 1}, 0, recorder);
}

}  // namespace ch05
