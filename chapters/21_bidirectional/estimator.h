// Chapter 21: bidirectional path tracing. One path from the eye, one from a light, and all ways to
// join them, each with its weight:
//
//   strategy (s, t): s vertices from the light, t from the eye;   mis_s = p_s / sum over i of p_i
#pragma once
#include "common/path/light_paths.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/path/splats.h"
#include "common/recording/recorder.h"

namespace ch21 {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;

/// A vertex of a path: on a surface, on a light, in the sky; or the pinhole.
struct Vertex {
    Hit x = {};
    Vec3 back;                         // unit, to the vertex before
    Rgb beta = {1, 1, 1};              // what the path carries to x; of a light drawn: Le / pdf
    bool joins = true;                 // neither mirror nor glass nor sky
    Rgb Le;                            // what shines there
    LightType type = LightType::area;  // of what shines there
    float pdf = 0;                     // m^-2, of this point of the light
};
using Path = std::vector<Vertex>;

/// What is prepared for a scene; s >= 0: the one strategy that counts, without a weight.
struct Prepared {
    Ends ends;
    int s = -1, t = -1;
};

inline Prepared prepare(const Scene& scene) { return {ends_of(scene)}; }
inline bool is_far(LightType t) { return t == LightType::distant || t == LightType::infinite; }
inline Vec3 unit(const Vertex& from, const Vertex& to) { return normalize(to.x.p - from.x.p); }

/// The vertex that a walk comes to along the ray: x, or the sky where it meets nothing.
inline Vertex vertex_at(const Scene& scene, const Ends& ends, const std::optional<Hit>& x,
                        const Ray& ray, Rgb beta) {
    Vertex v{x ? *x : Hit{}, -ray.d, beta, x && !is_specular(*x->material), {}};
    if (!x) v.x.ng = -ray.d;
    v.Le = x ? emission(scene, *x) : scene.sky;
    if (is_black(v.Le)) return v;
    size_t i = static_cast<size_t>(x ? x->light : scene.sky_light);
    v.type = scene.lights[i].type;
    float R = scene.radius, sides = scene.lights[i].two_sided ? 2 : 1;
    v.pdf = pmf_light(ends.lights, i) * (x ? pdf_area(scene, i) / sides : 1 / (4 * pi * R * R));
    return v;
}

/// Walks along the ray: from a light as in chapter 20, from the eye as in 13. path[0]: yet empty.
inline Path walk(const Scene& scene, const Ends& ends, bool from_light, Ray ray, Sampler& sampler,
                 Recorder& recorder) {
    Path path(1);
    Rgb beta = {1, 1, 1};
    int last = scene.max_depth + (from_light ? 0 : 1);
    for (int depth = 1; depth <= last; depth++) {
        // Find the next point.
        std::optional<Hit> x = intersect(scene, ray);
        path.push_back(vertex_at(scene, ends, x, ray, beta));
        if (!x) return path;
        recorder.vertex(x);
        Vec3 wi = -ray.d;
        if (depth == last && !from_light) recorder.cut();
        if (depth == last) return path;

        // Go on, with what does not depend on the light but on the path alone.
        float u1 = sampler.u1();
        Vec2 u2 = sampler.u2();
        BsdfSample s =
            from_light ? sample_light_bsdf(scene, *x, wi, u1, u2) : sample_bsdf(*x, wi, u1, u2);
        if (s.pdf_w == 0) return path;
        beta *= s.f * ((from_light ? 1 : std::abs(dot(s.wi, x->n))) / s.pdf_w);
        if (is_black(beta)) return path;
        recorder.scatter(s, beta);

        // Play roulette: stop with probability 1 - q, else stand in for those that stopped.
        float q = survival_probability(beta, depth - 1);
        if (sampler.u1() >= q) return path;
        beta /= q;
        recorder.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
    return path;
}

/// One path from a light, vertex by vertex; the first is the point on the light.
inline Path walk_from_light(const Scene& scene, const Ends& ends, Sampler& sampler,
                            Recorder& recorder) {
    // Choose a light, a point on it and a direction.
    if (scene.lights.empty()) return {};
    double u = ::join(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, ends, u, u_y, sampler.u2());
    recorder.start_at_light(e.y.p);
    float cos_y = e.type == LightType::point ? 1 : dot(e.d, e.y.n);
    Rgb flux = e.Le * (cos_y / (e.pmf * e.y.pdf * e.pdf_w));
    Path path = walk(scene, ends, true, {e.y.p + e.y.eps * e.y.n, e.d}, sampler, recorder);
    for (Vertex& v : path) v.beta = flux * v.beta;
    Vertex& light = path[0];
    light.x.p = e.y.p, light.x.ng = e.y.n, light.x.eps = e.y.eps;
    float R = scene.radius;
    light.type = e.type, light.pdf = e.pmf * (is_far(e.type) ? e.pdf_w / (R * R) : e.y.pdf);
    light.beta = e.Le / light.pdf;
    return path;
}

/// The path of s vertices from the light and t from the eye, from the light on.
///
/// Far lights stand on a sphere of the scene's radius. Lights without a size face what they light.
inline Path whole_path(const Scene& scene, const Path& light, int s, const Path& eye, int t) {
    Path path(light.begin(), light.begin() + s);
    path.insert(path.end(), eye.rend() - t, eye.rend());
    Vertex& y = path[0];
    if (is_far(y.type)) y.x.p = path[1].x.p - scene.radius * y.x.ng;
    if (y.type == LightType::point) y.x.ng = unit(y, path[1]);
    return path;
}

/// Whether strategy s can make a path: by a join of vertices s - 1 and s, or where the light is met
/// (s = 0). The light itself is not shown to the camera: the eye meets it without noise.
inline bool can_make(const Path& path, size_t s) {
    if (s == 0) return path[0].type == LightType::area || path[0].type == LightType::infinite;
    return path.size() > 2 && (s == 1 || path[s - 1].joins) && path[s].joins;
}

/// The density, in sr^-1, with which a walk goes on at x from `from` to `to`. Mirrors and glass: 1,
/// as they have the same chances in both directions.
inline float pdf_onwards(const Scene& scene, bool from_light, const Hit& x, Vec3 from, Vec3 to) {
    if (is_specular(*x.material)) return 1;
    Hit y = seen_from(scene, x, from);
    if (from_light && x.material->type == MaterialType::diffuse) y.n = y.ng;
    return pdf_bsdf(y, from, to);
}
/// The density, in sr^-1, with which a ray leaves a light along w. The disk of far ones has pi sr.
inline float pdf_emission(const Vertex& light, Vec3 w) {
    return light.type == LightType::point ? 1 / (4 * pi) : std::abs(dot(w, light.x.ng)) / pi;
}

/// The density of each vertex of a path, when a walk comes along it that begins at path[0].
///
///   pdf_A = pdf_w cos / d^2,    pdf_w: of the direction in which it leaves v, the vertex before
inline std::vector<double> densities(const Scene& scene, const Ends& ends, bool from_light,
                                     const Path& path) {
    std::vector<double> pdf_A = {static_cast<double>(path[0].pdf)};
    for (size_t i = 1; i < path.size(); i++) {
        const Vertex &v = path[i - 1], &x = path[i];
        Vec3 w = unit(v, x);
        float pdf_w = i > 1        ? pdf_onwards(scene, from_light, v.x, unit(v, path[i - 2]), w)
                      : from_light ? pdf_emission(v, w)
                                   : importance_cos(ends.camera, w);
        float cos_x = std::abs(dot(w, x.x.ng)), d2 = length_squared(x.x.p - v.x.p);
        pdf_A.push_back(static_cast<double>(pdf_w * cos_x / d2));
    }
    return pdf_A;
}

/// The weight of strategy s of a path: the balance heuristic.
///
///   mis_s = p_s / sum over i of p_i,    p_i = light_0 ... light_i-1  eye_i ... eye_k-1
///
/// light, eye: the density of each vertex from either side. Of p_i / p_s only factors are left that
/// differ: no product is too large or too small for a number. 0 where vertices touch (0 / 0).
/// source  Veach 1997, sec. 10.2
/// tested by  "identity: weights are p_s / sum p_i over the densities of whole paths"
inline float mis_weight(const Scene& scene, const Ends& ends, const Path& path, size_t s) {
    std::vector<double> light = densities(scene, ends, true, path);
    std::vector<double> eye = densities(scene, ends, false, {path.rbegin(), path.rend()});
    std::reverse(eye.begin(), eye.end());
    double sum = 0;
    for (size_t i = 0; i < path.size(); i++) {
        double p = can_make(path, i) ? 1 : 0;  // p_i / p_s
        for (size_t j = i; j < s; j++) p *= eye[j] / light[j];
        for (size_t j = s; j < i; j++) p *= light[j] / eye[j];
        sum += p;
    }
    return sum > 0 ? static_cast<float>(1 / sum) : 0;
}

/// t = 1: shows y, the last vertex from the light, to the camera.      flux f cos We V / d^2
inline Rgb show(const Scene& scene, const Pinhole& camera, const Vertex& y, size_t& pixel) {
    Vec3 away = y.x.p - camera.view.o;
    std::optional<Sight> sight = sight_of(camera, away);
    if (!sight) return {};
    float d = length(away);
    Vec3 wo = -1 / d * away;
    Rgb L = y.beta * carry(scene, y.x, y.back, wo) * (sight->We_cos / (d * d));
    pixel = sight->pixel;
    return is_black(L) || occluded(scene, spawn_ray(y.x, wo, d)) ? Rgb{} : L;
}

/// s > 0, t > 1: joins y, the last vertex from the light, with z, the last one from the eye.
///
///   L = beta_z f_z cos_z  V / d^2  carry_y beta_y,    of the light itself cos_y for carry_y
inline Rgb join(const Scene& scene, const Vertex& y, const Vertex& z, int s) {
    float d = length(y.x.p - z.x.p);
    Vec3 wi = unit(z, y);
    Rgb f = eval_bsdf(z.x, z.back, wi) * std::abs(dot(wi, z.x.n));
    if (!(d > 0) || is_black(f)) return {};
    float cos_y = dot(-wi, y.x.ng);
    Rgb flux = s > 1 ? y.beta * carry(scene, y.x, y.back, -wi) : y.beta * std::max(0.0f, cos_y);
    Rgb L = z.beta * f * flux / (d * d);
    float t_max = s == 1 && is_far(y.type) ? infinity : d - (z.x.eps + y.x.eps) / std::abs(cos_y);
    return is_black(L) || occluded(scene, spawn_ray(z.x, wi, t_max)) ? Rgb{} : L;
}

/// Estimates Li along the ray; adds to the splats what light shows to other pixels.
///
///   L = sum over s >= 0, t >= 1 of  mis_s,t  (path of s vertices from the light, t from the eye)
///
/// Unbiased up to scene.max_depth scattering events.
/// source  Lafortune, Willems 1993; Veach, Guibas 1994      tested by  "ch21 bidirectional"
inline Rgb trace(const Scene& scene, const Prepared& prepared, Ray ray, Splats& splats,
                 Sampler& sampler, Recorder& recorder) {
    // Walk from a light, with numbers that have their own dimensions, and from the eye.
    const Ends& ends = prepared.ends;
    sampler.jump(1 << 12);
    Path light = walk_from_light(scene, ends, sampler, recorder);
    sampler.jump(8);
    recorder.start_at_eye();
    Path eye = walk(scene, ends, false, ray, sampler, recorder);
    eye[0].x.p = ray.o;

    // Take each number of vertices of the one with each of the other.
    Rgb sum;
    for (int t = 1; t <= static_cast<int>(eye.size()); t++) {
        for (int s = 0; s <= static_cast<int>(light.size()); s++) {
            if (s + t < 2 || s + t > scene.max_depth + 2) continue;
            if (prepared.s >= 0 && (prepared.s != s || prepared.t != t)) continue;
            Path path = whole_path(scene, light, s, eye, t);
            size_t i = static_cast<size_t>(s), pixel = Contribution::own_pixel;
            if (!can_make(path, i)) continue;
            Rgb L = s == 0   ? path[0].beta * path[0].Le
                    : t == 1 ? show(scene, ends.camera, path[i - 1], pixel)
                             : join(scene, path[i - 1], path[i], s);
            if (is_black(L)) continue;

            // Weigh what it brings by how likely this strategy was to make the path.
            float mis = prepared.s < 0 ? mis_weight(scene, ends, path, i) : 1;
            L *= mis;
            recorder.connected(L, s, t, mis, pixel);
            if (t == 1) splats.push_back({pixel, L});
            if (t > 1) sum += L;
        }
    }
    return sum;
}

}  // namespace ch21
