// taught by chapter 18
// The path tracer of many lights, with lens, shutter, image of the sky, and wavelengths.
#pragma once
#include "common/material/observer.h"
#include "common/path/image_light.h"
#include "common/path/lens.h"
#include "common/path/many_lights.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"

namespace dispersion {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;
using many_lights::Candidates, many_lights::choose_candidates;
using many_lights::direct_light, many_lights::mis_emission;
using sky_light::DirectNumbers, sky_light::LightsAndSky;
using sky_light::draw_numbers, sky_light::image_emission, sky_light::prepare;

/// The one wavelength of a path, what the path counts for in each channel, and the glass it meets.
struct Wavelength {
    float micrometres = 0;
    Rgb weight;
    Material glass = {};
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

/// Gives the glass at x the index of refraction that it has at this wavelength.
inline void set_index(Hit& x, Wavelength& light) {
    light.glass = *x.material;
    light.glass.ior = index_of_refraction(*light.glass.glass, double{light.micrometres});
    x.material = &light.glass;
}

/// Estimates Li along the ray from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events. Nowhere much worse than the best way.
/// source  Veach, Guibas 1995      tested by  "ch18 dispersion"
inline Rgb trace(const Scene& scene, const LightsAndSky& lights, const std::vector<Rgb>& white,
                 Ray ray, Sampler& sampler, Recorder& recorder) {
    // Choose a point of the lens, and a time.
    if (scene.camera.lens_radius > 0) ray = through_lens(scene.camera, ray, sampler.u2());
    if (!scene.movers.empty()) ray.time = sample_time(scene.camera, sampler.u1());

    Rgb L, beta = {1, 1, 1};
    Candidates c;            // at the vertex before
    float pdf_b = infinity;  // of the direction drawn there; infinite: no light sample can be it
    std::optional<Wavelength> light;  // none before glass that disperses
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add what shines there, as far as it is this way's share.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le)) {
            float mis_b = pdf_b < infinity ? mis_emission(scene, lights, c, pdf_b, x) : 1;
            L += beta * Le * mis_b;
            recorder.emitted(Le, mis_b);
        }
        if (!x) return L + beta * image_emission(scene, lights, ray.d, pdf_b, recorder);
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Draw a wavelength at the first glass that disperses, and refract by its index.
        if (x->material->glass != nullptr) {
            if (!light) light = sample_wavelength(white, sampler.u1()), beta *= light->weight;
            set_index(*x, *light);
        }

        // Draw the direction to go on in.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());

        // Aim at two lights, and at the image.
        DirectNumbers u = draw_numbers(scene, lights, sampler);
        choose_candidates(scene, lights, *x, wo, u.lights.candidates, c);
        L += beta * direct_light(scene, lights, c, u.lights, recorder);
        if (u.image) L += beta * image_light(scene, lights, *x, wo, *u.image, recorder);

        // Go on in that direction, and count it for all those that were not taken.
        pdf_b = s.specular ? infinity : s.pdf_w;
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

}  // namespace dispersion
