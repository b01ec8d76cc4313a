// Chapter 05 for tests: tests/chapters/ch05.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/05_ray_casting/estimator.h"
#include "common/path/trace.h"

#ifdef ALL_TESTS
extern template Trace trace_with<ch05::trace>();
#endif
