// Dispersion: glass refracts blue light more than red.
#pragma once
#include <cmath>

/// A glass: the coefficients fitted to measurements of its index of refraction.
struct Glass {
    double B[3], C[3];  // C in micrometres^2
};

/// The index of refraction at a wavelength in micrometres.
///
///   n^2 = 1 + sum over i of  B_i lambda^2 / (lambda^2 - C_i)
///
/// source  Sellmeier 1871
/// tested by  "truth: the glasses have the indices and Abbe numbers of their data sheets"
inline float index_of_refraction(const Glass& glass, double micrometres) {
    double l2 = micrometres * micrometres, n2 = 1;
    for (int i = 0; i < 3; i++) n2 += glass.B[i] * l2 / (l2 - glass.C[i]);
    return static_cast<float>(std::sqrt(n2));
}
