// What the tests of chapters from 07 on begin with: compiled in advance, so that make check is
// quick.
#pragma once
#include <doctest/doctest.h>

#include "tests/support/gates.h"
#include "tests/support/scenes.h"
