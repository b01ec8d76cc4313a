// Chapter 10: cosine sampling. Sample directions in proportion to the cosine in the integrand.
//
//   f cos / pdf_w = (albedo / pi) cos / (cos / pi) = albedo
#pragma once
#include "common/light/light_shapes.h"
#include "common/material/bsdf.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

namespace ch10 {

/// A direction of the hemisphere around +z, with density proportional to its cosine z.
///
///   r = sqrt(u1),  phi = 2 pi u2,  z = sqrt(1 - u1);      pdf_w = cos / pi
///
/// A uniform point of the unit disk, projected up to the sphere. u in [0,1)^2; z in (0,1].
/// source  Malley 1988      tested by  "density: cosine hemisphere", chi^2 at 1e-6
inline Vec3 sample_cosine_hemisphere(Vec2 u) {
    return from_cylindrical(std::sqrt(u.x), u.y, std::sqrt(1 - u.x));
}
inline float pdf_cosine_hemisphere(float cos) { return cos / pi; }
/// Finds the u of a direction, in [0,1]^2: u2 is its angle around z, in turns.
inline Vec2 invert_cosine_hemisphere(Vec3 w) {
    float phi = std::atan2(w.y, w.x);
    return {1 - w.z * w.z, (phi < 0 ? phi + 2 * pi : phi) / (2 * pi)};
}

/// The BSDF f(x, wo, wi) in sr^-1, without the cosine; 0 for mirrors and glass (Dirac deltas).
///
///   diffuse:  f = reflectance / pi  on wo's side of the surface
inline Rgb eval_bsdf(const Hit& x, Vec3 /*wo*/, Vec3 wi) {
    if (x.material->type != MaterialType::diffuse) return {};
    if (dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return {};
    return x.material->reflectance / pi;
}

/// The density of sample_bsdf for wi, in sr^-1; 0 for mirrors and glass (Dirac deltas).
inline float pdf_bsdf(const Hit& x, Vec3 /*wo*/, Vec3 wi) {
    if (x.material->type != MaterialType::diffuse) return 0;
    if (dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return 0;
    return pdf_cosine_hemisphere(dot(wi, x.n));
}

/// Samples the next direction of the path. u1 chooses reflection or refraction, u2 the direction.
inline BsdfSample sample_bsdf(const Hit& x, Vec3 wo, float u1, Vec2 u2) {
    switch (x.material->type) {
        case MaterialType::diffuse: {
            Vec3 wi = Frame(x.n).to_world(sample_cosine_hemisphere(u2));
            return {wi, eval_bsdf(x, wo, wi), pdf_bsdf(x, wo, wi)};
        }
        case MaterialType::conductor: return sample_mirror(x, wo);
        case MaterialType::dielectric: return sample_dielectric(x, wo, u1);
    }
    return {};
}

/// A sampled point or direction of a light, seen from x. pdf_w == 0: no sample, no contribution.
struct LightSample {
    Vec3 wi;             // unit, from x to the light
    Rgb Le;              // W m^-2 sr^-1, of point and distant lights W m^-2; without f, cos, V
    float dist = 0;      // m: length of the shadow ray, which ends just before the light
    float pdf_w = 0;     // sr^-1; for a point or distant light the probability of choosing it
    bool delta = false;  // a point or distant light: no path can hit it
};

/// Samples a point y of an area light; pdf_w is the density of its direction seen from x.
///
/// zero    if y faces away, is edge-on, or is x itself (cos_y is then not a number)
/// error   unbiased; Var <= about 2 mean^2, however near, for one shape that is all in front of x
/// source  Shirley et al. 1996      tested by  "variance: near-light", within 5 standard errors
inline LightSample sample_area_light(const Scene& scene, size_t light, const Hit& x, Vec2 u) {
    LightPoint y = sample_solid_angle(scene, light, x.p, u);
    Vec3 to_y = y.p - x.p;
    float d = length(to_y);
    Vec3 wi = to_y / d;
    float cos_y = -dot(wi, y.n);
    if (scene.lights[light].two_sided) cos_y = std::abs(cos_y);
    if (!(cos_y > 0)) return {};
    return {wi, scene.lights[light].L, d - (x.eps + y.eps) / cos_y, y.pdf};
}

/// One light: its point or direction as seen from x. The sky is drawn from the hemisphere around n.
inline LightSample sample_one_light(const Scene& scene, size_t i, const Hit& x, Vec2 u) {
    const Light& light = scene.lights[i];
    switch (light.type) {
        case LightType::area: return sample_area_light(scene, i, x, u);
        case LightType::point: {
            Vec3 to_y = light.p - x.p;
            float d2 = dot(to_y, to_y);
            if (d2 == 0) return {};
            return {to_y / std::sqrt(d2), light.L / d2, std::sqrt(d2), 1, true};
        }
        case LightType::distant: return {light.p, light.L, infinity, 1, true};
        case LightType::infinite: {
            Vec3 wi = sample_cosine_hemisphere(u);
            float pdf_w = pdf_cosine_hemisphere(wi.z);
            return {Frame(x.n).to_world(wi), light.L, infinity, pdf_w};
        }
    }
    return {};
}

/// Chooses one of the N lights uniformly, and a point on it.      pdf_w: that of the light / N
inline LightSample sample_light(const Scene& scene, const Hit& x, float u1, Vec2 u2) {
    size_t N = scene.lights.size();
    if (N == 0) return {};
    size_t i = std::min(static_cast<size_t>(u1 * static_cast<float>(N)), N - 1);
    LightSample y = sample_one_light(scene, i, x, u2);
    y.pdf_w /= static_cast<float>(N);
    return y;
}

/// Estimates the direct light that x scatters to wo, from one point of one light.
///
///   Ld = f Le V cos / pdf_w
///
/// Mirrors and glass: 0, since their f is 0 for every direction that light sampling finds.
inline Rgb direct_light(const Scene& scene, const Hit& x, Vec3 wo, LightNumbers u,
                        Recorder& recorder) {
    if (x.material->type != MaterialType::diffuse) return {};
    LightSample y = sample_light(scene, x, static_cast<float>(u.light), u.point);
    if (y.pdf_w == 0) return {};
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (dot(y.wi, x.n) / y.pdf_w);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, y.pdf_w, pdf_bsdf(x, wo, y.wi));
    return Ld;
}

/// Estimates Li, the radiance that arrives along the ray, from one path.
///
///   L = Le(x_0) + sum over k of  beta_k Ld(x_k) (+ beta_k Le(x_k) behind a mirror or glass)
///
/// Emission that the path hits counts only directly from the camera and after mirrors and glass.
/// Elsewhere it is already part of Ld at the vertex before.
/// Unbiased up to scene.max_depth scattering events.
/// source  Kajiya 1986, importance sampling      tested by  "ch10 cosine sampling",
///   within 5 standard errors
inline Rgb trace(const Scene& scene, Ray ray, Sampler& sampler, Recorder& recorder) {
    Rgb L, beta = {1, 1, 1};
    bool count_emission = true;
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add the light emitted there, unless the vertex before has sampled it.
        Rgb Le = !count_emission ? Rgb{} : x ? emission(scene, *x) : scene.sky;
        L += beta * Le;
        recorder.emitted(Le);
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Sample a light.
        Vec3 wo = -ray.d;
        LightNumbers u = {sampler.u1(), sampler.u2()};
        L += beta * direct_light(scene, *x, wo, u, recorder);

        // Sample the next direction, and divide by its density.
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        count_emission = s.specular;
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s, beta);

        // Russian roulette: stop with probability 1 - q, else divide by q to compensate.
        float q = survival_probability(beta, depth);
        if (sampler.u1() >= q) return L;
        beta /= q;
        recorder.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace ch10
