// Form factors in three ways: --form-factors.
#pragma once
#include "chapters/26_radiosity/estimator.h"

namespace ch26 {

enum class FormFactors : uint8_t { point, chance, contour };

/// G, m^2. point: the formula that is often shown, between the centres. chance: its mean over four
/// pairs of points, unbiased, but noisy where patches touch. contour: exchange().
inline double exchange_by(FormFactors way, const Scene& scene, const Patch& p, const Patch& q,
                          uint32_t key) {
    if (way == FormFactors::contour) return exchange(scene, p, q, key);
    if (!faces(p, q) || !faces(q, p)) return 0;
    if (way == FormFactors::point) {
        if (!sees(scene, p.centre + p.eps * p.n, q.centre + q.eps * q.n)) return 0;
        return std::max(0.0, by_centres(p, q, p.centre, q.centre));
    }
    double sum = 0;
    for (auto [x, y] : pairs_of_points(p, q, key))
        if (sees(scene, x, y)) sum += std::max(0.0, by_centres(p, q, x, y)) / 4;
    return sum;
}

/// The rows of G.
inline Rows form_factors(const Scene& scene, const Patches& patches, FormFactors way, uint32_t seed,
                         int threads) {
    return Rows(patches.patch, threads, [=, &scene, &patches](uint32_t i, uint32_t j) {
        uint32_t key = hash32(i, hash32(j, seed));
        return exchange_by(way, scene, patches.patch[i], patches.patch[j], key);
    });
}

}  // namespace ch26
