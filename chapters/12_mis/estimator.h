// Chapter 12: multiple importance sampling. Look for light in every way there is, and trust each
// way where it is good.
//
//   L = mis_l f Le V cos / pdf_l + mis_b f Le cos / pdf_b,    mis_l + mis_b = 1 for every direction
#pragma once
#include "common/light/light_resampling.h"
#include "common/material/bsdf.h"
#include "common/material/metal.h"
#include "common/material/optics.h"
#include "common/path/path_log.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"

namespace ch12 {

/// How normals of microfacets spread on a rough conductor, in the frame where z is the normal:
/// D(h) = alpha^2 / (pi (sin^2 + alpha^2 cos^2)^2).                             (GGX)
/// source  Walter et al. 2007      tested by  "density: GGX normals"
inline float ggx_D(Vec3 h, float alpha) {
    float a2 = alpha * alpha, d = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    return a2 / (pi * d * d);
}
/// By which facets hide each other: G1(w) = 1 / (1 + Lambda(w)).     source  Smith 1967; Heitz 2014
inline float ggx_lambda(Vec3 w, float alpha) {
    float tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return (std::sqrt(1 + alpha * alpha * tan2) - 1) / 2;
}
/// A microfacet normal among those that wo sees: pdf(h) = G1(wo) D(h) wo.h / cos_o. Stretched to
/// alpha = 1, it is drawn from a cap of the sphere.
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

/// f and density of a rough conductor on wo's side, both in sr^-1; wi turns by twice h's angle:
///
///   f = D(h) F(wo.h) G(wo, wi) / (4 cos_o cos_i),  h = (wo + wi) / |wo + wi|;  pdf(h) / (4 wo.h)
inline Rgb eval_rough_conductor(const Hit& x, Vec3 wo, Vec3 wi) {
    Frame frame(x.n);
    Vec3 o = frame.to_local(wo), i = frame.to_local(wi), h = normalize(o + i);
    float alpha = x.material->alpha;
    float G = 1 / (1 + ggx_lambda(o, alpha) + ggx_lambda(i, alpha));
    Rgb F = fresnel_conductor(dot(o, h), x.material->eta, x.material->k);
    return F * (ggx_D(h, alpha) * G / (4 * o.z * i.z));
}
inline float pdf_rough_conductor(const Hit& x, Vec3 wo, Vec3 wi) {
    Frame frame(x.n);
    Vec3 o = frame.to_local(wo), h = normalize(o + frame.to_local(wi));
    float cos_oh = dot(o, h);
    return cos_oh > 0 ? pdf_ggx_normal(o, x.material->alpha, h) / (4 * cos_oh) : 0;
}

/// f(x, wo, wi) in sr^-1, without the cosine; 0 for mirrors and glass, where no wi but one counts.
inline Rgb eval_bsdf(const Hit& x, Vec3 wo, Vec3 wi) {
    if (is_specular(*x.material) || dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return {};
    if (x.material->type == MaterialType::diffuse) return x.material->reflectance / pi;
    return eval_rough_conductor(x, wo, wi);
}
/// The density, in sr^-1, with which sample_bsdf draws wi; 0 for mirrors and glass.
inline float pdf_bsdf(const Hit& x, Vec3 wo, Vec3 wi) {
    if (is_specular(*x.material) || dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return 0;
    if (x.material->type == MaterialType::diffuse) return pdf_cosine_hemisphere(dot(wi, x.n));
    return pdf_rough_conductor(x, wo, wi);
}

/// Glass sends the path on by reflection or by refraction: by chance, so that it stays one path.
///
///   P_R = R (Fresnel), P_T = 1 - R;  f cos / P = 1 for reflection, 1 / eta^2 for refraction
///
/// eta: index beyond over index here. Radiance is squeezed by 1 / eta^2 where it enters glass, and
/// gets it back where it leaves.      source  Veach 1997, sec. 5.2
inline BsdfSample sample_dielectric(const Hit& x, Vec3 wo, float u) {
    float eta = x.front ? x.material->ior : 1 / x.material->ior;
    float cos_o = dot(wo, x.n), R = fresnel_dielectric(cos_o, eta);
    if (u < R) {
        float f = R / cos_o;
        return {reflect(wo, x.n), {f, f, f}, R, true};
    }
    std::optional<Vec3> wi = refract(wo, x.n, eta);
    if (!wi) return {};
    float f = (1 - R) / (eta * eta) / std::abs(dot(*wi, x.n));
    return {*wi, {f, f, f}, 1 - R, true};
}

/// Draws the direction in which the path goes on. u1 chooses what happens, u2 the direction.
inline BsdfSample sample_bsdf(const Hit& x, Vec3 wo, float u1, Vec2 u2) {
    switch (x.material->type) {
        case MaterialType::diffuse: {
            Vec3 wi = Frame(x.n).to_world(sample_cosine_hemisphere(u2));
            return {wi, eval_bsdf(x, wo, wi), pdf_bsdf(x, wo, wi)};
        }
        case MaterialType::conductor: {
            if (!is_specular(*x.material)) {
                Frame frame(x.n);
                Vec3 h = sample_ggx_normal(frame.to_local(wo), x.material->alpha, u2);
                Vec3 wi = reflect(wo, frame.to_world(h));
                return {wi, eval_bsdf(x, wo, wi), pdf_bsdf(x, wo, wi)};
            }
            float cos_o = dot(wo, x.n);
            Rgb F = fresnel_conductor(cos_o, x.material->eta, x.material->k);
            return {reflect(wo, x.n), F / cos_o, 1, true};
        }
        case MaterialType::dielectric: return sample_dielectric(x, wo, u1);
    }
    return {};
}

/// Which ways of looking for light are used, and how they share it.
enum class Strategy : uint8_t { bsdf, light, mis, one_sample };
enum class Heuristic : uint8_t { balance, power };
struct Settings {
    Strategy strategy = Strategy::mis;
    Heuristic heuristic = Heuristic::power;
    int M = 64;  // light candidates for one shadow ray, but no more than there are lights
};
inline Settings settings;

inline void prepare(Scene& scene) {
    scene.light_table = build_alias_table(light_pmf(scene, 0));
    prepare_light_bounds(scene);
}

/// The ways of looking for light, each with its number of samples times its density, in sr^-1.
struct Densities {
    float resampled = 0;  // the best of M lights by power: nearly M pmf, but never above 1
    float uniform = 0;    // one light, all alike: finds what power and potential misjudge
    float bsdf = 0;
};

/// The densities with which each way finds a direction that lies on `light`.
inline Densities densities(const Scene& scene, size_t light, float pdf_one, float pdf_b) {
    float N = static_cast<float>(scene.lights.size());
    float M = std::min(static_cast<float>(settings.M), N);
    float best = std::min(1.0f, M * pmf_light(scene, light));
    bool both = settings.strategy != Strategy::light;
    return {best * pdf_one, N > 1 ? pdf_one / N : 0, both ? pdf_b : 0};
}

/// The weight of a direction that was drawn in one way, and could have been drawn in others.
///
///   balance: a / sum d_k;  power: a^2 / sum d_k^2      a: of `way`; d_k: of each, sr^-1
/// Ratios d_k / a neither overflow nor make 0 / 0. a > 0; a may be infinite.
/// source  Veach, Guibas 1995      tested by  "identity: MIS weights sum to 1"
inline float mis_weight(float Densities::*way, const Densities& d) {
    float sum = 1;
    for (auto k : {&Densities::resampled, &Densities::uniform, &Densities::bsdf}) {
        float ratio = k == way ? 0 : d.*k / d.*way;
        sum += settings.heuristic == Heuristic::power ? ratio * ratio : ratio;
    }
    return 1 / sum;
}

/// Light from one point y of a light that was chosen with probability 1 / W.
inline Rgb light_from(const Scene& scene, const Hit& x, Vec3 wo, size_t light, Vec2 u, float W,
                      float Densities::*way, Rgb beta, PathLog& log) {
    LightSample y = sample_one_light(scene, light, x, u);
    if (y.pdf_w == 0 || W == 0) return {};
    Rgb f = eval_bsdf(x, wo, y.wi);
    Densities d = densities(scene, light, y.pdf_w, y.delta ? 0 : pdf_bsdf(x, wo, y.wi));
    float mis_l = mis_weight(way, d);
    Rgb Ld = f * y.Le * (mis_l * dot(y.wi, x.n) / y.pdf_w * W);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    return log.direct(beta * Ld, y.wi, d.*way, d.bsdf, mis_l);
}

/// How much of a light's potential a rough conductor turns to wo, and the BSDF does not find:
/// mis_l f + 0.05, f and mis_l towards the light's centre. 0.05: its other points may differ.
inline float lobe_share(const Scene& scene, size_t light, const Hit& x, Vec3 wo) {
    if (scene.lights[light].type != LightType::area) return 1;
    const LightShape& shape = scene.light_shapes[light];
    Vec3 to_y = shape.centre - x.p;
    float d2 = std::max(dot(to_y, to_y), shape.radius * shape.radius);
    Vec3 wi = to_y / std::sqrt(d2);
    Densities d = densities(scene, light, d2 / shape.area, pdf_bsdf(x, wo, wi));
    return mis_weight(&Densities::resampled, d) * average(eval_bsdf(x, wo, wi)) + 0.05f;
}

/// Draws M lights by power, and keeps one in proportion to its potential at x, with the MIS weight
/// inside: candidates of which the BSDF takes care are not chosen.
inline Kept resample_lights(const Scene& scene, const Hit& x, Vec3 wo, int M, Sampler& sampler) {
    Candidates c = draw_candidates(scene, x, M, sampler.u1());
    if (x.material->type == MaterialType::conductor) {
        for (int i = 0; i < M; i++) {
            if (c.p_hat[i] == 0) continue;
            float share = lobe_share(scene, static_cast<size_t>(c.light[i]), x, wo);
            c.p_hat[i] *= share, c.weight[i] *= share;
        }
    }
    return keep_one(c, sampler.u1());
}

/// What either side counts at a vertex: in one-sample MIS a coin lets one look, which counts twice.
struct Chances {
    float light = 1, bsdf = 1;
};
inline Chances draw_chances(Sampler& sampler) {
    if (settings.strategy == Strategy::bsdf) return {0, 1};
    if (settings.strategy == Strategy::light) return {1, 0};
    if (settings.strategy == Strategy::mis) return {};
    return sampler.u1() < 0.5f ? Chances{2, 0} : Chances{0, 2};
}

/// Estimates what all lights send by way of x to wo, in the two ways that aim at lights.
/// source  Veach, Guibas 1995; Talbot et al. 2005      tested by  "truth: MIS in one dimension"
inline Rgb direct_light(const Scene& scene, const Hit& x, Vec3 wo, Sampler& sampler, Rgb beta,
                        PathLog& log) {
    if (is_specular(*x.material) || is_black(beta)) return {};
    size_t N = scene.lights.size();
    if (N == 0) return {};
    if (N == 1) {
        return light_from(scene, x, wo, 0, sampler.u2(), 1, &Densities::resampled, beta, log);
    }
    int M = std::min(settings.M, static_cast<int>(N));
    Kept kept = resample_lights(scene, x, wo, M, sampler);
    Rgb L = light_from(scene, x, wo, kept.light, sampler.u2(), kept.W, &Densities::resampled, beta,
                       log);
    float count = static_cast<float>(N);
    size_t any = std::min(static_cast<size_t>(sampler.u1() * count), N - 1);
    return L + light_from(scene, x, wo, any, sampler.u2(), count, &Densities::uniform, beta, log);
}

/// The weight of emission that the direction s, drawn at x, has met: in y, or else in the sky.
inline float mis_emission(const Scene& scene, const Hit& x, const BsdfSample& s, Chances chances,
                          const Hit* y) {
    if (s.specular) return 1;
    if (settings.strategy == Strategy::bsdf || chances.bsdf == 0) return chances.bsdf;
    size_t light = static_cast<size_t>(y != nullptr ? y->light : scene.sky_light);
    float pdf_one = y != nullptr ? pdf_one_light(scene, light, x, *y) : pdf_sky(x, s.wi);
    return chances.bsdf * mis_weight(&Densities::bsdf, densities(scene, light, pdf_one, s.pdf_w));
}

/// Estimates Li along the ray from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events. Nowhere much worse than the better strategy.
/// source  Veach, Guibas 1995      tested by  "ch12 mis"
[[gnu::flatten]] inline Rgb trace(const Scene& scene, Ray ray, Sampler& sampler, PathLog& log) {
    Rgb L, beta = {1, 1, 1};
    Hit last;
    BsdfSample s{{}, {}, 0, true};  // as if the camera were a mirror: it has aimed at no light
    Chances chances;
    for (int depth = 0;; depth++) {
        // Find the next vertex. A path that leaves the scene ends in the sky.
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) {
            if (is_black(scene.sky)) return L;
            float mis_b = mis_emission(scene, last, s, chances, nullptr);
            return L + log.emitted(beta * scene.sky * mis_b, mis_b);
        }
        log.vertex(*x);

        // Add what shines there, as far as it is this strategy's share.
        Rgb Le = emission(scene, *x);
        if (!is_black(Le)) {
            float mis_b = mis_emission(scene, last, s, chances, &*x);
            L += log.emitted(beta * Le * mis_b, mis_b);
        }
        if (depth == scene.max_depth) {
            log.cut();
            return L;
        }

        // Choose a direction, then aim at a light: so the processor works on both rays at once.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        s = sample_bsdf(*x, wo, u1, sampler.u2());
        chances = draw_chances(sampler);
        L += direct_light(scene, *x, wo, sampler, beta * chances.light, log);

        // Go on in that direction, and count it for all those that were not taken.
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        log.scatter(s.wi, s.f, s.pdf_w, s.specular, beta);

        // Play roulette: stop with probability 1 - q, else stand in for those that stopped.
        float q = survival_probability(beta, depth);
        if (sampler.u1() >= q) return L;
        beta /= q;
        log.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
        last = *x;
    }
}

}  // namespace ch12
