// Chapter 20: light tracing. Paths start at the lights, and each of their vertices is connected to
// the camera:
//
//   pixel = mean over paths of  sum over their points of  flux f cos We V / d^2
#pragma once
#include "common/path/image_light.h"
#include "common/path/lens.h"
#include "common/path/roulette.h"
#include "common/recording/recorder.h"
#include "common/scene/camera.h"
#include "common/scene/intersect.h"

namespace ch20 {

using glossy_bsdf::eval_bsdf, glossy_bsdf::sample_bsdf, sky_light::sample_image;

/// The camera, as connections from light paths need it.
struct Pinhole {
    CameraView view;
    Vec3 n, axis;       // dx x dy, the area of a pixel; viewing direction, unit
    float depth, area;  // distance of the film; its area at distance 1
    int width, height;
};
inline Pinhole pinhole_of(const Scene& scene) {
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Vec3 n = cross(view.dx, view.dy), axis = normalize(n);
    if (dot(axis, view.corner) < 0) axis = -axis;
    float depth = dot(axis, view.corner);
    float pixels = static_cast<float>(scene.width) * static_cast<float>(scene.height);
    return {view, n, axis, depth, pixels * length(n) / (depth * depth), scene.width, scene.height};
}

/// The importance We of light from direction `away`, times the cosine, in sr^-1.
///
///   We = 1 / (A cos^4),    A: the film's area at distance 1;    integral of We cos dw: 1
///
/// source  Veach 1997, sec. 8.3      tested by  "truth: a lit floor is as bright ...", to 1e-5
inline float importance_cos(const Pinhole& camera, Vec3 away) {
    float cos_c = dot(away, camera.axis) / length(away);
    return 1 / (camera.area * cos_c * cos_c * cos_c);
}

/// The pixel that shows a point, and the importance of its direction, times the cosine.
struct CameraImportance {
    size_t pixel;
    float We_cos;  // sr^-1
};

/// The pixel in which the camera sees the point at `away` from its pinhole; nothing if outside.
/// tested by  "identity: a light point is in the pixel whose rays meet it, ...", exactly
inline std::optional<CameraImportance> camera_importance(const Pinhole& camera, Vec3 away) {
    float depth = dot(away, camera.axis);
    if (!(depth > 0)) return {};
    Vec3 q = camera.depth / depth * away - camera.view.corner;  // on the film, from its corner
    float n2 = dot(camera.n, camera.n);
    float x = dot(cross(q, camera.view.dy), camera.n) / n2;
    float y = dot(cross(camera.view.dx, q), camera.n) / n2;
    float width = static_cast<float>(camera.width), height = static_cast<float>(camera.height);
    if (!(x >= 0 && y >= 0 && x < width && y < height)) return {};
    size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(camera.width);
    return CameraImportance{pixel + static_cast<size_t>(x), importance_cos(camera, away)};
}

/// The ends of paths: the camera, and the table of lights (3/4 by power, 1/4 uniform).
struct Endpoints {
    LightTable lights;
    Pinhole camera;
    std::vector<double> image_cdf = {};  // of the sky, as in chapter 17
    double p_image = 0;                  // probability that a path starts there
};
inline Endpoints endpoints_of(const Scene& scene) {
    LightTable lights = build_light_table(light_pmf(scene, 0.25));  // as in chapter 11
    std::vector<double> cdf = sky_light::prepare(scene, 1, false).image_cdf;
    double p_image = cdf.empty() || cdf.back() == 0 ? 0 : lights.empty() ? 1 : 0.5;
    return {lights, pinhole_of(scene), cdf, p_image};
}

/// A ray that leaves a light: its origin, direction, densities and radiance.
struct Emission {
    LightType type;
    LightPoint y;  // its normal is on the ray's side; pdf per area
    Vec3 d;
    float pmf = 0, pdf_w = 0;  // of the light; sr^-1
    Rgb Le;                    // W m^-2 sr^-1; W sr^-1 of a point light, W m^-2 of a distant one
};

/// A uniformly distributed direction of the sphere.      pdf_w = 1 / (4 pi)
inline Vec3 sample_sphere(Vec2 u) {
    float z = 1 - 2 * u.x;
    return from_cylindrical(std::sqrt(std::max(0.0f, 1 - z * z)), u.y, z);
}

/// A ray of a sun or a sky, against y.wi: from a point of a disk as wide as the scene.
inline Emission emission_from_disk(const Scene& scene, LightType type, float pmf,
                                   const LightSample& y, Vec2 u) {
    float R = scene.radius;
    Vec3 d = -y.wi, disk = from_cylindrical(R * std::sqrt(u.x), u.y, -R);
    LightPoint p = {scene.centre + Frame(d).to_world(disk), d, 0, 1 / (pi * R * R)};
    return {type, p, d, pmf, y.pdf_w, y.Le};
}
/// A ray of lamp i; of a two-sided lamp, from either side.
inline Emission emission_of_lamp(const Scene& scene, size_t i, float pmf, Vec2 u_y, Vec2 u_d) {
    const Light& light = scene.lights[i];
    bool back = light.two_sided && u_d.x < 0.5f;
    if (light.two_sided) u_d.x = 2 * u_d.x - (back ? 0 : 1);
    LightPoint y = sample_area(scene, i, u_y);
    if (light.two_sided) y.pdf /= 2;
    if (back) y.n = -y.n;
    Vec3 d = sample_cosine_hemisphere(u_d);
    return {light.type, y, Frame(y.n).to_world(d), pmf, pdf_cosine_hemisphere(d.z), light.L};
}

/// Chooses a light by power, and draws a ray from it.
///   area     any point, cosine direction:   pdf = 1 / A, cos / pi       (both sides: 1 / 2A)
///   point    any direction:                 pdf = 1, 1 / (4 pi)
///   distant  a point of the scene's disk:   pdf = 1 / (pi R^2), 1
///   sky      such a point, any direction:   pdf = 1 / (pi R^2), 1 / (4 pi)   (image: pdf_image)
/// tested by  "identity: each light sends out its power", to 1e-4
inline Emission sample_emission(const Scene& scene, const Endpoints& endpoints, double u, Vec2 u_y,
                                Vec2 u_d) {
    double p_image = endpoints.p_image;
    if (u < p_image) {
        LightSample y = sample_image(*scene.sky_image, endpoints.image_cdf, u / p_image, u_d);
        return emission_from_disk(scene, LightType::infinite, static_cast<float>(p_image), y, u_y);
    }
    size_t i = pick_light(endpoints.lights, (u - p_image) / (1 - p_image));
    float pmf = static_cast<float>(1 - p_image) * pmf_light(endpoints.lights, i);
    const Light& light = scene.lights[i];
    if (light.type == LightType::area) return emission_of_lamp(scene, i, pmf, u_y, u_d);
    if (light.type == LightType::point)
        return {light.type, {light.p, {}, 0, 1}, sample_sphere(u_d), pmf, 1 / (4 * pi), light.L};
    LightSample y = {light.p, light.L, 0, 1};  // of a sun
    if (light.type == LightType::infinite) y = {-sample_sphere(u_d), light.L, 0, 1 / (4 * pi)};
    return emission_from_disk(scene, light.type, pmf, y, u_y);
}

/// Connects the point on the light itself to the camera; nothing for point and distant lights.
///   area: Le / (pmf pdf_A) cos_y We cos_c V / d^2;    sky: Le / (pmf pdf_w) We cos_c V
inline Splat connect_light(const Scene& scene, const Pinhole& camera, const Emission& e,
                           float time) {
    bool sky = e.type == LightType::infinite;
    if (!sky && e.type != LightType::area) return {};
    Vec3 away = sky ? -e.d : e.y.p - camera.view.o;
    std::optional<CameraImportance> importance = camera_importance(camera, away);
    float d = length(away), cos_y = -dot(away, e.y.n) / d;
    if (!importance || cos_y <= 0) return {};
    Rgb L = e.Le * (importance->We_cos / (sky ? e.pmf * e.pdf_w : e.pmf * e.y.pdf / cos_y * d * d));
    float t_max = sky ? infinity : d - e.y.eps / cos_y;
    if (occluded(scene, {camera.view.o, away / d, t_max, time})) return {};
    return {importance->pixel, L};
}

/// x with its normals turned to the side of direction w.
inline Hit seen_from(const Scene& scene, const Hit& x, Vec3 w) {
    Vec3 n = smooth_normal(scene, x), ng = x.ng;
    bool front = x.front;
    if (dot(w, ng) < 0) n = -n, ng = -ng, front = !front;
    if (dot(w, n) <= 0) n = ng;  // a smoothed normal that faces away cannot be used
    return {x.p, n, ng, x.eps, x.t, x.time, x.material, front, x.light, x.prim};
}

/// The adjoint BSDF times the cosine: the factor of flux that arrives from wi and leaves to wo.
///
///   f(wo, wi) |wi.n| |wo.ng| / |wi.ng|,    n: the smoothed normal, ng if that faces away from wo
///
/// source  Veach 1997      tested by  "agreement: smoothed normals", within 5 standard errors
inline Rgb adjoint_bsdf(const Scene& scene, const Hit& x, Vec3 wi, Vec3 wo) {
    Hit seen = seen_from(scene, x, wo);
    return eval_bsdf(seen, wo, wi) * std::abs(dot(wi, seen.n) / dot(wi, x.ng) * dot(wo, x.ng));
}

/// Connects x, where flux arrives from wi, to the camera.      flux f cos We V / d^2
/// Mirrors and glass: nothing, since their f is 0 in the direction of the pinhole.
inline Splat connect_to_camera(const Scene& scene, const Pinhole& camera, const Hit& x, Vec3 wi,
                               Rgb flux) {
    Vec3 away = x.p - camera.view.o;
    std::optional<CameraImportance> importance = camera_importance(camera, away);
    if (!importance || is_specular(*x.material)) return {};
    float d = length(away);
    Vec3 wo = -1 / d * away;
    Rgb L = flux * adjoint_bsdf(scene, x, wi, wo) * (importance->We_cos / (d * d));
    if (is_black(L) || occluded(scene, spawn_ray(x, wo, d))) return {};
    return {importance->pixel, L};
}

/// Samples the direction in which light from wi leaves x; s.f holds f cos of the adjoint BSDF.
/// Refraction scales radiance by 1 / eta^2, but not flux: that factor is removed again.
/// source  Veach 1997      tested by  "truth: flux through a pane ...", within 5 standard errors
inline BsdfSample sample_light_bsdf(const Scene& scene, const Hit& x, Vec3 wi, float u1, Vec2 u2) {
    Hit y = x;
    if (x.material->type == MaterialType::diffuse) y.n = x.ng;  // to sample every possible wo
    BsdfSample s = sample_bsdf(y, wi, u1, u2);
    if (s.pdf_w == 0) return s;
    if (!s.specular) s.f = adjoint_bsdf(scene, x, wi, s.wi);
    if (!s.specular) return s;
    bool through = dot(s.wi, x.ng) < 0;
    float eta = x.front ? x.material->ior : 1 / x.material->ior;
    s.f *= std::abs(dot(wi, x.n) / dot(wi, x.ng) * dot(s.wi, x.ng)) * (through ? eta * eta : 1);
    return s;
}

/// Traces one path from a light, and splats the contribution of each vertex to its pixel.
///
/// Unbiased up to scene.max_depth scattering events, except that what the camera sees in mirrors or
/// through glass is missing. Var ~ 1 / d^2 for surfaces at a small distance d from the pinhole.
/// source  Arvo 1986; Dutre, Willems 1995
/// tested by  "ch20 light tracing", within 5 standard errors
inline void trace_light(const Scene& scene, const Endpoints& endpoints, Splats& splats,
                        Sampler& sampler, Recorder& recorder) {
    // Choose a light, a point on it and a direction; connect the light to the camera.
    if (scene.lights.empty() && endpoints.p_image == 0) return;
    double u = to_unit_double(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, endpoints, u, u_y, sampler.u2());
    recorder.start_at_light(e.y.p);
    auto add = [&](const Splat& seen) {
        if (!is_black(seen.L)) splats.push_back(seen), recorder.splat(seen.L, seen.pixel);
    };
    float time = scene.moves ? sample_time(scene.camera, sampler.u1()) : 0;
    add(connect_light(scene, endpoints.camera, e, time));
    float cos_y = e.type == LightType::point ? 1 : dot(e.d, e.y.n);
    Rgb flux = e.Le * (cos_y / (e.pmf * e.y.pdf * e.pdf_w)), beta = {1, 1, 1};
    Ray ray = {e.y.p + e.y.eps * e.y.n, e.d, infinity, time};
    for (int depth = 1; depth <= scene.max_depth; depth++) {
        // Find the next vertex, and connect it to the camera.
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) return;
        recorder.vertex(x);
        Vec3 wi = -ray.d;
        add(connect_to_camera(scene, endpoints.camera, *x, wi, flux * beta));
        if (depth == scene.max_depth) return recorder.cut();

        // Sample the next direction. beta does not include the flux, so roulette ignores it too.
        float u1 = sampler.u1();
        BsdfSample s = sample_light_bsdf(scene, *x, wi, u1, sampler.u2());
        if (s.pdf_w == 0) return;
        beta *= s.f / s.pdf_w;
        if (is_black(beta)) return;
        recorder.scatter(s, beta);

        // Russian roulette: stop with probability 1 - q, else divide by q to compensate.
        float q = survival_probability(beta, depth - 1);
        if (sampler.u1() >= q) return;
        beta /= q;
        recorder.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace ch20
