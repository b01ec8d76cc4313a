// Rough metal once more, in double and by other formulas than those that are tested.
#pragma once
#include <cmath>
#include <complex>
#include <numbers>

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
