// The charts of chapters 01 to 04: error against the number of samples and against time.
#pragma once
#include "tests/measure/lines.h"

/// Darts for pi and on the board, the point sets, and the densities. `largest` is the most samples
/// of one estimate (a power of 4), `runs` how many estimates each error is taken over.
void chart_points(const std::string& folder, uint32_t largest, uint32_t runs);
