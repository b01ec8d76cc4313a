// taught by chapter 15
// Sampling two of many lights, each with its MIS weight.
#pragma once
#include <numeric>

#include "common/material/ggx.h"
#include "common/path/mis.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"

namespace many_lights {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;

/// The lights, and M, the number of candidates at each vertex (all lights if there are fewer).
struct Lights {
    LightTable table;
    std::vector<LightBounds> bounds;  // power: divided by candidates
    std::vector<float> candidates;    // expected number of times that each light is a candidate
    int M;
    std::vector<uint32_t> always = {};  // candidates at each vertex; the table draws others
    bool all() const { return table.size() <= static_cast<size_t>(M); }
};

/// All lights are candidates if there are at most M. Else those that would be drawn more than once
/// are; each of the others has at least a tenth of their mean power. 1e-30: so that no power is 0.
/// tested by  "truth: more lights than candidates, ...", within 5 standard errors
inline Lights prepare(const Scene& scene, int M = 64) {
    std::vector<double> pmf = light_pmf(scene, 1e-30);
    Lights lights = {LightTable(pmf.size()), {}, {}, M};
    double sum = 1, drawn = M, others = static_cast<double>(pmf.size());
    while (!lights.all()) {
        sum = std::accumulate(pmf.begin(), pmf.end(), 0.0);
        auto most = std::max_element(pmf.begin(), pmf.end());
        if (*most * drawn <= sum) break;
        lights.always.push_back(static_cast<uint32_t>(most - pmf.begin()));
        *most = 0;
        drawn -= 1;
        others -= 1;
    }
    for (double& p : pmf) p = p == 0 ? 0 : std::max(p, sum / others / 10);
    sum = std::accumulate(pmf.begin(), pmf.end(), 0.0);
    for (double& p : pmf) p /= sum;
    lights.table = build_light_table(pmf);
    for (size_t i = 0; i < pmf.size(); i++) {
        bool is_drawn = pmf[i] != 0 && !lights.all();
        if (lights.all()) lights.always.push_back(static_cast<uint32_t>(i));
        lights.candidates.push_back(is_drawn ? static_cast<float>(drawn * pmf[i]) : 1);
        lights.bounds.push_back(light_bounds(scene, i));
        lights.bounds[i].power /= lights.candidates[i];
    }
    return lights;
}

/// The candidates at x, viewed from wo, and the probability that each is one of the two sampled.
struct Candidates {
    static constexpr int most = 128;
    Hit x;
    Vec3 wo;
    int size = 0;
    uint32_t light[most];
    float inclusion[most];
};

/// The factor of a light's target on rough metal: mis_l f towards the light's centre, the part that
/// BSDF sampling does not find. + 0.05: a heuristic, since other points of the light may differ.
inline float bsdf_factor(const Scene& scene, size_t light, const Hit& x, Vec3 wo) {
    if (scene.lights[light].type != LightType::area) return 1;
    const LightShape& shape = scene.light_shapes[light];
    Vec3 to_y = shape.centre - x.p;
    float d2 = std::max(dot(to_y, to_y), shape.radius * shape.radius);
    Vec3 wi = to_y / std::sqrt(d2);
    float pdf_w = std::min(d2 / shape.area, densest), pdf_b = pdf_bsdf(x, wo, wi);
    return power_heuristic(pdf_w, pdf_b) * average(eval_bsdf(x, wo, wi)) + 0.05f;
}

/// Chooses the candidates at x: the lights of `always`, and M in all by drawing from the table. It
/// is cut into slices of equal probability, and u is the place in each slice.
inline void choose_candidates(const Lights& lights, const Hit& x, Vec3 wo, double u,
                              Candidates& c) {
    int N = static_cast<int>(lights.table.size()), always = static_cast<int>(lights.always.size());
    c.x = x, c.wo = wo, c.size = is_specular(*x.material) ? 0 : std::min(N, lights.M);
    std::copy(lights.always.begin(), lights.always.end(), c.light);
    for (int i = always; i < c.size; i++)
        c.light[i] = pick_light(lights.table, (i - always + u) / (c.size - always));
}

/// Computes the probability that each candidate is one of the two that are sampled.
///
///   inclusion = min(1, scale (w + mean w / 9)),    w = p_hat / candidates,    all sum to 2
///
/// mean w / 9: a defensive share of 10 %, since targets ignore walls. One or two lights: 1.
inline void compute_inclusions(const Scene& scene, const Lights& lights, Candidates& c) {
    c.inclusion[0] = c.inclusion[1] = 1;
    if (c.size <= 2) return;

    // Weight each by its target.
    Hit x = c.x;  // a copy, which writing to c does not change: faster
    for (int i = 0; i < c.size; i++) c.inclusion[i] = target(lights.bounds[c.light[i]], x);
    for (int i = 0; i < c.size && is_rough(*x.material); i++)
        c.inclusion[i] *= bsdf_factor(scene, c.light[i], x, c.wo);

    // Scale the weights to a sum of 2. If one would exceed 1, the others sum to 1.
    float sum = 0, largest = 0;
    for (int i = 0; i < c.size; i++)
        sum += c.inclusion[i], largest = std::max(largest, c.inclusion[i]);
    if (!(sum > 0)) c.size = 0;
    float share = sum / (9 * static_cast<float>(c.size));
    sum += sum / 9, largest += share;
    float scale = 2 * largest < sum ? 2 / sum : 1 / (sum - largest);
    for (int i = 0; i < c.size; i++)
        c.inclusion[i] = std::min(scale * (c.inclusion[i] + share), 1.0f);
}

/// The density of the two light samples together, in the direction of a light: inclusion pdf_w.
///
/// With random candidates, the probability that a light is included is unknown: candidates
/// is a heuristic for it. Any positive number keeps the estimate unbiased.
inline float pdf_sampled(const Lights& lights, const Candidates& c, size_t light, float pdf_w) {
    return (lights.all() ? c.inclusion[light] : lights.candidates[light]) * pdf_w;
}

/// Estimates the direct light of candidate number i that x scatters to wo, from one point.
///
///   Ld = mis_l f Le V cos / pdf_l,    pdf_l = candidates inclusion pdf_w
inline Rgb light_sample(const Scene& scene, const Lights& lights, const Candidates& c, int i,
                        Vec2 u, Recorder& recorder) {
    const Hit& x = c.x;
    Vec3 wo = c.wo;
    size_t light = c.light[i];
    LightSample y = sample_light_for_mis(scene, light, x, u);
    if (y.pdf_w == 0) return {};
    float pdf_l = lights.candidates[light] * c.inclusion[i] * y.pdf_w;
    float pdf_b = y.delta ? 0 : pdf_bsdf(x, wo, y.wi);
    float mis_l = power_heuristic(pdf_sampled(lights, c, light, y.pdf_w), pdf_b);
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (mis_l * dot(y.wi, x.n) / pdf_l);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, pdf_l, pdf_b, mis_l);
    return Ld;
}

/// Estimates the direct light that x scatters to wo, from two of the candidates.
///
/// Systematic sampling: put the inclusions end to end, a line of length 2; choose at u and u + 1.
/// Mirrors and glass: 0, since their f is 0 for every direction that light sampling finds.
/// source  Madow 1949      tested by  "truth: floors under known lamps", within 5 standard errors
inline Rgb direct_light(const Scene& scene, const Lights& lights, const Candidates& c,
                        const TwoLightNumbers& u, Recorder& recorder) {
    Rgb Ld;
    float up_to = 0, mark = u.choice;
    for (int i = 0; i < c.size; i++) {
        up_to += c.inclusion[i];
        if (up_to <= mark) continue;
        Ld += light_sample(scene, lights, c, i, mark < 1 ? u.first : u.second, recorder);
        mark += 1;
    }
    return Ld;
}

/// The MIS weight of emission that a BSDF sample from x has hit: at y, or else in the sky.
inline float mis_emission(const Scene& scene, const Lights& lights, const Candidates& c,
                          float pdf_b, const std::optional<Hit>& y) {
    size_t light = static_cast<size_t>(y ? y->light : scene.sky_light);
    float pdf_w = pdf_light_for_mis(scene, light, c.x, y);
    return power_heuristic(pdf_b, pdf_sampled(lights, c, light, pdf_w));
}

}  // namespace many_lights
