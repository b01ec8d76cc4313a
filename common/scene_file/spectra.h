// Light and metals whose colors are known as spectra, as linear sRGB.
#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "common/base/vec.h"
#include "common/material/glass.h"

/// The color of a black body, as linear sRGB with luminance 1.
///
///   B(lambda) = 1 / (lambda^5 (exp(c2 / (lambda T)) - 1)),  weighted with the CIE 1931 observer
///
/// kelvin  T, from 500 to 1e6; what lies outside of sRGB (below about 1900 K) is cut off at 0
/// source  Planck 1901; CIE 015
/// tested by  "truth: black bodies have the chromaticities that the CIE gives"
Rgb blackbody_rgb(double kelvin);

/// A spectrum as a scene file lists it: wavelengths in nm, in ascending order, and values.
/// Between them the value is linear, outside of them it is 0.
using Spectrum = std::vector<std::array<double, 2>>;

/// The color of a light with this spectrum, as linear sRGB with luminance 1, which is what pbrt
/// makes of it: how bright it is, its other parameters say. Black for a spectrum of invisible
/// light.
///
///   X = sum over nm of  S x,  Y and Z alike      x, y, z: the observer, linear between its rows
///
/// tested by  "truth: colors of spectra, by quadrature"
Rgb light_rgb(const Spectrum& spectrum);
/// Daylight (D65), relative to 560 nm.      source  CIE 015
const Spectrum& standard_daylight();
/// The color of a reflectance under daylight, as linear sRGB: white is (1, 1, 1). What lies
/// outside of sRGB is cut off at 0 and 1.
Rgb reflectance_rgb(const Spectrum& spectrum);
/// The mean over the matching curve of each primary, as that of metals below.
Rgb mean_rgb(const Spectrum& spectrum);

/// Colors by their names in pbrt.
using NamedColors = std::map<std::string, Rgb>;

/// The standard illuminants "stdillum-A", "-D50" and "-D65", with luminance 1.
///
/// source  chromaticities of CIE 015, table T.3
const NamedColors& illuminants();

/// The relative luminance of a linear sRGB color.
inline float luminance(Rgb a) { return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b; }

/// "metal-Ag-eta" and "metal-Ag-k", the complex index of refraction eta + i k, and those of Al, Au
/// and Cu.
///
/// source  measured spectra (Palik 1985), averaged over the sRGB primaries' color matching curves
const NamedColors& metals();

/// pbrt's measured glasses, such as "glass-BK7".
///
/// F5, F10 and F11 are Schott's SF5, N-SF10 and N-SF11.      source  Schott's data sheets
const std::vector<Glass>& all_glasses();
