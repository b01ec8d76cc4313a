// Chapter 12: multiple importance sampling. Look for light in every way there is, and trust each
// way where it is good.
//
//   L = mis_l f Le V cos / pdf_l + mis_b f Le cos / pdf_b,    mis_l + mis_b = 1 for every direction
#pragma once
#include "common/bsdf.h"
#include "common/light_table.h"
#include "common/metal.h"
#include "common/optics.h"
#include "common/path_log.h"
#include "common/sampler.h"

namespace ch12 {

/// How normals of microfacets spread on a rough conductor, in the frame where z is the normal.
///
///   D(h) = alpha^2 / (pi (sin^2 + alpha^2 cos^2)^2)                        (GGX)
///
/// source  Walter et al. 2007      tested by  "density: GGX normals"
inline float ggx_D(Vec3 h, float alpha) {
    float a2 = alpha * alpha, d = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    return a2 / (pi * d * d);
}
/// Lambda, by which facets hide each other:  G1(w) = 1 / (1 + Lambda(w)),
/// G(wo, wi) = 1 / (1 + Lambda(wo) + Lambda(wi)).      source  Smith 1967; Heitz 2014
inline float ggx_lambda(Vec3 w, float alpha) {
    float tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return (std::sqrt(1 + alpha * alpha * tan2) - 1) / 2;
}
/// A microfacet normal among those that wo sees.
///
///   pdf(h) = G1(wo) D(h) wo.h / cos_o      stretch to alpha = 1, where it is a cap of the sphere
///
/// source  Heitz 2018; Dupuy, Benyoub 2023
inline Vec3 sample_ggx_normal(Vec3 wo, float alpha, Vec2 u) {
    Vec3 w = normalize({alpha * wo.x, alpha * wo.y, wo.z});
    float z = (1 - u.x) * (1 + w.z) - w.z, phi = 2 * pi * u.y;
    float r = std::sqrt(std::max(0.0f, 1 - z * z));
    Vec3 h = Vec3{r * std::cos(phi), r * std::sin(phi), z} + w;
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

/// f(x, wo, wi) in sr^-1, without the cosine; 0 for mirrors and glass, where no wi but one counts.
///
///   diffuse:          f = reflectance / pi  on wo's side of the surface
///   rough conductor:  f = D(h) F(wo.h) G(wo, wi) / (4 cos_o cos_i),  h = (wo + wi) / |wo + wi|
inline Rgb eval_bsdf(const Hit& x, Vec3 wo, Vec3 wi) {
    if (is_specular(*x.material) || dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return {};
    if (x.material->type == MaterialType::diffuse) return x.material->reflectance / pi;
    Frame frame(x.n);
    Vec3 o = frame.to_local(wo), i = frame.to_local(wi), h = normalize(o + i);
    float alpha = x.material->alpha;
    float G = 1 / (1 + ggx_lambda(o, alpha) + ggx_lambda(i, alpha));
    Rgb F = fresnel_conductor(dot(o, h), x.material->eta, x.material->k);
    return F * (ggx_D(h, alpha) * G / (4 * o.z * i.z));
}

/// The density, in sr^-1, with which sample_bsdf draws wi; 0 for mirrors and glass.
///
///   rough conductor:  pdf_w = pdf(h) / (4 wo.h), since wi turns by twice the angle of h
inline float pdf_bsdf(const Hit& x, Vec3 wo, Vec3 wi) {
    if (is_specular(*x.material) || dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return 0;
    if (x.material->type == MaterialType::diffuse) return pdf_cosine_hemisphere(dot(wi, x.n));
    Frame frame(x.n);
    Vec3 o = frame.to_local(wo), h = normalize(o + frame.to_local(wi));
    float cos_oh = dot(o, h);
    return cos_oh > 0 ? pdf_ggx_normal(o, x.material->alpha, h) / (4 * cos_oh) : 0;
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

/// The probability with which a path of throughput beta goes on.
///
///   q = the largest channel of beta, within [0.05, 0.95];  1 for the first few vertices
///
/// Taken from the largest channel, no channel's beta / q can grow from vertex to vertex. Below 1,
/// so that a path that loses nothing (mirrors, total reflection) ends as well.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 4) return 1;
    return std::clamp(max_component(beta), 0.05f, 0.95f);
}

/// Which ways of looking for light are used, and how they share it.
enum class Strategy : uint8_t { bsdf, light, mis };
enum class Heuristic : uint8_t { balance, power };
struct Settings {
    Strategy strategy = Strategy::mis;
    Heuristic heuristic = Heuristic::power;
    int M = 1;  // light candidates for one shadow ray
};
inline Settings settings;

/// The weight of a direction that strategy a drew, and b could have drawn.
///
///   balance: a / (a + b);  power: a^2 / (a^2 + b^2);      a, b: samples times density, sr^-1
///
/// Written in b / a, which neither overflows nor makes 0 / 0. a > 0.
/// source  Veach, Guibas 1995      tested by  "identity: MIS weights sum to 1"
inline float mis_weight(float a, float b) {
    float ratio = b / a;
    if (settings.heuristic == Heuristic::power) ratio *= ratio;
    return 1 / (1 + ratio);
}

/// Gets the scene ready for this chapter's trace().
inline void prepare(Scene& scene) { scene.light_table = build_alias_table(light_pmf(scene, 0.25)); }

/// One candidate, chosen among M by its unshadowed contribution.
struct Reservoir {
    LightSample y;
    Rgb f_Le_cos;          // of y: what it would send to wo if nothing were in between
    float weight_sum = 0;  // of all candidates so far

    /// Takes candidate c in place of y with probability weight / weight_sum.
    ///
    /// u in [0,1) decides, and is made uniform again for the next candidate.
    void offer(const LightSample& c, Rgb contribution, float weight, float& u) {
        if (!(weight > 0)) return;
        weight_sum += weight;
        float share = weight / weight_sum;
        if (u < share) {
            y = c, f_Le_cos = contribution;
            u /= share;
        } else {
            u = (u - share) / (1 - share);
        }
    }
};

/// mis_l of a candidate, and mis_b of a direction that met a light: the same two densities.
inline float mis_light(const LightSample& y, float pdf_b) {
    if (settings.strategy == Strategy::light || y.delta) return 1;
    return mis_weight(static_cast<float>(settings.M) * y.pdf_w, pdf_b);
}
inline float mis_bsdf(float pdf_b, float pdf_l) {
    if (settings.strategy != Strategy::mis) return settings.strategy == Strategy::bsdf ? 1 : 0;
    return mis_weight(pdf_b, static_cast<float>(settings.M) * pdf_l);
}

/// Estimates what all lights send by way of x to wo, by the best of M candidates.
///
///   p_hat(y) = average of mis_l f Le cos: with the weight inside, candidates of which the BSDF
///   takes care already are not chosen
///
/// source  Veach, Guibas 1995; Talbot et al. 2005      tested by  "truth: MIS in one dimension"
inline Rgb direct_light(const Scene& scene, const Hit& x, Vec3 wo, Sampler& sampler, Rgb beta,
                        PathLog& log) {
    if (is_specular(*x.material) || settings.strategy == Strategy::bsdf) return {};

    // Let the candidates compete.
    Reservoir kept;
    float u = sampler.u1();
    for (int i = 0; i < settings.M; i++) {
        float u1 = sampler.u1();
        LightSample c = sample_light(scene, x, u1, sampler.u2());
        if (c.pdf_w == 0) continue;
        Rgb f_Le_cos = eval_bsdf(x, wo, c.wi) * c.Le * std::max(0.0f, dot(c.wi, x.n));
        f_Le_cos *= mis_light(c, pdf_bsdf(x, wo, c.wi));
        kept.offer(c, f_Le_cos, average(f_Le_cos) / c.pdf_w, u);
    }
    if (kept.weight_sum == 0) return {};

    // Ask for shadow only where the winner is.
    const LightSample& y = kept.y;
    float W = kept.weight_sum / (static_cast<float>(settings.M) * average(kept.f_Le_cos));
    if (occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    float pdf_b = pdf_bsdf(x, wo, y.wi);
    return log.direct(beta * kept.f_Le_cos * W, y.wi, y.pdf_w, pdf_b, mis_light(y, pdf_b));
}

/// The weight of emission that the direction s, drawn at x, has met: in y, or else in the sky.
inline float mis_emission(const Scene& scene, const Hit& x, const BsdfSample& s, const Hit* y) {
    if (s.specular) return 1;
    if (settings.strategy != Strategy::mis) return mis_bsdf(0, 0);
    float pdf_l = 0;
    if (y != nullptr && y->light >= 0) {
        size_t light = static_cast<size_t>(y->light);
        pdf_l = pmf_light(scene, light) * pdf_one_light(scene, light, x, *y);
    } else if (y == nullptr && scene.sky_light >= 0) {
        pdf_l = pmf_light(scene, static_cast<size_t>(scene.sky_light)) * pdf_sky(x, s.wi);
    }
    return mis_bsdf(s.pdf_w, pdf_l);
}

/// Estimates Li along the ray from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events. Nowhere much worse than the better strategy.
/// source  Veach, Guibas 1995      tested by  "ch12 mis"
inline Rgb trace(const Scene& scene, Ray ray, Sampler& sampler, PathLog& log) {
    Rgb L, beta = {1, 1, 1};
    Hit last;
    BsdfSample s{{}, {}, 0, true};  // as if the camera were a mirror: it has aimed at no light
    for (int depth = 0;; depth++) {
        // Find the next vertex. A path that leaves the scene ends in the sky.
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) {
            float mis_b = is_black(scene.sky) ? 0 : mis_emission(scene, last, s, nullptr);
            return L + log.emitted(beta * scene.sky * mis_b, mis_b);
        }
        log.vertex(*x);

        // Add what shines there, as far as it is this strategy's share.
        Rgb Le = emission(scene, *x);
        if (!is_black(Le)) {
            float mis_b = mis_emission(scene, last, s, &*x);
            L += log.emitted(beta * Le * mis_b, mis_b);
        }
        if (depth == scene.max_depth) {
            log.cut();
            return L;
        }

        // Aim at a light.
        Vec3 wo = -ray.d;
        L += direct_light(scene, *x, wo, sampler, beta, log);

        // Go on in one direction, and count it for all those that were not taken.
        float u1 = sampler.u1();
        s = sample_bsdf(*x, wo, u1, sampler.u2());
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
