// Chapter 12 for tests: tests/chapters/ch12.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/12_ris/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch12::trace>(ch12::Proposal);
#endif
