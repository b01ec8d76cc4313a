// Chapter 21: bidirectional path tracing. All connections of two paths, each with its MIS weight:
//
//   strategy (s, t): s vertices from the light, t from the eye;   mis_s = p_s / sum over i of p_i
#pragma once
#include "common/path/lens.h"
#include "common/path/light_paths.h"
#include "common/path/roulette.h"

namespace ch21 {

/// A vertex of a path: on a surface, on a light, in the sky, or at the pinhole.
struct Vertex {
    Hit x = {};
    Vec3 back;                         // unit, to the vertex before
    Rgb beta = {1, 1, 1};              // throughput from the eye, flux from a light; Le / pdf on it
    bool connectible = true;           // neither mirror nor glass nor sky
    Rgb Le;                            // emitted there
    LightType type = LightType::area;  // of that light
    float pdf = 0;                     // m^-2, of this point of the light
};
using Path = std::vector<Vertex>;

inline bool at_infinity(LightType t) { return t == LightType::distant || t == LightType::infinite; }
inline bool can_be_hit(LightType t) { return t == LightType::area || t == LightType::infinite; }
inline Vec3 direction(const Vertex& from, const Vertex& to) { return normalize(to.x.p - from.x.p); }

/// The vertex where a ray hits x, or a vertex in the sky if it hits nothing.
inline Vertex vertex_at(const Scene& scene, const Endpoints& endpoints, const std::optional<Hit>& x,
                        const Ray& ray, Rgb beta) {
    Vertex v{x ? *x : Hit{}, -ray.d, beta, x && !is_specular(*x->material), {}};
    if (!x) v.x.ng = -ray.d;
    float R = scene.radius, p_image = static_cast<float>(endpoints.p_image);
    if (!x && scene.sky_image) {
        Vec2 uv = point_of(*scene.sky_image, ray.d);
        size_t pixel = scene.sky_image->pixel_at(uv);
        v.Le = scene.sky_image->pixels[pixel], v.type = LightType::infinite;
        v.pdf = p_image * pdf_image(*scene.sky_image, endpoints.image_cdf, pixel, uv) / (R * R);
        return v;
    }
    v.Le = x ? emission(scene, *x) : scene.sky;
    if (is_black(v.Le)) return v;
    size_t i = static_cast<size_t>(x ? x->light : scene.sky_light);
    v.type = scene.lights[i].type;
    float pmf = (1 - p_image) * pmf_light(endpoints.lights, i);
    float sides = scene.lights[i].two_sided ? 2 : 1;
    v.pdf = pmf * (x ? pdf_area(scene, i) / sides : 1 / (4 * pi * R * R));
    return v;
}

/// Walks along the ray: from a light as in chapter 20, from the eye as in 13. Leaves path[0] empty.
inline Path random_walk(const Scene& scene, const Endpoints& endpoints, bool from_light, Ray ray,
                        Sampler& sampler, Recorder& recorder) {
    Path path;
    path.reserve(8);  // most are shorter
    path.resize(1);
    Rgb beta = {1, 1, 1};
    int last = scene.max_depth + (from_light ? 0 : 1);
    for (int depth = 1; depth <= last; depth++) {
        // Find the next vertex.
        std::optional<Hit> x = intersect(scene, ray);
        path.push_back(vertex_at(scene, endpoints, x, ray, beta));
        if (!x) return path;
        recorder.vertex(x);
        Vec3 wi = -ray.d;
        if (depth == last && !from_light) recorder.cut();
        if (depth == last) return path;

        // Sample the next direction, by the path alone: the same for every light.
        float u1 = sampler.u1();
        Vec2 u2 = sampler.u2();
        BsdfSample s =
            from_light ? sample_light_bsdf(scene, *x, wi, u1, u2) : sample_bsdf(*x, wi, u1, u2);
        if (s.pdf_w == 0) return path;
        beta *= s.f * ((from_light ? 1 : std::abs(dot(s.wi, x->n))) / s.pdf_w);
        if (is_black(beta)) return path;
        recorder.scatter(s, beta);

        // Terminate with probability 1 - q, and divide by q to compensate.
        float q = survival_probability(2.5f * beta, depth - 1);  // 2.5: as in chapter 15
        if (sampler.u1() >= q) return path;
        beta /= q;
        recorder.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
    return path;
}

/// A path from a light; its first vertex is the point on the light.
inline Path light_subpath(const Scene& scene, const Endpoints& endpoints, Sampler& sampler,
                          Recorder& recorder, float time = 0) {
    // Choose a light, a point on it and a direction.
    if (scene.lights.empty() && endpoints.p_image == 0) return {};
    double u = to_unit_double(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, endpoints, u, u_y, sampler.u2());
    recorder.start_at_light(e.y.p);
    float cos_y = e.type == LightType::point ? 1 : dot(e.d, e.y.n);
    Rgb flux = e.Le * (cos_y / (e.pmf * e.y.pdf * e.pdf_w));
    Ray ray = {e.y.p + e.y.eps * e.y.n, e.d, infinity, time};
    Path path = random_walk(scene, endpoints, true, ray, sampler, recorder);
    for (Vertex& v : path) v.beta = flux * v.beta;
    float R = scene.radius, pdf = e.pmf * (at_infinity(e.type) ? e.pdf_w / (R * R) : e.y.pdf);
    path[0].x.p = e.y.p, path[0].x.ng = e.y.n, path[0].x.eps = e.y.eps;
    path[0].type = e.type, path[0].pdf = pdf, path[0].beta = e.Le / pdf;
    return path;
}

/// Sets position or normal of y, the point of a light, as seen from the vertex x that it lights.
/// Distant lights and skies: at the scene's radius from x. Point lights: facing x.
inline void place_light(const Scene& scene, Vertex& y, const Vertex& x) {
    if (at_infinity(y.type)) y.x.p = x.x.p - scene.radius * y.x.ng;
    if (y.type == LightType::point) y.x.ng = direction(y, x);
}

/// The whole path in order from the light: s vertices of the light path, t of the eye path.
inline Path whole_path(const Scene& scene, const Path& light, int s, const Path& eye, int t) {
    Path path(light.begin(), light.begin() + s);
    path.insert(path.end(), eye.rend() - t, eye.rend());
    place_light(scene, path[0], path[1]);
    return path;
}

/// Whether strategy s can make a path: by connecting vertices s - 1 and s, or by a hit (s = 0).
inline bool can_make(const Path& path, size_t s) {
    if (s == 0) return can_be_hit(path[0].type);
    if (s < 3 && s + 1 == path.size()) return false;  // to the camera: noisier than s = 0, 1
    return (s == 1 || path[s - 1].connectible) && path[s].connectible;
}

/// The density, in sr^-1, with which a path that came from `from` leaves x in direction `to`.
/// Mirrors and glass: 1, though by refraction it is n2^2 cos_2 / (n1^2 cos_1) times the way back's.
inline float pdf_onwards(const Scene& scene, bool from_light, const Hit& x, Vec3 from, Vec3 to) {
    if (is_specular(*x.material)) return 1;
    Hit y = seen_from(scene, x, from);
    if (from_light && x.material->type == MaterialType::diffuse) y.n = y.ng;
    return glossy_bsdf::pdf_bsdf(y, from, to);
}
/// The density, in sr^-1, with which a light emits along w. Far lights: 1 / pi, for a disk of rays.
inline float pdf_emission(const Vertex& light, Vec3 w) {
    return light.type == LightType::point ? 1 / (4 * pi) : std::abs(dot(w, light.x.ng)) / pi;
}

/// The density of vertex x, in m^-2, in a walk that came from `before` to v (null: it begins at v).
///   pdf_A = pdf_w cos / d^2,    pdf_w: of the direction in which the walk leaves v
inline double pdf_next(const Scene& scene, const Endpoints& endpoints, bool from_light,
                       const Vertex* before, const Vertex& v, const Vertex& x) {
    Vec3 w = direction(v, x);
    float pdf_w = before       ? pdf_onwards(scene, from_light, v.x, direction(v, *before), w)
                  : from_light ? pdf_emission(v, w)
                               : importance_cos(endpoints.camera, w);
    float cos_x = std::abs(dot(w, x.x.ng)), d2 = length_squared(x.x.p - v.x.p);
    return static_cast<double>(pdf_w * cos_x / d2);
}

/// The density of each vertex of a path, in a walk that begins at path[0].
inline std::vector<double> densities(const Scene& scene, const Endpoints& endpoints,
                                     bool from_light, const Path& path) {
    std::vector<double> pdf_A = {static_cast<double>(path[0].pdf)};
    for (size_t i = 1; i < path.size(); i++) {
        const Vertex* before = i > 1 ? &path[i - 2] : nullptr;
        pdf_A.push_back(pdf_next(scene, endpoints, from_light, before, path[i - 1], path[i]));
    }
    return pdf_A;
}

/// The weight of strategy s of a path: the balance heuristic.
///
///   mis_s = p_s / sum over i of p_i,    p_i = light_0 ... light_i-1  eye_i ... eye_k-1
///
/// light, eye: densities of each vertex from either end. Only factors in which p_i and p_s differ
/// are multiplied: no overflow. 0 if vertices coincide (0 / 0).   source  Veach 1997, sec. 10.2
/// tested by  "identity: by the weights alone, chapter 22 brings what ...", to 1e-4
inline float mis_weight(const Scene& scene, const Endpoints& endpoints, const Path& path,
                        size_t s) {
    std::vector<double> light = densities(scene, endpoints, true, path);
    std::vector<double> eye = densities(scene, endpoints, false, {path.rbegin(), path.rend()});
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

/// s > 0, t > 1: connects y, the last vertex from the light, with z, the last one from the eye.
///
///   L = beta_z f_z cos_z  V / d^2  f_y cos_y beta_y,    s = 1: without f_y
inline Rgb connect(const Scene& scene, const Vertex& y, const Vertex& z, int s) {
    float d = length(y.x.p - z.x.p);
    Vec3 wi = direction(z, y);
    Rgb f = eval_bsdf(z.x, z.back, wi) * std::abs(dot(wi, z.x.n));
    if (!(d > 0) || is_black(f)) return {};
    float cos_y = dot(-wi, y.x.ng);
    Rgb f_y = std::max(0.0f, cos_y) * Rgb{1, 1, 1};
    if (s > 1) f_y = adjoint_bsdf(scene, y.x, y.back, -wi);
    Rgb L = z.beta * f * (y.beta * f_y) / (d * d);
    float t_max =
        s == 1 && at_infinity(y.type) ? infinity : d - (z.x.eps + y.x.eps) / std::abs(cos_y);
    return is_black(L) || occluded(scene, spawn_ray(z.x, wi, t_max)) ? Rgb{} : L;
}

/// Estimates Li along the ray; splats the light path's contributions to other pixels.
///
///   L = sum over s >= 0, t >= 1 of  mis_s,t  (path of s vertices from the light, t from the eye)
///
/// Unbiased up to scene.max_depth scattering events.
/// source  Lafortune, Willems 1993; Veach, Guibas 1994
/// tested by  "ch21 bidirectional", within 5 standard errors
inline Rgb trace(const Scene& scene, const Endpoints& endpoints, Ray ray, Splats& splats,
                 Sampler& sampler, Recorder& recorder) {
    // Walk from a light (with sampler dimensions of its own) and from the eye.
    if (scene.camera.lens_radius > 0) ray = through_lens(scene.camera, ray, sampler.u2());
    if (scene.moves) ray.time = sample_time(scene.camera, sampler.u1());
    sampler.jump(1 << 12);
    Path light = light_subpath(scene, endpoints, sampler, recorder, ray.time);
    sampler.jump(8);
    recorder.start_at_eye();
    Path eye = random_walk(scene, endpoints, false, ray, sampler, recorder);
    eye[0].x.p = ray.o, eye[0].connectible = scene.camera.lens_radius == 0;

    // Connect every vertex of one path to every vertex of the other.
    Rgb sum;
    for (int t = 1; t <= static_cast<int>(eye.size()); t++) {
        for (int s = 0; s <= static_cast<int>(light.size()); s++) {
            if (s + t < 2 || s + t > scene.max_depth + 2) continue;
            Path path = whole_path(scene, light, s, eye, t);
            size_t i = static_cast<size_t>(s);
            if (!can_make(path, i)) continue;
            Splat splat = {Contribution::own_pixel, {}};
            const Vertex& y = path[i > 0 ? i - 1 : 0];
            if (s == 0) splat.L = y.beta * y.Le;
            if (s > 0 && t > 1) splat.L = connect(scene, y, path[i], s);
            if (t == 1) splat = connect_to_camera(scene, endpoints.camera, y.x, y.back, y.beta);
            if (is_black(splat.L)) continue;

            // Multiply by the MIS weight of this strategy.
            float mis = mis_weight(scene, endpoints, path, i);
            splat.L *= mis;
            recorder.connected(splat.L, s, t, mis, splat.pixel);
            if (t == 1) splats.push_back(splat);
            if (t > 1) sum += splat.L;
        }
    }
    return sum;
}

}  // namespace ch21
