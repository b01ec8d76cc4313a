// What theory says of samplers: relative variances by quadrature and by counting all cases, and how
// often an error bar holds the truth.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

/// A small part of what a surface sees: the cosine there, what one of its samples is worth (f cos
/// Le, up to a factor), and its solid angle in sr.
struct Part {
    double cos, value, omega;
};

/// Rings around the normal with cosines in [from, to], on a matt surface.
inline std::vector<Part> rings(double from, double to, int n = 20000) {
    std::vector<Part> parts;
    for (int i = 0; i < n; i++) {
        double c = from + (to - from) * (i + 0.5) / n;
        parts.push_back({c, c, 2 * std::numbers::pi * (to - from) / n});
    }
    return parts;
}

/// Mean, and mean of the square, of one sample value weight / pdf.
struct Moments {
    double mean = 0, square = 0;
    double relative_variance() const { return square / (mean * mean) - 1; }
};

template <typename Pdf, typename Weight>
Moments weighted(const std::vector<Part>& parts, const Pdf& pdf, const Weight& weight) {
    Moments m;
    for (const Part& p : parts) {
        double x = p.value * weight(p);
        m.mean += x * p.omega;
        m.square += x * x / pdf(p) * p.omega;
    }
    return m;
}

/// Relative variance of one direction drawn by pdf(part), in sr^-1.
///
///   E[X^2] / E[X]^2 - 1,   E[X^2] = integral of value^2 / pdf
template <typename Pdf>
double variance_by(const std::vector<Part>& parts, const Pdf& pdf) {
    return weighted(parts, pdf, [](const Part&) { return 1.0; }).relative_variance();
}

/// Relative variance of one direction of each of two densities, with the power heuristic.
template <typename PdfA, typename PdfB>
double variance_of_mis(const std::vector<Part>& parts, const PdfA& pdf_a, const PdfB& pdf_b) {
    auto share = [](double a, double b) { return a * a / (a * a + b * b); };
    Moments a = weighted(parts, pdf_a, [&](const Part& p) { return share(pdf_a(p), pdf_b(p)); });
    Moments b = weighted(parts, pdf_b, [&](const Part& p) { return share(pdf_b(p), pdf_a(p)); });
    double mean = a.mean + b.mean;
    return (a.square - a.mean * a.mean + b.square - b.mean * b.mean) / (mean * mean);
}

inline double pdf_uniform(const Part&) { return 1 / (2 * std::numbers::pi); }
inline double pdf_cosine(const Part& p) { return p.cos / std::numbers::pi; }

/// A light that is drawn with probability pmf, and what it gives to the competition of candidates
/// (p_hat) and, unless something is in between, to the estimate (f).
struct Choice {
    double pmf, p_hat, f;
};

/// All values that a sample can have.
struct Outcome {
    double chance, x;
};
using Outcomes = std::vector<Outcome>;

inline double mean_of(const Outcomes& all) {
    double mean = 0;
    for (const Outcome& o : all) mean += o.chance * o.x;
    return mean;
}
/// E[(X - m)^n] / m^n, m: the mean; for n = 2 the relative variance.
inline double relative_moment(const Outcomes& all, int n) {
    double m = mean_of(all), sum = 0;
    for (const Outcome& o : all) sum += o.chance * std::pow(o.x / m - 1, n);
    return sum;
}
/// One light out of two.
inline Outcomes chosen(Choice a, Choice b) { return {{a.pmf, a.f / a.pmf}, {b.pmf, b.f / b.pmf}}; }

/// RIS over two lights, M candidates from M slices of the table: k of them are the light b, M pmf_b
/// rounded up or down.
inline Outcomes resampled(Choice a, Choice b, int M) {
    Outcomes all;
    double least = std::floor(M * b.pmf);
    for (double k : {least, least + 1}) {
        double chance = 1 - std::abs(M * b.pmf - k);
        double sum_a = (M - k) * a.p_hat / a.pmf, sum_b = k * b.p_hat / b.pmf, sum = sum_a + sum_b;
        all.push_back({chance * sum_a / sum, a.f * sum / (M * a.p_hat)});
        all.push_back({chance * sum_b / sum, b.f * sum / (M * b.p_hat)});
    }
    return all;
}

/// How often the 95 % interval of N samples, each 1 with probability p and else 0, holds p.
inline double coverage_of_rare(double p, int N) {
    double sum = 0, n = N;
    for (int k = 0; k <= N; k++) {
        double log_chance = std::lgamma(n + 1) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1) +
                            k * std::log(p) + (n - k) * std::log1p(-p);
        double error = 1.96 * std::sqrt(k * (1 - k / n) * n / (n - 1));
        if (std::abs(k - n * p) <= error) sum += std::exp(log_chance);
    }
    return sum;
}
