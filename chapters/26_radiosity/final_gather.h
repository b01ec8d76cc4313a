// How a solution is seen: the radiosity of the patch at a point, or of all that the point sees.
#pragma once
#include <memory>

#include "chapters/26_radiosity/patches.h"
#include "common/light/light_table.h"
#include "common/material/basic_bsdf.h"

namespace ch26 {

enum class Show : uint8_t { constant, smooth, gather };

/// What is shown.
struct Shown {
    std::shared_ptr<const Patches> patches;
    std::vector<std::array<Rgb, 3>> B;  // of each patch, at its corners, W m^-2
    Show show = Show::smooth;
    LightTable lights;  // for final gathers
};

/// B at a point of a surface, W m^-2: linear between the corners of its patch; black where there is
/// no patch.
inline Rgb radiosity_at(const Shown& shown, const Hit& x) {
    Place at = place_of(*shown.patches, x);
    if (at.patch == Piece::none) return {};
    const auto& b = shown.B[at.patch];
    return at.b[0] * b[0] + at.b[1] * b[1] + at.b[2] * b[2];
}

/// What x reflects to wo, W m^-2 sr^-1, by a path of `bounces` bounces, for this point and not for
/// its patch. Lights are sampled at each bounce; the last bounce finds the radiosity of a patch,
/// without what it emits.
/// tested by  "agreement: the final gather with chapter 15, block by block within 2 %"
inline Rgb final_gather(const Scene& scene, const Shown& shown, Hit x, Vec3 wo, Sampler& sampler,
                        int bounces = 1) {
    Rgb L, beta = {1, 1, 1};
    while (true) {
        x.n = x.ng;
        double u = to_unit_double(sampler.u2());
        LightSample y = sample_light(scene, shown.lights, x, u, sampler.u2());
        BsdfSample s = basic_bsdf::sample_bsdf(x, wo, 0, sampler.u2());
        if (y.pdf_w > 0 && !occluded(scene, spawn_ray(x, y.wi, y.dist)))
            L += beta * (basic_bsdf::eval_bsdf(x, wo, y.wi) * y.Le * (dot(y.wi, x.n) / y.pdf_w));
        if (s.pdf_w == 0) return L;
        auto z = intersect(scene, spawn_ray(x, s.wi));
        if (!z) return L;
        float cos_over_pdf = dot(s.wi, x.n) / s.pdf_w;
        if (--bounces == 0) {
            Rgb reflected = radiosity_at(shown, *z) / pi - emission(scene, *z);
            return L + beta * (s.f * reflected * cos_over_pdf);
        }
        beta = beta * s.f * cos_over_pdf;
        x = *z, wo = -s.wi;
    }
}

}  // namespace ch26
