// Chapter 19 for tests: tests/chapters/ch19.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/19_adaptive/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch19::trace>(sky_light::LightsAndSky, std::vector<Rgb>);
#endif
