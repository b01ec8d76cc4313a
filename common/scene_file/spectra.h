// Light, metals and glass whose spectra are known.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "common/base/vec.h"
#include "common/material/glass.h"

/// The color of a black body of 500 to 1e6 K, as linear sRGB with luminance 1: the spectrum
///
///   B(lambda) = 1 / (lambda^5 (exp(c2 / (lambda T)) - 1)),  weighted with the CIE 1931 observer
///
/// What lies outside of sRGB (below about 1900 K) is cut off at 0.  source  Planck 1901; CIE 015
Rgb blackbody_rgb(double kelvin);

/// "metal-Ag-eta" and "metal-Ag-k", the complex index of refraction eta + i k, and those of Al, Au
/// and Cu.
///
/// source  measured spectra (Palik 1985), averaged over the sRGB primaries' color matching curves
const std::map<std::string, Rgb>& metals();

/// pbrt's measured glasses, such as "glass-BK7".
///
/// F5, F10 and F11 are Schott's SF5, N-SF10 and N-SF11.      source  Schott's data sheets
const std::map<std::string, Glass>& glasses();
