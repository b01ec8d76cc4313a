// taught by chapter 13
// Rough metal, and the BSDF of all materials with it.
#pragma once
#include "common/material/basic_bsdf.h"

namespace glossy_bsdf {

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

}  // namespace glossy_bsdf
