// taught by chapter 14
// How two ways of drawing the same direction share it.
#pragma once

/// The weight of a direction that was drawn with density a, and could have been drawn with b.
///
///   balance: a / (a + b);  power: a^2 / (a^2 + b^2)
///
/// By way of b / a, so that no square overflows. a > 0; an infinite a has weight 1.
/// source  Veach, Guibas 1995      tested by  "identity: MIS weights sum to 1"
inline float balance_heuristic(float a, float b) { return 1 / (1 + b / a); }
inline float power_heuristic(float a, float b) { return 1 / (1 + (b / a) * (b / a)); }
