// Whether a solution can be right: its numbers, its balance of energy, and paths in the same room.
#pragma once
#include "chapters/26_radiosity/show.h"
#include "common/light/light_table.h"
#include "common/material/basic_bsdf.h"
#include "common/path/method.h"
#include "common/rendering/render_film.h"

namespace ch26 {

/// What x reflects to wo, W m^-2 sr^-1, by a path of 16 bounces. Lights are sampled at each bounce;
/// the last bounce finds the radiosity of a patch, without what it emits.
/// tested by  "furnace: a closed cube that emits 1 ..."
inline Rgb by_path(const Scene& scene, const Shown& shown, const LightTable& lights, Hit x, Vec3 wo,
                   Sampler& sampler) {
    Rgb L, beta = {1, 1, 1};
    for (int bounces = 16;; bounces--) {
        x.n = x.ng;
        double u = to_unit_double(sampler.u2());
        LightSample y = sample_light(scene, lights, x, u, sampler.u2());
        BsdfSample s = basic_bsdf::sample_bsdf(x, wo, 0, sampler.u2());
        if (y.pdf_w > 0 && !occluded(scene, spawn_ray(x, y.wi, y.dist)))
            L += beta * (basic_bsdf::eval_bsdf(x, wo, y.wi) * y.Le * (dot(y.wi, x.n) / y.pdf_w));
        if (s.pdf_w == 0) return L;
        auto z = intersect(scene, spawn_ray(x, s.wi));
        if (!z) return L;
        float cos_over_pdf = dot(s.wi, x.n) / s.pdf_w;
        if (bounces == 1) {
            Rgb reflected = radiosity_at(shown, *z) / pi - emission(scene, *z);
            return L + beta * (s.f * reflected * cos_over_pdf);
        }
        beta = beta * s.f * cos_over_pdf;
        x = *z, wo = -s.wi;
    }
}

/// The light that surfaces reflect to the camera, W m^-2 sr^-1, mean of the picture: by patches,
/// and by paths.
struct Comparison {
    double patches = 0, paths = 0;
    double error = 0, rounding = 0;  // of their difference: standard error; at most

    /// Whether the two differ by more than 5 % and than noise and rounding explain.
    bool differ() const { return std::abs(patches - paths) > 0.05 * paths + 2 * error + rounding; }
};

/// Compares a picture of 64 x 64 pixels with 16 paths for each, for at most o.time.
/// tested by  "failure: patches wider than their distance to a light: too bright, and a warning"
inline Comparison compare_with_paths(const Scene& scene, const Shown& shown,
                                     const RenderOptions& o) {
    Scene small = scene;
    small.width = small.height = 64, small.spp = 16;
    LightTable lights = build_light_table(light_pmf(small, 0.25));
    auto film_of = [&](const auto& value) {
        Method trace = [&](const Scene&, Ray ray, Sampler& sampler, Recorder&) {
            std::optional<Hit> x = intersect(small, ray);
            return x ? value(*x, -ray.d, sampler) : Rgb{};
        };
        return render_film(small, o, trace).film;
    };
    auto paths = [&](const Hit& x, Vec3 wo, Sampler& sampler) {
        return by_path(small, shown, lights, x, wo, sampler);
    };
    auto difference = [&](const Hit& x, Vec3 wo, Sampler& sampler) {
        Rgb by_patches = radiosity_at(shown, x) / pi - emission(small, x);
        return by_patches - paths(x, wo, sampler);
    };
    auto emitted = [&](const Hit& x, Vec3, Sampler&) { return emission(small, x); };
    double by_paths = film_of(paths).mean();
    Film more = film_of(difference);
    return {by_paths + more.mean(), by_paths, more.standard_error(),
            1e-5 * film_of(emitted).mean()};
}

}  // namespace ch26
