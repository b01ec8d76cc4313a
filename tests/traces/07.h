// Chapter 07 for tests: tests/chapters/ch07.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/07_path_tracing/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch07::trace>();
#endif
