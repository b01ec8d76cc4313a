// Chapter 10 for tests: tests/chapters/ch10.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/10_cosine_sampling/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch10::trace>();
#endif
