// Chapter 09 for tests: tests/chapters/ch09.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/09_light_sampling/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch09::trace>(ch09::LightMeasure);
#endif
