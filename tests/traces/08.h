// Chapter 08 for tests: tests/chapters/ch08.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/08_russian_roulette/estimator.h"
#include "common/path/trace.h"

#ifdef ALL_TESTS
extern template Trace trace_with<ch08::trace>();
#endif
