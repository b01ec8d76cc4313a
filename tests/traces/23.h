// Chapter 23 for tests: tests/chapters/ch23.cpp compiles its passes for all of them.
#pragma once
#include "tests/traces/passes.h"
#include "chapters/23_photon_mapping/estimator.h"

#ifdef ALL_TESTS
extern template Method passes_of<ch23::photon_passes>(const Scene&, const ch23::PhotonSettings&);
#endif
