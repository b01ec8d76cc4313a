// Chapter 11 for tests: tests/chapters/ch11.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/11_light_importance/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch11::trace>(ch11::LightTable);
#endif
