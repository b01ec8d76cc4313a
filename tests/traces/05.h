// Chapter 05 for tests: tests/chapters/ch05.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/05_ray_casting/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch05::trace>();
#endif
