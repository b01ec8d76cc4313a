// Chapter 13 for tests: tests/chapters/ch13.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/13_glossy/estimator.h"
#include "common/path/trace.h"

#ifdef ALL_TESTS
extern template Trace trace_with<ch13::trace>(LightTable, ch13::Strategy);
#endif
