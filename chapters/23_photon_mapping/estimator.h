// Chapter 23: photon mapping. The first step sends light out, and stores what arrives at diffuse
// surfaces as photons. The second follows camera paths, and estimates the light at a point from the
// photons around it:
//
//   Lo = rho / pi  sum over photons nearer than r of  K(d / r) flux / (pi r^2)
#pragma once
#include <memory>

#include "chapters/23_photon_mapping/photon_maps.h"
#include "common/base/parallel.h"
#include "common/light/light_shapes.h"
#include "common/path/lens.h"
#include "common/path/light_paths.h"
#include "common/path/method.h"
#include "common/path/mis.h"
#include "common/path/roulette.h"

namespace ch23 {

using glossy_bsdf::pdf_bsdf, sky_light::image_emission, sky_light::image_light;

/// What the user asks for.
struct PhotonSettings {
    SamplerType sampler = SamplerType::independent;
    uint32_t seed = 0;
    int light_paths = 100000;  // in each pass
    bool final_gathering = true;
    float radius = 0;  // m, of the disk in which photons count; 0: by the photons
};

/// Traces one of `paths` light paths, and stores its vertices with the flux that arrives there.
///
///   flux = Le cos_y / (pmf pdf_A pdf_w paths) beta
///
/// source  Jensen 1996
/// tested by  "truth: flux onto a floor, from every light ...", within 5 standard errors + 1 %
inline void trace_light_path(const Scene& scene, const Endpoints& endpoints, int paths,
                             Sampler& sampler, std::vector<LightVertex>& vertices) {
    if (scene.lights.empty() && endpoints.p_image == 0) return;
    double u = to_unit_double(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, endpoints, u, u_y, sampler.u2());
    float cos_y = e.type == LightType::point ? 1 : dot(e.d, e.y.n);
    Rgb beta = {1, 1, 1};
    Rgb flux = e.Le * (cos_y / (e.pmf * e.y.pdf * e.pdf_w * static_cast<float>(paths)));
    Ray ray = {e.y.p + e.y.eps * e.y.n, e.d};
    for (int depth = 1; depth <= scene.max_depth; depth++) {
        // Find the next vertex, and store it.
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) return;
        Vec3 wi = -ray.d;
        float cosines = std::max(0.0f, dot(wi, smooth_normal(scene, *x))) / dot(wi, x->ng);
        vertices.push_back({x->p, x->ng, flux * beta, cosines, depth, x->material});

        // Sample the next direction as in chapter 20.
        float u1 = sampler.u1();
        BsdfSample s = sample_light_bsdf(scene, *x, wi, u1, sampler.u2());
        float u_q = sampler.u1();
        if (s.pdf_w == 0) return;
        beta *= s.f / s.pdf_w;
        float q = survival_probability(beta, depth - 1);
        if (is_black(beta) || u_q >= q) return;
        beta /= q;
        ray = spawn_ray(*x, s.wi);
    }
}

/// First step: traces the light paths. The order of the vertices does not depend on threads.
inline std::vector<LightVertex> trace_light_paths(const Scene& scene, const Endpoints& endpoints,
                                                  const PhotonSettings& settings, uint32_t pass,
                                                  int threads, const Stopped& stopped) {
    constexpr int at_once = 1024;
    int paths = settings.light_paths, parts = (paths + at_once - 1) / at_once;
    std::vector<std::vector<LightVertex>> of_part(static_cast<size_t>(parts));
    parallel_for(parts, threads, [&](int part) {
        if (stopped()) return;
        Sampler sampler(settings.sampler, settings.seed, static_cast<uint32_t>(paths));
        for (int i = part * at_once; i < std::min((part + 1) * at_once, paths); i++) {
            start_sample(sampler, pass, 1, static_cast<uint32_t>(i));
            trace_light_path(scene, endpoints, paths, sampler, of_part[static_cast<size_t>(part)]);
        }
    });
    std::vector<LightVertex> vertices;
    for (const auto& some : of_part) vertices.insert(vertices.end(), some.begin(), some.end());
    return vertices;
}

/// The first radius: what the user asks for, or one that suits the photons of a trial. The trial's
/// photons are independent of each other and of the seed.
inline float choose_radius(const Scene& scene, const Endpoints& endpoints,
                           const PhotonSettings& settings) {
    if (settings.radius > 0) return settings.radius;
    std::vector<SeenPoint> points = seen_points(scene);
    if (points.empty()) return scene.radius / 100;
    PhotonSettings trial = settings;
    trial.sampler = SamplerType::independent, trial.seed = 0;
    trial.light_paths = 4 * std::min(settings.light_paths, 1 << 15);
    auto vertices = trace_light_paths(scene, endpoints, trial, 0, 1, [] { return false; });
    double share = static_cast<double>(trial.light_paths) / settings.light_paths;
    PhotonMaps maps = build_maps(std::move(vertices), 4 * pixel_width(points), false);
    const PhotonMap& sharp = maps.caustic.size() > 0 ? maps.caustic : maps.global;
    return first_radius(points, maps.global, sharp.photons(), share);
}

/// Estimates the light that x reflects, from the photons of a map that are near to x.
///
///   Lo = rho / pi  sum over photons nearer than r of  K(d / r) flux / (pi r^2)
///
/// Photons count only if they lie on the same surface: their normal is within 45 degrees, and they
/// are in a disk that is an eighth as thick as it is wide. `depth`: scattering events that are
/// left. Biased: an average over the disk, which is half empty at an edge.
/// source  Jensen 1996
/// tested by  "truth: light at an edge and in a corner", within 5 standard errors
inline Rgb gather(const PhotonMaps& maps, const PhotonMap& map, const Hit& x, int depth,
                  Recorder& recorder) {
    Rgb sum;
    float r = map.radius();
    map.for_each_near(x.p, [&](const Photon& photon, Vec3 v) {
        bool same_surface = dot(photon.ng, x.ng) > std::numbers::sqrt2_v<float> / 2;
        if (!same_surface || std::abs(dot(v, x.ng)) > r / 8) return;
        if (photon.depth > depth) return;
        float q = dot(v, v) / (r * r);
        Rgb flux = kernel(q) * photon.flux_at(x);
        sum += flux;
        recorder.photon(flux, q, maps.vertices, photon);
    });
    Rgb scale = x.material->reflectance / (pi * pi * r * r);
    recorder.gathered(scale);
    return scale * sum;
}

/// Estimates the light that travels from the lights straight to x and on to wo. Where x is rough
/// metal, BSDF sampling may find the same light.      Ld = mis_l f Le V cos / pdf_l
inline Rgb direct_light(const Scene& scene, const Endpoints& endpoints, const Hit& x, Vec3 wo,
                        LightNumbers u, Recorder& recorder) {
    if (is_specular(*x.material)) return {};
    LightSample y = sample_light(scene, endpoints.lights, x, u.light, u.point);
    if (y.pdf_w == 0) return {};
    float pdf_b = is_diffuse(*x.material) || y.delta ? 0 : pdf_bsdf(x, wo, y.wi);
    float mis_l = power_heuristic(y.pdf_w, pdf_b);
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (mis_l * dot(y.wi, x.n) / y.pdf_w);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, y.pdf_w, pdf_b, mis_l);
    return Ld;
}

/// The weight of emission that a camera path finds at y. `last`: its last vertex that is neither
/// mirror nor glass, if there is one. Behind a diffuse vertex light sampling and the caustic map
/// find all of this light: 0.
inline float mis_emission(const Scene& scene, const Endpoints& endpoints,
                          const std::optional<Hit>& last, Vec3 wi, float pdf_b,
                          const std::optional<Hit>& y) {
    if (last && is_diffuse(*last->material)) return 0;
    if (!last || pdf_b == infinity) return 1;
    size_t light = static_cast<size_t>(y ? y->light : scene.sky_light);
    float pdf_w = y ? pdf_one_light(scene, light, *last, *y) : pdf_sky(*last, wi);
    return power_heuristic(pdf_b, pmf_light(endpoints.lights, light) * pdf_w);
}

/// Second step: estimates Li along the ray. The path continues via mirrors, glass and rough metal
/// to a diffuse vertex, and gathers photons there or (final gathering) at the next one.
///
/// Biased, since it uses photons near a point and not at it; more passes do not reduce the bias.
/// source  Jensen 1996      tested by  "ch23 photon mapping", within 5 standard errors + 1 %
inline Rgb trace(const Scene& scene, const Endpoints& endpoints, const PhotonMaps& maps, Ray ray,
                 Sampler& sampler, Recorder& recorder) {
    if (scene.camera.lens_radius > 0) ray = through_lens(scene.camera, ray, sampler.u2());
    Rgb L, beta = {1, 1, 1};
    std::optional<Hit> last;  // the last vertex that is neither mirror nor glass
    float pdf_b = infinity;   // of the ray's direction; infinite after a mirror or the camera
    bool is_last = !maps.final_gathering;  // the next diffuse vertex ends the path
    for (int depth = 0;; depth++) {
        // Find the next vertex, and the light that it emits.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le)) {
            float mis_b = mis_emission(scene, endpoints, last, ray.d, pdf_b, x);
            L += beta * Le * mis_b;
            recorder.emitted(Le, mis_b);
        }
        bool in_caustics = last && is_diffuse(*last->material) && pdf_b == infinity;
        if (!x && !in_caustics)
            L += beta * image_emission(scene, endpoints.image_cdf, ray.d, pdf_b, recorder);
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Gather photons: all where the path ends, else those of caustics.
        if (is_diffuse(*x->material)) {
            const PhotonMap& map = is_last ? maps.global : maps.caustic;
            L += beta * gather(maps, map, *x, scene.max_depth - depth, recorder);
            if (is_last) return L;
            is_last = true;
        }

        // Sample a light.
        Vec3 wo = -ray.d;
        LightNumbers u = {to_unit_double(sampler.u2()), sampler.u2()};
        L += beta * direct_light(scene, endpoints, *x, wo, u, recorder);
        if (scene.sky_image) {
            LightNumbers u_image = {to_unit_double(sampler.u2()), sampler.u2()};
            L += beta * image_light(scene, endpoints.image_cdf, *x, wo, u_image, recorder);
        }

        // Sample the BSDF for the next direction.
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        float u_q = sampler.u1();
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s, beta);
        float q = survival_probability(beta, depth);
        if (u_q >= q) return L;
        beta /= q;
        recorder.roulette(q, beta);
        if (!s.specular) last = *x;
        pdf_b = s.specular ? infinity : s.pdf_w;
        ray = spawn_ray(*x, s.wi);
    }
}

/// The chapter's passes: new photons for each sample of all pixels.
inline Method photon_passes(const Scene& scene, PhotonSettings settings) {
    auto endpoints = std::make_shared<Endpoints>(endpoints_of(scene));
    auto maps = std::make_shared<PhotonMaps>();
    settings.radius = choose_radius(scene, *endpoints, settings);
    Method method = method_of<trace>(endpoints, maps);
    method.prepare = [=, &scene](uint32_t pass, int threads, const Stopped& stopped) {
        auto vertices = trace_light_paths(scene, *endpoints, settings, pass, threads, stopped);
        *maps = build_maps(std::move(vertices), settings.radius, settings.final_gathering);
    };
    method.first_radius = settings.radius;
    return method;
}

}  // namespace ch23
