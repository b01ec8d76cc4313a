// Chapter 21 for tests: tests/chapters/ch21.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/21_bidirectional/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch21::trace>(Endpoints);
#endif
