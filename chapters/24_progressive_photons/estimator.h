// Chapter 24: progressive photon mapping. The radius shrinks from pass to pass, but so slowly that
// the noise of the average of all passes still falls: bias and noise both go to 0.
//
//   (r_i+1 / r_i)^2 = (i + alpha) / (i + 1),    i = 1, 2, ...:    r_i ~ i^((alpha - 1) / 2)
#pragma once
#include <memory>

#include "common/light/light_shapes.h"
#include "common/path/lens.h"
#include "common/path/method.h"
#include "common/path/mis.h"
#include "common/path/photons.h"

namespace ch24 {

using glossy_bsdf::pdf_bsdf, sky_light::image_emission, sky_light::image_light;

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
/// Biased, since it uses photons near a point and not at it. The bias of the mean of all passes
/// goes to 0 with the radius.
/// source  Knaus, Zwicker 2011      tested by  "ch24 progressive photons", exactly as in 23
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

/// The radius of a pass, the same for all points.
///
///   (r_i+1 / r_i)^2 = (i + alpha) / (i + 1),    alpha = 2/3:    r_i ~ i^(-1/6)
///
/// After N passes bias^2 ~ r^4 ~ N^(-2/3), and variance ~ 1 / (N r^2) ~ N^(-2/3).
/// source  Hachisuka et al. 2008; Knaus, Zwicker 2011
/// tested by  "truth: radii shrink", to 1e-5
inline float radius_of(float first, uint32_t pass) {
    constexpr double alpha = 2.0 / 3;
    double r2 = 1;  // divided by the square of the first radius
    for (double i = 1; i <= pass; i++) r2 *= (i + alpha) / (i + 1);
    return first * static_cast<float>(std::sqrt(r2));
}

/// The chapter's passes: new photons and a smaller radius for each sample of all pixels.
inline Method photon_passes(const Scene& scene, PhotonSettings settings) {
    auto endpoints = std::make_shared<Endpoints>(endpoints_of(scene));
    auto maps = std::make_shared<PhotonMaps>();
    settings.radius = choose_radius(scene, *endpoints, settings);
    Method method = method_of<trace>(endpoints, maps);
    method.prepare = [=, &scene](uint32_t pass, int threads, const Stopped& stopped) {
        auto vertices = trace_light_paths(scene, *endpoints, settings, pass, threads, stopped);
        float radius = radius_of(settings.radius, pass);
        *maps = build_maps(std::move(vertices), radius, settings.final_gathering);
    };
    method.first_radius = settings.radius;
    return method;
}

}  // namespace ch24
