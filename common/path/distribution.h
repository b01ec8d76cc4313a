// taught by chapter 16
// The path tracer of many lights, with lens, shutter, wavelength and sky.
#pragma once
#include "common/material/observer.h"
#include "common/path/many_lights.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"

namespace distribution {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;

/// Turns the pinhole's ray into one through a point of the lens that is sharp at the same place.
///
///   focus = o + F d / (depth of d);   o' = o + R sqrt(u1) (cos, sin)(2 pi u2);   d' = focus - o'
///
/// F and depths count along the camera's axis: what is sharp is a plane, not a sphere.
/// source  Cook, Porter, Carpenter 1984      tested by  "truth: circles of confusion"
inline Ray through_lens(const Camera& camera, Ray ray, Vec2 u) {
    Vec3 axis = cross(camera.right, camera.up);
    float depth = dot(ray.d, axis) / dot(camera.forward, axis);
    Vec3 focus = ray.o + camera.focal_distance / depth * ray.d;
    Vec3 p = from_cylindrical(camera.lens_radius * std::sqrt(u.x), u.y, 0);
    Vec3 o = ray.o + p.x * camera.right + p.y * camera.up;
    return {o, normalize(focus - o)};
}

/// A wavelength, and what a path of it counts for in each channel.
struct Wavelength {
    float micrometres = 0;
    Rgb weight;
};

/// Draws 10 nm of the spectrum, the likelier the more of white light they are, and a point in them.
///
///   weight = share / p,   p = average of share's channels:   E[weight] = sum of shares = white
///
/// tested by  "identity: all wavelengths together are white"
inline Wavelength sample_wavelength(const std::vector<Rgb>& shares, float u) {
    size_t i = 0;
    for (; i + 1 < shares.size() && u >= average(shares[i]); i++) u -= average(shares[i]);
    float p = average(shares[i]), bin = static_cast<float>(i) - 0.5f + std::min(u / p, 1.0f);
    double nm = observer_first_nm + observer_step_nm * double{bin};
    return {static_cast<float>(nm / 1000), shares[i] / p};
}

/// A scene's lights, the share of the sky's light before each pixel (and 1 at the end), and white.
struct Prepared {
    ManyLights lights;
    std::vector<double> sky;
    std::vector<Rgb> white = shares_of_white();
};
inline Prepared prepare(const Scene& scene, int M = 64) {
    std::vector<double> sky = {0};
    for (size_t i = 0; scene.sky_image && i < scene.sky_image->pixels.size(); i++) {
        float area = solid_angle_per_area(*scene.sky_image, scene.sky_image->middle_of(i));
        sky.push_back(sky.back() + double{average(scene.sky_image->pixels[i]) * area});
    }
    double sum = sky.back();
    for (double& share : sky) share /= sum;
    return {many_lights(scene, build_light_table(light_pmf(scene, 0)), M), sky};
}

/// The density at uv, in pixel i of the sky.      pdf_w = pmf pixels / (solid angle per area)
inline float pdf_sky_image(const SkyImage& sky, const std::vector<double>& cdf, size_t i, Vec2 uv) {
    double pmf = cdf[i + 1] - cdf[i], pixels = static_cast<double>(sky.pixels.size());
    return static_cast<float>(pmf * pixels) / solid_angle_per_area(sky, uv);
}

/// Estimates what the picture of the sky sends by way of x to wo, from a point in its pixel i. By
/// rounding the point may lie in the next pixel, which may be black: i tells Le and density.
///
///   Ld = mis_l f Le V cos / pdf_l      tested by  "truth: skies of known irradiance"
inline Rgb sky_light(const Scene& scene, const std::vector<double>& cdf, const Hit& x, Vec3 wo,
                     LightNumbers u, Recorder& recorder) {
    if (is_specular(*x.material)) return {};
    const SkyImage& sky = *scene.sky_image;
    auto chosen = std::upper_bound(cdf.begin() + 1, cdf.end() - 1, u.light) - cdf.begin() - 1;
    size_t i = static_cast<size_t>(chosen);
    Vec2 uv = sky.point_in(i, u.point);
    Vec3 wi = direction_of(sky, uv);
    float pdf_l = pdf_sky_image(sky, cdf, i, uv), pdf_b = pdf_bsdf(x, wo, wi);
    float mis_l = power_heuristic(pdf_l, pdf_b);
    Rgb Ld = eval_bsdf(x, wo, wi) * sky.pixels[i] * (mis_l * dot(wi, x.n) / pdf_l);
    if (!(max_component(Ld) > 0) || occluded(scene, spawn_ray(x, wi))) return {};  // or 0 / 0
    recorder.direct(Ld, wi, pdf_l, pdf_b, mis_l);
    return Ld;
}

/// Estimates Li along the ray from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events. Nowhere much worse than the best way.
/// source  Veach, Guibas 1995      tested by  "ch16 distribution"
inline Rgb trace(const Scene& scene, const Prepared& prepared, Ray ray, Sampler& sampler,
                 Recorder& recorder) {
    const ManyLights& lights = prepared.lights;
    const Camera& camera = scene.camera;
    if (camera.lens_radius > 0) ray = through_lens(camera, ray, sampler.u2());
    if (!scene.movers.empty())
        ray.time = std::lerp(camera.shutter_open, camera.shutter_close, sampler.u1());
    std::optional<Wavelength> light;  // that the path is of, once it has met such glass
    std::optional<Material> glass;    // as this light sees it
    Rgb L, beta = {1, 1, 1};
    Hit last;              // the vertex before
    float pdf_b = 0;       // of the direction that was drawn there
    bool only_way = true;  // nothing but this path could find what shines next
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add what shines there, as far as it is this way's share.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le)) {
            float mis_b = only_way ? 1 : mis_emission(scene, lights, last, ray.d, pdf_b, x);
            L += beta * Le * mis_b;
            recorder.emitted(Le, mis_b);
        }
        if (!x && scene.sky_image) {
            const SkyImage& sky = *scene.sky_image;
            Vec2 uv = point_of(sky, ray.d);
            float pdf_l = pdf_sky_image(sky, prepared.sky, sky.pixel_at(uv), uv);
            float mis_b = only_way ? 1 : power_heuristic(pdf_b, pdf_l);
            L += beta * sky.at(uv) * mis_b;
            recorder.emitted(sky.at(uv), mis_b);
        }
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Glass that disperses: from the first on, the path has one wavelength.
        if (x->material->glass != nullptr) {
            if (!light) {
                light = sample_wavelength(prepared.white, sampler.u1());
                beta *= light->weight;
            }
            glass = *x->material;
            glass->ior = index_of_refraction(*glass->glass, double{light->micrometres});
            x->material = &*glass;
        }

        // Draw the direction to go on in.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());

        // Aim at lights.
        bool choose = scene.lights.size() > 1;
        LightNumbers u = {choose ? to_unit_double(sampler.u2()) : 0, sampler.u2()};
        L += beta * direct_light(scene, lights, *x, wo, u, recorder);
        if (choose) {
            ResamplingNumbers v = {to_unit_double(sampler.u2()), sampler.u1(), sampler.u2()};
            L += beta * best_light(scene, lights, *x, wo, v, recorder);
        }
        if (scene.sky_image) {
            LightNumbers v = {to_unit_double(sampler.u2()), sampler.u2()};
            L += beta * sky_light(scene, prepared.sky, *x, wo, v, recorder);
        }

        // Go on in that direction, and count it for all those that were not taken.
        last = *x, pdf_b = s.pdf_w, only_way = s.specular;
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s, beta);

        // Play roulette: stop with probability 1 - q, else stand in for those that stopped.
        float q = survival_probability(2.5f * beta, depth);  // 2.5: an exercise of chapter 08
        if (sampler.u1() >= q) return L;
        beta /= q;
        recorder.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace distribution
