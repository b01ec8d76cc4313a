// Chapter 24 for tests: tests/chapters/ch24.cpp compiles its passes for all of them.
#pragma once
#include "tests/traces/passes.h"
#include "chapters/24_progressive_photons/estimator.h"

#ifdef ALL_TESTS
extern template Method passes_of<ch24::photon_passes>(const Scene&, const PhotonSettings&);
#endif
