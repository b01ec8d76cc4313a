// Chapter 08 for tests: tests/chapters/ch08.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/08_russian_roulette/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch08::trace>();
#endif
