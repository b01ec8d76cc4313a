// Chapter 14 for tests: tests/chapters/ch14.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/14_mis/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch14::trace>(ch14::Lights);
#endif
