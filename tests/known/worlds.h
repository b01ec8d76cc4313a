// Small random scenes: of several lights, shapes and materials at once, as no list of
// scenes has them.
#pragma once
#include <cstdint>
#include <string>

/// A pbrt scene of what a chapter can render. The same for the same number, on every machine.
std::string random_world(int chapter, uint32_t number);
