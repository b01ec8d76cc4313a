// Chapter 11: light importance. Choose lights by power, mixed with a uniform (defensive) choice,
// since power ignores distance and walls.
//
//   pmf_i = (1 - d) power_i / sum power + d / N      chosen in O(1), whatever N is
#pragma once
#include "common/light/lights.h"
#include "common/material/basic_bsdf.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

namespace ch11 {

using basic_bsdf::eval_bsdf, basic_bsdf::pdf_bsdf, basic_bsdf::sample_bsdf;

/// The power of a light, in W. A: its area; R: radius of the scene; light.L is L, I or E.
///
///   area  pi A L;  point  4 pi I;  distant  pi R^2 E;  sky  4 pi^2 R^2 L
inline float light_power(const Scene& scene, size_t i) {
    const Light& light = scene.lights[i];
    float L = average(light.L), R = scene.radius;
    switch (light.type) {
        case LightType::area:
            return pi * scene.light_shapes[i].area * L * (light.two_sided ? 2 : 1);
        case LightType::point: return 4 * pi * L;
        case LightType::distant: return pi * R * R * L;
        case LightType::infinite: return 4 * pi * pi * R * R * L;
    }
    return 0;
}

/// The probability of each light: proportional to power, mixed with a uniform (defensive) share d.
///
///   pmf_i = (1 - d) power_i / sum power + d / N >= d / N
inline std::vector<double> light_pmf(const Scene& scene, double d) {
    std::vector<double> pmf;
    double sum = 0, N = static_cast<double>(scene.lights.size());
    for (size_t i = 0; i < scene.lights.size(); i++) {
        pmf.push_back(static_cast<double>(light_power(scene, i)));
        sum += pmf.back();
    }
    for (double& p : pmf) {
        double by_power = (1 - d) * p / sum, defensive = d / N;
        p = sum > 0 ? by_power + defensive : 1 / N;
    }
    return pmf;
}

/// Column i of the alias table: it holds light i and at most one other light.
struct AliasColumn {
    float own;       // share of the column that belongs to light i
    uint32_t other;  // the light that the rest of the column belongs to
    float pmf;       // probability of light i, over the whole table
};
using LightTable = std::vector<AliasColumn>;

/// Builds the alias table: N probabilities in N columns of equal height, at most two in each.
///
///   each column that is too low is filled up with a part of one that is too high
///
/// source  Walker 1974; Vose 1991      tested by  "identity: over all 2^24 ...", within 1e-5
inline LightTable build_light_table(const std::vector<double>& pmf) {
    size_t N = pmf.size();
    LightTable table(N);
    std::vector<double> height(N);
    std::vector<uint32_t> low, high;
    for (uint32_t i = 0; i < N; i++) {
        height[i] = pmf[i] * static_cast<double>(N);
        table[i] = {1, i, static_cast<float>(pmf[i])};
        (height[i] < 1 ? low : high).push_back(i);
    }
    while (!low.empty() && !high.empty()) {
        uint32_t l = low.back(), h = high.back();
        low.pop_back();
        table[l].own = static_cast<float>(height[l]);
        table[l].other = h;
        height[h] -= 1 - height[l];
        if (height[h] < 1) {
            high.pop_back();
            low.push_back(h);
        }
    }
    return table;
}

/// Chooses a light in O(1): first a column, then one of the two lights in it.
///
/// u is a double with 48 random bits. A random float has 24: of its 2^24 values, each of a million
/// columns would get only 17.
inline uint32_t pick_light(const LightTable& lights, double u) {
    int N = static_cast<int>(lights.size());
    double at = u * N;
    uint32_t column = static_cast<uint32_t>(std::min(static_cast<int>(at), N - 1));
    auto [own, other, pmf] = lights[column];
    return at - column < double{own} ? column : other;
}
inline float pmf_light(const LightTable& lights, size_t light) { return lights[light].pmf; }

/// Chooses a light by light_pmf(), and a point on it.      pdf_w: pmf times that of the light
inline LightSample sample_light(const Scene& scene, const LightTable& lights, const Hit& x,
                                double u, Vec2 u2) {
    if (lights.empty()) return {};
    size_t light = pick_light(lights, u);
    LightSample y = sample_one_light(scene, light, x, u2);
    y.pdf_w *= pmf_light(lights, light);
    return y;
}

inline constexpr double defensive_share = 0.25;  // d: a quarter of all choices

/// The table that trace() chooses lights from.
inline LightTable prepare(const Scene& scene) {
    return build_light_table(light_pmf(scene, defensive_share));
}

/// Estimates the direct light that x scatters to wo, from one point of one light.
///
///   Ld = f Le V cos / pdf_w
///
/// Mirrors and glass: 0, since their f is 0 for every direction that light sampling finds.
inline Rgb direct_light(const Scene& scene, const LightTable& lights, const Hit& x, Vec3 wo,
                        LightNumbers u, Recorder& recorder) {
    if (x.material->type != MaterialType::diffuse) return {};
    LightSample y = sample_light(scene, lights, x, u.light, u.point);
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
/// source  Shirley et al. 1996      tested by  "ch11 light importance", within 5 standard errors
inline Rgb trace(const Scene& scene, const LightTable& lights, Ray ray, Sampler& sampler,
                 Recorder& recorder) {
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
        LightNumbers u = {to_unit_double(sampler.u2()), sampler.u2()};
        L += beta * direct_light(scene, lights, *x, wo, u, recorder);

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

}  // namespace ch11
