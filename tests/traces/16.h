// Chapter 16 for tests: tests/chapters/ch16.cpp compiles its trace() for all of them.
#pragma once
#include "chapters/16_lens_and_shutter/estimator.h"
#include "common/path/method.h"

#ifdef ALL_TESTS
extern template Method method_of<ch16::trace>(many_lights::Lights);
#endif
