// Directions of samplers against the densities that they claim, and against their inverses.
#pragma once
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/support/estimators.h"

/// 10 x 10 cells of the directions around +z: v = 1 - sqrt(1 - s), s = tan^2 / (alpha^2 + tan^2),
/// and phi. Normals of GGX have equally likely s: v has more cells where facets are steep. Of alpha
/// 1, v is 1 - z.
struct DirectionCells {
    static constexpr int n = 10;
    double alpha = 1;

    size_t of(Vec3 h) const {
        double t2 = static_cast<double>(h.x * h.x + h.y * h.y) / static_cast<double>(h.z * h.z);
        double s = t2 / (alpha * alpha + t2), phi = std::atan2(double{h.y}, double{h.x}) / 2;
        int i = std::min(n - 1, static_cast<int>(n * (1 - std::sqrt(1 - s))));
        int j = std::clamp(static_cast<int>(n * (phi / pi_exact + 0.5)), 0, n - 1);
        return static_cast<size_t>(n * i + j);
    }
    /// Sums g(h) d omega over each cell, from fine^2 points in it.
    template <class Function>
    std::vector<double> integrate(const Function& g, int fine = 40) const {
        std::vector<double> sums(n * n);
        int m = n * fine;
        for (int i = 0; i < m; i++) {
            double v = (i + 0.5) / m, s = 1 - (1 - v) * (1 - v);
            double z = 1 / std::sqrt(1 + alpha * alpha * s / (1 - s)), r = std::sqrt(1 - z * z);
            double dz_dv = z * z * z * alpha * alpha / ((1 - s) * (1 - v));
            for (int j = 0; j < m; j++) {
                double phi = 2 * pi_exact * ((j + 0.5) / m - 0.5);
                Vec3 h = {static_cast<float>(r * std::cos(phi)),
                          static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
                sums[static_cast<size_t>(n * (i / fine) + j / fine)] +=
                    static_cast<double>(g(h)) * dz_dv * 2 * pi_exact / m / m;
            }
        }
        return sums;
    }
};

/// The chance that chi^2 of 50,000 samples by this density is larger than that of these; cells of
/// less than 10 count as one. Samples with z = 0 are none.
///
/// sample(random numbers)    density(direction): of samples in the cells, per solid angle
template <class Sample, class Density>
double chance_of_directions(const DirectionCells& cells, const Sample& sample,
                            const Density& density) {
    constexpr int samples = 50000;
    std::vector<double> counts(100), likely = cells.integrate(density), c{0}, e{0};
    Sampler random = random_numbers(1);
    double drawn = 0, chance = 0;
    for (int i = 0; i < samples; i++) {
        Vec3 h = sample(random);
        if (h.z <= 0) continue;
        counts[cells.of(h)]++, drawn++;
    }
    for (size_t i = 0; i < counts.size(); i++) {
        double expected = samples * likely[i];
        chance += likely[i];
        if (expected < 10) {
            c[0] += counts[i], e[0] += expected;
        } else {
            c.push_back(counts[i]), e.push_back(expected);
        }
    }
    INFO("the density integrates to ", chance, " over these directions, where ",
         100 * drawn / samples, " % of the samples fall");
    CHECK(std::abs(drawn - samples * chance) < 5 * std::sqrt(samples * 0.25));
    if (e[0] < 10) c[0] = e[0] = 1;  // too few to say anything
    return chi_square_tail(chi_square(c, e), static_cast<int>(c.size()) - 1);
}

/// The inverse of a sampler finds the random numbers of a direction. Near the axis the second one
/// is not known, nor, for GGX, along the surface.
template <class Sample, class Invert>
void check_inverse(const Sample& sample, const Invert& invert, float error) {
    Sampler random = random_numbers(1);
    for (int i = 0; i < 1000; i++) {
        Vec2 u = random.u2(), v = invert(sample(u));
        INFO("u is ", u.x, ", ", u.y, "; v = invert(sample(u)) should be u");
        CHECK(std::abs(u.x - v.x) < error);
        CHECK(v.y >= 0);
        CHECK(v.y <= 1);
        CHECK(std::abs(std::remainder(u.y - v.y, 1.0f)) * std::min(std::sqrt(u.x), 1 - u.x) <
              error);
    }
}

struct RoughMetal {
    double alpha, eta, k;

    /// Fresnel's equations with the complex index, for unpolarised light.
    double fresnel(double cos_i) const {
        using Complex = std::complex<double>;
        Complex n(eta, k), cos_t = std::sqrt(1.0 - (1 - cos_i * cos_i) / (n * n));
        return (std::norm((cos_i - n * cos_t) / (cos_i + n * cos_t)) +
                std::norm((n * cos_i - cos_t) / (n * cos_i + cos_t))) /
               2;
    }
    /// How many facets hide what is seen under this cosine.
    double lambda(double cos) const {
        double tan2 = 1 / (cos * cos) - 1;
        return (std::sqrt(1 + alpha * alpha * tan2) - 1) / 2;
    }

    /// The share of a white sky that is reflected towards the eye, at this angle to the normal.
    ///
    ///   integral of f cos_i dwi = integral of F G (o.h) / (cos_o cos_h) ds dphi / (2 pi),
    ///   s = tan^2 h / (alpha^2 + tan^2 h)
    ///
    /// lean: the angle from the normal, towards the eye, to the normal of the surface itself, below
    /// which nothing goes
    double albedo(double angle, double lean = 0, int n = 600) const {
        double ox = std::sin(angle), oz = std::cos(angle), sum = 0;
        double gx = std::sin(lean), gz = std::cos(lean);
        for (int a = 0; a < n; a++) {
            double v = (a + 0.5) / n, s = v * v * (3 - 2 * v);  // more points at both ends
            double cos_h = 1 / std::sqrt(1 + alpha * alpha * s / (1 - s));
            double sin_h = std::sqrt(1 - cos_h * cos_h);
            for (int b = 0; b < n; b++) {
                double hx = sin_h * std::cos(std::numbers::pi * (b + 0.5) / n);
                double oh = ox * hx + oz * cos_h;
                double ix = 2 * oh * hx - ox, iz = 2 * oh * cos_h - oz;
                if (oh <= 0 || iz <= 0 || ix * gx + iz * gz <= 0) continue;
                double G = 1 / (1 + lambda(oz) + lambda(iz));
                sum += fresnel(oh) * G * oh / (oz * cos_h) * 6 * v * (1 - v);
            }
        }
        return sum / n / n;
    }
};
