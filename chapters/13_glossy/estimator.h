// Chapter 13: glossy metal. Rough metal consists of tiny mirrors: sample the normal of one of them.
//
//   f = D(h) F(wo.h) G(wo, wi) / (4 cos_o cos_i),    pdf_w(wi) = pdf(h) / (4 wo.h)
#pragma once
#include "common/light/light_table.h"
#include "common/material/basic_bsdf.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

namespace ch13 {

/// The GGX distribution of microfacet normals, in the frame where z is the surface normal:
/// D(h) = alpha^2 / (pi (sin^2 + alpha^2 cos^2)^2)
/// source  Walter et al. 2007      tested by  "density: GGX normals", chi^2 at 1e-6
inline float ggx_D(Vec3 h, float alpha) {
    float a2 = alpha * alpha, d = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    return a2 / (pi * d * d);
}
/// Smith's Lambda: the projected area of facets that face away from w, / cos.   source  Heitz 2014
inline float ggx_lambda(Vec3 w, float alpha) {
    float tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return (std::sqrt(1 + alpha * alpha * tan2) - 1) / 2;
}
/// Samples a microfacet normal visible from wo: pdf(h) = G1(wo) D(h) wo.h / cos_o. Stretched to
/// alpha = 1, the visible normals follow from a uniform point on a cap of the sphere.
/// source  Heitz 2018; Dupuy, Benyoub 2023
inline Vec3 sample_ggx_normal(Vec3 wo, float alpha, Vec2 u) {
    Vec3 w = normalize({alpha * wo.x, alpha * wo.y, wo.z});
    float z = (1 - u.x) * (1 + w.z) - w.z;
    float r = std::sqrt(std::max(0.0f, 1 - z * z));
    Vec3 h = from_cylindrical(r, u.y, z) + w;
    return normalize({alpha * h.x, alpha * h.y, h.z});
}
inline float pdf_ggx_normal(Vec3 wo, float alpha, Vec3 h) {
    return ggx_D(h, alpha) * std::max(0.0f, dot(wo, h)) / ((1 + ggx_lambda(wo, alpha)) * wo.z);
}
inline Vec2 invert_ggx_normal(Vec3 wo, float alpha, Vec3 h) {
    Vec3 w = normalize({alpha * wo.x, alpha * wo.y, wo.z});
    Vec3 n = normalize({h.x / alpha, h.y / alpha, h.z}), c = 2 * dot(n, w) * n - w;
    float phi = std::atan2(c.y, c.x);
    return {1 - (c.z + w.z) / (1 + w.z), (phi < 0 ? phi + 2 * pi : phi) / (2 * pi)};
}

/// The BSDF of a rough conductor, in sr^-1; h ~ wo + wi. Below: its sampling density, and a sample.
inline Rgb eval_rough_conductor(const Hit& x, Vec3 wo, Vec3 wi) {
    Frame frame(x.n);
    Vec3 o = frame.to_local(wo), i = frame.to_local(wi), h = normalize(o + i);
    if (o.z <= 0) return {};  // wo along the surface or below it
    float alpha = x.material->alpha;
    float G = 1 / (1 + ggx_lambda(o, alpha) + ggx_lambda(i, alpha));
    Rgb F = fresnel_conductor(dot(o, h), x.material->eta, x.material->k);
    return F * (ggx_D(h, alpha) * G / (4 * o.z * i.z));
}
inline float pdf_rough_conductor(const Hit& x, Vec3 wo, Vec3 wi) {
    Frame frame(x.n);
    Vec3 o = frame.to_local(wo), h = normalize(o + frame.to_local(wi));
    float cos_oh = dot(o, h);
    return o.z > 0 && cos_oh > 0 ? pdf_ggx_normal(o, x.material->alpha, h) / (4 * cos_oh) : 0;
}
inline BsdfSample sample_rough_conductor(const Hit& x, Vec3 wo, Vec2 u) {
    Frame frame(x.n);
    Vec3 h = sample_ggx_normal(frame.to_local(wo), x.material->alpha, u);
    Vec3 wi = reflect(wo, frame.to_world(h));
    if (dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return {};
    return {wi, eval_rough_conductor(x, wo, wi), pdf_rough_conductor(x, wo, wi)};
}

/// The BSDF f(x, wo, wi) in sr^-1, without the cosine; 0 for mirrors and glass (Dirac deltas).
inline Rgb eval_bsdf(const Hit& x, Vec3 wo, Vec3 wi) {
    if (!is_rough(*x.material)) return basic_bsdf::eval_bsdf(x, wo, wi);
    if (dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return {};
    return eval_rough_conductor(x, wo, wi);
}

/// The density of sample_bsdf for wi, in sr^-1; 0 for mirrors and glass (Dirac deltas).
inline float pdf_bsdf(const Hit& x, Vec3 wo, Vec3 wi) {
    if (!is_rough(*x.material)) return basic_bsdf::pdf_bsdf(x, wo, wi);
    if (dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return 0;
    return pdf_rough_conductor(x, wo, wi);
}

/// Samples the next direction of the path. u1 chooses reflection or refraction, u2 the direction.
inline BsdfSample sample_bsdf(const Hit& x, Vec3 wo, float u1, Vec2 u2) {
    if (!is_rough(*x.material)) return basic_bsdf::sample_bsdf(x, wo, u1, u2);
    return sample_rough_conductor(x, wo, u2);
}

/// The table that lights are chosen from.
inline LightTable prepare(const Scene& scene) { return build_light_table(light_pmf(scene, 0.25)); }

/// Estimates the direct light that x scatters to wo, from one point of one light.
///
///   Ld = f Le V cos / pdf_w
///
/// Mirrors and glass: 0, since their f is 0 for every direction that light sampling finds.
inline Rgb direct_light(const Scene& scene, const LightTable& lights, const Hit& x, Vec3 wo,
                        LightNumbers u, Recorder& recorder) {
    if (is_specular(*x.material)) return {};
    LightSample y = sample_light(scene, lights, x, u.light, u.point);
    if (y.pdf_w == 0) return {};
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (dot(y.wi, x.n) / y.pdf_w);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, y.pdf_w, pdf_bsdf(x, wo, y.wi));
    return Ld;
}

/// How paths find light: by sampling the BSDF only, or by sampling lights only.
enum class Strategy : uint8_t { bsdf, light };

/// Estimates Li, the radiance that arrives along the ray, from one path.
///
///   L = Le(x_0) + sum over k of  beta_k Ld(x_k) (+ beta_k Le(x_k) behind a mirror or glass)
///
/// bsdf: all emission that the path hits counts, and no light is sampled. light: emission counts
/// only directly from the camera and after mirrors and glass.
/// Unbiased, but bsdf never finds point and distant lights.      source  Veach, Guibas 1995, fig. 2
/// tested by  "ch13 glossy", within 5 standard errors; light: exactly as 11 without rough metal
inline Rgb trace(const Scene& scene, const LightTable& lights, Strategy strategy, Ray ray,
                 Sampler& sampler, Recorder& recorder) {
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

        // Sample a light, if that is the strategy.
        Vec3 wo = -ray.d;
        LightNumbers u = {to_unit_double(sampler.u2()), sampler.u2()};
        if (strategy == Strategy::light) {
            L += beta * direct_light(scene, lights, *x, wo, u, recorder);
        }

        // Sample the next direction, and divide by its density.
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        count_emission = s.specular || strategy == Strategy::bsdf;
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

}  // namespace ch13
