// Chapter 25 for tests: tests/chapters/ch25.cpp compiles its passes for all of them.
#pragma once
#include "tests/traces/passes.h"
#include "chapters/25_vertex_merging/estimator.h"

#ifdef ALL_TESTS
extern template Method passes_of<ch25::merging_passes>(const Scene&, const PhotonSettings&);
#endif
