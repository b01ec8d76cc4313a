// Chapter 15 for tests: tests/chapters/ch15.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/15_mis_ris/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch15::trace>(ch15::Lights);
#endif
