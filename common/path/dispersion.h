// taught by chapter 18
// The path tracer of many lights, with lens, shutter, image of the sky, and wavelengths.
#pragma once
#include "common/material/spectrum.h"
#include "common/path/image_light.h"
#include "common/path/lens.h"
#include "common/path/many_lights.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"

namespace dispersion {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;
using many_lights::Candidates, many_lights::choose_candidates, many_lights::compute_inclusions;
using many_lights::direct_light, many_lights::mis_emission;
using sky_light::DirectNumbers, sky_light::LightsAndSky;
using sky_light::draw_numbers, sky_light::image_emission;
using sky_light::image_light, sky_light::prepare;

/// The wavelength of a path, its weight in each channel, and the glass with the wavelength's index.
struct Wavelength {
    float micrometres = 0;
    Rgb weight;
    Material glass = {};
};

/// Samples a wavelength: a 10 nm interval by its share of white light, and a point in it.
///
///   weight = share / p,   p = average of share's channels:   E[weight] = sum of shares = white
///
/// tested by  "identity: all wavelengths together are white", weights to 1e-5, mean within 3e-4
inline Wavelength sample_wavelength(const std::vector<Rgb>& shares, float u) {
    size_t i = 0;
    for (; i + 1 < shares.size() && u >= average(shares[i]); i++) u -= average(shares[i]);
    float p = average(shares[i]), bin = static_cast<float>(i) - 0.5f + std::min(u / p, 1.0f);
    double nm = observer_first_nm + observer_step_nm * double{bin};
    return {static_cast<float>(nm / 1000), shares[i] / p};
}

/// Sets the glass at x to its index of refraction at this wavelength.
inline void set_index(Hit& x, Wavelength& light) {
    light.glass = *x.material;
    light.glass.ior = index_of_refraction(*light.glass.glass, double{light.micrometres});
    x.material = &light.glass;
}

/// Estimates Li, the radiance that arrives along the ray, from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events.
/// source  Veach, Guibas 1995      tested by  "ch18 dispersion",
///   where nothing is new exactly as the chapter before, else within 5 standard errors
inline Rgb trace(const Scene& scene, const LightsAndSky& lights, const std::vector<Rgb>& white,
                 Ray ray, Sampler& sampler, Recorder& recorder) {
    // Sample a point of the lens and a time.
    if (scene.camera.lens_radius > 0) ray = through_lens(scene.camera, ray, sampler.u2());
    if (scene.moves) ray.time = sample_time(scene.camera, sampler.u1());

    Rgb L, beta = {1, 1, 1};
    Candidates c;            // at the previous vertex
    float pdf_b = infinity;  // of its sampled direction; infinite if light sampling cannot find it
    std::optional<Wavelength> light;  // none before the first dispersive glass
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

        // At the first dispersive glass, sample a wavelength; refract with its index.
        if (x->material->glass != nullptr) {
            if (!light) light = sample_wavelength(white, sampler.u1()), beta *= light->weight;
            set_index(*x, *light);
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

}  // namespace dispersion
