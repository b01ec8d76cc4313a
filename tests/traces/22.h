// Chapter 22 for tests: tests/chapters/ch22.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/22_fast_bidirectional/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch22::trace>(ch22::Bidirectional);
#endif
