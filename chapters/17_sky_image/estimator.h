// Chapter 17: light from an image of the sky. Pixels brighter than the mean are sampled as lights.
//
//   pmf_i = max(0, L_i - mean L) w_i / sum of those,    w_i: solid angle of pixel i
#pragma once
#include "common/path/lens.h"
#include "common/path/many_lights.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/scene/intersect.h"
#include "common/scene/sky_image.h"

namespace ch17 {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;
using many_lights::Candidates, many_lights::choose_candidates, many_lights::compute_inclusions;
using many_lights::direct_light, many_lights::mis_emission;

/// The cumulative distribution (CDF) of light sampling: entry i is the probability of the pixels
/// before i, the last entry is 1. All are 0 for an image of one colour: no pixel exceeds the mean.
///
///   pmf_i = max(0, L_i - mean L) w_i / sum,    mean L = sum of L_i w_i / sum of w_i
///
/// Subtracting the mean is MIS compensation: BSDF sampling finds uniform light well, so light
/// sampling concentrates on what is brighter. 1e-6: allows for rounding of the mean.
/// source  Karlik et al. 2019
/// tested by  "density: the image's density sums to 1, or is 0", within 5 standard errors
inline std::vector<double> image_cdf(const SkyImage& image, bool compensate) {
    double light = 0, sphere = 0;
    std::vector<double> w, cdf = {0};
    for (size_t i = 0; i < image.pixels.size(); i++) {
        w.push_back(double{solid_angle_per_area(image, image.middle_of(i))});
        light += double{average(image.pixels[i])} * w[i], sphere += w[i];
    }
    double mean = compensate ? (1 + 1e-6) * light / sphere : 0;
    for (size_t i = 0; i < image.pixels.size(); i++)
        cdf.push_back(cdf[i] + std::max(0.0, double{average(image.pixels[i])} - mean) * w[i]);
    double sum = cdf.back() > 0 ? cdf.back() : 1;
    for (double& c : cdf) c /= sum;
    return cdf;
}

/// The lights of chapter 15, and the CDF that chooses pixels of the sky's image.
struct LightsAndSky : many_lights::Lights {
    std::vector<double> image_cdf;
};
inline LightsAndSky prepare(const Scene& scene, int M = 64, bool compensate = true) {
    many_lights::Lights lights = many_lights::prepare(scene, M);
    if (!scene.sky_image) return {lights, {}};
    return {lights, image_cdf(*scene.sky_image, compensate)};
}

/// The density of direction uv, in pixel i.     pdf_w = pmf_i pixels / (solid angle per area at uv)
inline float pdf_image(const SkyImage& image, const std::vector<double>& cdf, size_t i, Vec2 uv) {
    double pmf = cdf[i + 1] - cdf[i], pixels = static_cast<double>(image.pixels.size());
    return static_cast<float>(pmf * pixels) / solid_angle_per_area(image, uv);
}

/// Samples a direction. Le and pdf_w are the pixel's, even if rounding moves the point out of it.
inline LightSample sample_image(const SkyImage& image, const std::vector<double>& cdf, double u,
                                Vec2 u2) {
    size_t i = static_cast<size_t>(std::upper_bound(&cdf[1], &cdf.back(), u) - &cdf[1]);
    Vec2 uv = image.point_in(i, u2);
    return {direction_of(image, uv), image.pixels[i], infinity, pdf_image(image, cdf, i, uv)};
}

/// Estimates the image's light that x scatters to wo; 0 for an image of one colour.
///   Ld = mis_l f Le V cos / pdf_l
/// tested by  "truth: skies of known irradiance", within 5 standard errors + 0.1 %
inline Rgb image_light(const Scene& scene, const std::vector<double>& cdf, const Hit& x, Vec3 wo,
                       LightNumbers u, Recorder& recorder) {
    if (is_specular(*x.material) || cdf.back() == 0) return {};
    LightSample y = sample_image(*scene.sky_image, cdf, u.light, u.point);
    float pdf_b = pdf_bsdf(x, wo, y.wi), mis_l = power_heuristic(y.pdf_w, pdf_b);
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (mis_l * dot(y.wi, x.n) / y.pdf_w);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi))) return {};
    recorder.direct(Ld, y.wi, y.pdf_w, pdf_b, mis_l);
    return Ld;
}

/// The image's radiance in direction wi, in which the path left the scene, times mis_b. pdf_b: the
/// density of wi; infinite if light sampling cannot sample wi, so that mis_b = 1.
inline Rgb image_emission(const Scene& scene, const std::vector<double>& cdf, Vec3 wi, float pdf_b,
                          Recorder& recorder) {
    if (!scene.sky_image) return {};
    Vec2 uv = point_of(*scene.sky_image, wi);
    size_t i = scene.sky_image->pixel_at(uv);
    float mis_b = power_heuristic(pdf_b, pdf_image(*scene.sky_image, cdf, i, uv));
    recorder.emitted(scene.sky_image->pixels[i], mis_b);
    return scene.sky_image->pixels[i] * mis_b;
}

/// The random numbers of all light samples of one vertex.
struct DirectNumbers {
    TwoLightNumbers lights;
    std::optional<LightNumbers> image;
};
inline DirectNumbers draw_numbers(const Scene& scene, const LightsAndSky& lights,
                                  Sampler& sampler) {
    DirectNumbers u = {two_light_numbers(sampler, scene.lights.size(), lights.M), {}};
    if (scene.sky_image) u.image = {to_unit_double(sampler.u2()), sampler.u2()};
    return u;
}

/// Estimates Li, the radiance that arrives along the ray, from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events.
/// source  Veach, Guibas 1995      tested by  "ch17 sky image",
///   where nothing is new exactly as the chapter before, else within 5 standard errors
inline Rgb trace(const Scene& scene, const LightsAndSky& lights, Ray ray, Sampler& sampler,
                 Recorder& recorder) {
    // Sample a point of the lens and a time.
    if (scene.camera.lens_radius > 0) ray = through_lens(scene.camera, ray, sampler.u2());
    if (scene.moves) ray.time = sample_time(scene.camera, sampler.u1());

    Rgb L, beta = {1, 1, 1};
    Candidates c;            // at the previous vertex
    float pdf_b = infinity;  // of its sampled direction; infinite if light sampling cannot find it
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add the light emitted there, times its MIS weight.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le)) {
            float mis_b = pdf_b < infinity ? mis_emission(scene, lights, c, pdf_b, x) : 1;
            L += beta * Le * mis_b;
            recorder.emitted(Le, mis_b);
        }
        if (!x) return L + beta * image_emission(scene, lights.image_cdf, ray.d, pdf_b, recorder);
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Sample the next direction.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());

        // Sample two lights and the image.
        DirectNumbers u = draw_numbers(scene, lights, sampler);
        choose_candidates(lights, *x, wo, u.lights.candidates, c);
        compute_inclusions(scene, lights, c);
        L += beta * direct_light(scene, lights, c, u.lights, recorder);
        if (u.image) L += beta * image_light(scene, lights.image_cdf, *x, wo, *u.image, recorder);

        // Continue in that direction, and divide by its density.
        pdf_b = s.specular ? infinity : s.pdf_w;
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s, beta);

        // Russian roulette: stop with probability 1 - q, else divide by q to compensate.
        float q = survival_probability(2.5f * beta, depth);  // 2.5: an exercise of chapter 08
        if (sampler.u1() >= q) return L;
        beta /= q;
        recorder.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace ch17
