// Chapter 04: importance sampling. Sample where the integrand is large; divide by the density.
#pragma once
#include <cmath>
#include <vector>

#include "common/base/vec.h"

namespace ch04 {

// Sums: dice, lights.

/// Chooses i with probability pmf[i]: the first i at which the running sum exceeds u.
///
/// u     in [0,1)
/// zero  an i of probability 0 is never chosen, not even if u = 0 or after rounding at the end
/// tested by  "density: choices by chance", chi^2 at 1e-6
inline size_t sample_pmf(const std::vector<double>& pmf, double u) {
    size_t last = 0;
    double sum = 0;
    for (size_t i = 0; i < pmf.size(); i++) {
        sum += pmf[i];
        if (pmf[i] > 0) last = i;
        if (u < sum) return i;
    }
    return last;
}

/// Estimates sum f[i] from one term.
///
///   X = f[i] / pmf[i],  i chosen by pmf
///
/// bias      0 if pmf[i] > 0 wherever f[i] != 0; other terms are missing from the mean
/// variance  exact_variance: 0 for pmf = f / sum f
inline double estimate_sum(const std::vector<double>& f, const std::vector<double>& pmf, double u) {
    size_t i = sample_pmf(pmf, u);
    return f[i] / pmf[i];
}

/// E[X] = sum of f[i] over pmf[i] > 0
inline double exact_mean(const std::vector<double>& f, const std::vector<double>& pmf) {
    double mean = 0;
    for (size_t i = 0; i < f.size(); i++) mean += pmf[i] > 0 ? f[i] : 0;
    return mean;
}

/// Var X = sum of pmf[i] (f[i] / pmf[i] - E[X])^2
inline double exact_variance(const std::vector<double>& f, const std::vector<double>& pmf) {
    double variance = 0, mean = exact_mean(f, pmf);
    for (size_t i = 0; i < f.size(); i++)
        if (pmf[i] > 0) variance += pmf[i] * std::pow(f[i] / pmf[i] - mean, 2);
    return variance;
}

/// One value for each of the 36 rolls (a, b) of two dice.
template <class Function>
std::vector<double> for_each_roll(Function f) {
    std::vector<double> values;
    for (double a = 1; a <= 6; a++)
        for (double b = 1; b <= 6; b++) values.push_back(f(a, b));
    return values;
}

/// Weights scaled so that they sum to 1.
inline std::vector<double> normalized(std::vector<double> weights) {
    double sum = 0;
    for (double w : weights) sum += w;
    for (double& w : weights) w /= sum;
    return weights;
}

// Integrals over [0,1].

/// A density on [0,1]: sample(u) is distributed with pdf(x), and invert(x) is the u that gives x.
struct Density {
    const char* name;
    double (*sample)(double u);  // u in (0,1)
    double (*pdf)(double x);
    double (*invert)(double x);
};

inline constexpr Density uniform = {"1", [](double u) { return u; }, [](double) { return 1.0; },
                                    [](double x) { return x; }};
inline constexpr Density linear = {"2x", [](double u) { return std::sqrt(u); },
                                   [](double x) { return 2 * x; }, [](double x) { return x * x; }};
inline constexpr Density quadratic = {"3x^2", [](double u) { return std::cbrt(u); },
                                      [](double x) { return 3 * x * x; },
                                      [](double x) { return x * x * x; }};
inline constexpr Density inverse_root = {"1/(2 sqrt x)", [](double u) { return u * u; },
                                         [](double x) { return 1 / (2 * std::sqrt(x)); },
                                         [](double x) { return std::sqrt(x); }};
inline constexpr Density falling = {"2(1-x)", [](double u) { return 1 - std::sqrt(1 - u); },
                                    [](double x) { return 2 * (1 - x); },
                                    [](double x) { return x * (2 - x); }};
inline constexpr Density rising = {"(2/3)(1+x)", [](double u) { return std::sqrt(1 + 3 * u) - 1; },
                                   [](double x) { return 2 * (1 + x) / 3; },
                                   [](double x) { return x * (2 + x) / 3; }};
inline constexpr Density left_half = {"2 on [0,1/2]", [](double u) { return u / 2; },
                                      [](double x) { return x < 0.5 ? 2.0 : 0.0; },
                                      [](double x) { return 2 * x; }};
/// Proportional to |x - 1/4|: the best density for the integrand x - 1/4, which changes sign.
inline constexpr Density distance = {
    "(16/5)|x-1/4|",
    [](double u) {
        double square = (10 * u - 1) / 16;  // of x - 1/4, with its sign
        return 0.25 + std::copysign(std::sqrt(std::abs(square)), square);
    },
    [](double x) { return 3.2 * std::abs(x - 0.25); },
    [](double x) { return 0.1 + 1.6 * (x - 0.25) * std::abs(x - 0.25); }};

/// Estimates the integral of f over [0,1] from one point.
///
///   X = f(x) / pdf(x),  x drawn from pdf
///
/// zero      X = 0 where the density is 0 or infinite: it cannot be divided by
/// bias      0 if pdf(x) > 0 wherever f(x) != 0
/// variance  integral of f^2 / pdf, minus the square of the mean: 0 for pdf ~ f >= 0, least for
///           pdf ~ |f|, infinite if pdf falls to 0 too fast where f does not
template <class Function>
double estimate_integral(Function f, const Density& density, double u) {
    double x = density.sample(u), pdf = density.pdf(x);
    return pdf > 0 && std::isfinite(pdf) ? f(x) / pdf : 0;
}

/// A number in (0,1), both ends excluded, with 48 random bits: 1/sqrt(x) is infinite at 0.
inline double open_unit(Vec2 u) { return double{u.x} + (double{u.y} + 0x1p-25) * 0x1p-24; }

}  // namespace ch04
