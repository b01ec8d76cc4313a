// Choosing among candidate lights by what they could give (chapter 11).
#pragma once
#include "common/light_table.h"

/// p_hat: what light i could send by way of x if nothing were in between, from its centre alone.
///
///   area:  p_hat = L A cos_x cos_y / d^2,  with each cosine as large as any point of the light may
///          have it (it lies within `spread` radians of the centre), and d at least its radius
///
/// 0 only where the light surely gives nothing.      [W m^-2]
inline float potential(const Scene& scene, size_t i, const Hit& x) {
    const Light& light = scene.lights[i];
    float L = average(light.L);
    if (light.type == LightType::infinite) return pi * L;
    if (light.type == LightType::distant) return L * std::max(0.0f, dot(light.p, x.n));
    const LightShape& shape = scene.light_shapes[i];
    bool area = light.type == LightType::area;
    Vec3 to_y = (area ? shape.centre : light.p) - x.p;
    float d2 = std::max(dot(to_y, to_y), 1e-30f), inv_d = 1 / std::sqrt(d2);
    float spread = area ? shape.radius * inv_d : 0, more = spread + spread * spread;
    if (spread > 0.5f) return L * shape.area / std::max(d2, shape.radius * shape.radius);
    float cos_x = std::min(1.0f, dot(to_y, x.n) * inv_d + more);
    if (!(cos_x > 0)) return 0;
    if (!area) return L * cos_x / d2;
    float cos_y = 1;  // of a light that is flat
    if (shape.flat) {
        cos_y = -dot(to_y, shape.first.n) * inv_d;
        cos_y = std::min(1.0f, (light.two_sided ? std::abs(cos_y) : cos_y) + more);
    }
    return cos_y > 0 ? L * shape.area * cos_x * cos_y * inv_d * inv_d : 0;
}

/// The light kept among the candidates so far.
struct Reservoir {
    size_t light = 0;
    float p_hat = 0;       // of that light
    float weight_sum = 0;  // of all candidates

    /// Takes the candidate with probability weight / weight_sum.
    ///
    /// u in [0,1) decides, and is made uniform again for the next candidate.
    void offer(size_t candidate, float p_hat_candidate, float weight, float& u) {
        if (!(weight > 0)) return;
        weight_sum += weight;
        float share = weight / weight_sum;
        bool taken = u < share;
        light = taken ? candidate : light;
        p_hat = taken ? p_hat_candidate : p_hat;
        u = (taken ? u : u - share) / (taken ? share : 1 - share);
    }
    /// W: what the kept light counts for all others, in place of 1 / probability.
    float W(int candidates) const {
        return p_hat > 0 ? weight_sum / (static_cast<float>(candidates) * p_hat) : 0;
    }
};
