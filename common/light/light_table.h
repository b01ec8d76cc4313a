// taught by chapter 11
// Choosing lights by power, in O(1).
#pragma once
#include "common/light/lights.h"

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
