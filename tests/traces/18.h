// Chapter 18 for tests: tests/chapters/ch18.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/18_dispersion/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch18::trace>(sky_light::LightsAndSky, std::vector<Rgb>);
#endif
