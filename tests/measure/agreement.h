// Whether several methods estimate the same number: z values, and when there are too few lucky
// samples for one.
#pragma once
#include <cmath>
#include <vector>

/// What one method says of a quantity: the values of independent batches, summed up.
struct Estimate {
    double mean = 0, se = 0, skewness = 0;
    double missed = 0;  // that others have found of it, in classes of paths that were not met here

    /// Few batches with large values among many without say nothing of their spread: their error
    /// comes out too small just when the mean does. So it does where none was met at all.
    bool reliable() const { return se > 0 && std::abs(skewness) <= 1 && missed <= se; }
};

/// skewness  third central moment of the values over the 3/2th power of the second
inline Estimate estimate_of(const std::vector<double>& values) {
    double n = static_cast<double>(values.size()), mean = 0, m2 = 0, m3 = 0;
    for (double x : values) mean += x / n;
    for (double x : values) {
        m2 += (x - mean) * (x - mean) / n;
        m3 += (x - mean) * (x - mean) * (x - mean) / n;
    }
    // Below a millionth of the mean, differences are rounding.
    double rounding = 1e-6 * std::abs(mean);
    bool noise = std::sqrt(m2) > rounding;
    return {mean, std::hypot(std::sqrt(m2 / (n - 1)), rounding),
            noise ? m3 / std::pow(m2, 1.5) : 0};
}

/// A method against all others, which are pooled by 1 / se^2.
struct Verdict {
    double z = 0;
    double others_mean = 0, others_se = 0;
    bool known = false;
};

/// Verdict number i: estimate i against the reliable ones among the rest.
///
/// tested by  "truth: z of three estimates"
inline Verdict judge(const std::vector<Estimate>& estimates, size_t i) {
    Verdict v;
    double weights = 0;
    for (size_t k = 0; k < estimates.size(); k++) {
        if (k == i || !estimates[k].reliable()) continue;
        double weight = 1 / (estimates[k].se * estimates[k].se);
        v.others_mean += weight * estimates[k].mean;
        weights += weight;
    }
    if (weights == 0 || !estimates[i].reliable()) return v;
    v.others_mean /= weights;
    v.others_se = 1 / std::sqrt(weights);
    v.z = (estimates[i].mean - v.others_mean) / std::hypot(estimates[i].se, v.others_se);
    v.known = true;
    return v;
}
