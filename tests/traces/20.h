// Chapter 20 for tests: tests/chapters/ch20.cpp compiles its trace_light() for all of them.
#pragma once
#include "chapters/20_light_tracing/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch20::trace_light>(ch20::Endpoints);
#endif
