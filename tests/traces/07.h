// Chapter 07 for tests: tests/chapters/ch07.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/07_path_tracing/estimator.h"
#include "common/path/trace.h"

#ifdef ALL_TESTS
extern template Trace trace_with<ch07::trace>();
#endif
