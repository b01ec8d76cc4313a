// Chapter 16: the lens and the shutter. A pixel is the average over its area, the lens and the time
// that the shutter is open: each path samples one point of all three.
//
//   pixel = 1 / (|A| |lens| |T|)  integral over A, lens and T of  L(path)
#pragma once
#include "common/path/many_lights.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/scene/intersect.h"

namespace ch16 {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;
using many_lights::Candidates, many_lights::Lights;
using many_lights::choose_candidates, many_lights::compute_inclusions;
using many_lights::direct_light, many_lights::mis_emission, many_lights::prepare;

/// Replaces the pinhole's ray by one through a random point of the lens, with the same focus point.
///
///   focus = o + F d / (depth of d);   o' = o + R sqrt(u1) (cos, sin)(2 pi u2);   d' = focus - o'
///
/// F and depths are measured along the camera's axis: the points in focus form a plane.
/// source  Cook, Porter, Carpenter 1984
/// tested by  "truth: circles of confusion", points within 1e-6, radii to 0.1 %
inline Ray through_lens(const Camera& camera, Ray ray, Vec2 u) {
    Vec3 axis = cross(camera.right, camera.up);
    float depth = dot(ray.d, axis) / dot(camera.forward, axis);
    Vec3 focus = ray.o + camera.focal_distance / depth * ray.d;
    Vec3 p = from_cylindrical(camera.lens_radius * std::sqrt(u.x), u.y, 0);
    Vec3 o = ray.o + p.x * camera.right + p.y * camera.up;
    return {o, normalize(focus - o)};
}

/// A uniformly distributed time at which the shutter is open, in s.
///
/// tested by  "truth: how long what moves covers a point", within 5 standard errors
inline float sample_time(const Camera& camera, float u) {
    return std::lerp(camera.shutter_open, camera.shutter_close, u);
}

/// Estimates Li, the radiance that arrives along the ray, from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events.
/// source  Veach, Guibas 1995      tested by  "ch16 lens ...",
///   where nothing is new exactly as the chapter before, else within 5 standard errors
inline Rgb trace(const Scene& scene, const Lights& lights, Ray ray, Sampler& sampler,
                 Recorder& recorder) {
    // Sample a point of the lens and a time.
    if (scene.camera.lens_radius > 0) ray = through_lens(scene.camera, ray, sampler.u2());
    if (scene.moves) ray.time = sample_time(scene.camera, sampler.u1());

    Rgb L, beta = {1, 1, 1};
    Candidates c;                 // at the previous vertex
    float pdf_b = 0;              // of the direction that was sampled there
    bool specular_bounce = true;  // light sampling cannot find the light hit next
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add the light emitted there, times its MIS weight.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le)) {
            float mis_b = specular_bounce ? 1 : mis_emission(scene, lights, c, pdf_b, x);
            L += beta * Le * mis_b;
            recorder.emitted(Le, mis_b);
        }
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Sample the next direction.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());

        // Sample lights.
        TwoLightNumbers u = two_light_numbers(sampler, scene.lights.size(), lights.M);
        choose_candidates(lights, *x, wo, u.candidates, c);
        compute_inclusions(scene, lights, c);
        L += beta * direct_light(scene, lights, c, u, recorder);

        // Continue in that direction, and divide by its density.
        pdf_b = s.pdf_w, specular_bounce = s.specular;
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

}  // namespace ch16
