// Chapter 13 for tests: tests/chapters/ch13.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/13_glossy/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch13::trace>(LightTable, ch13::Strategy);
#endif
