// Chapter 17 for tests: tests/chapters/ch17.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/17_sky_image/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch17::trace>(ch17::LightsAndSky);
#endif
