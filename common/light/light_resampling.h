// Choosing among candidate lights by what they could give: chapter 11, with all candidates at once.
#pragma once
#include "common/light/light_table.h"

/// Candidates for one shadow ray, each with its potential at a point.
struct Candidates {
    static constexpr int most = 1024;
    int M;
    int light[most];
    float p_hat[most];   // W m^-2: the potential, as in chapter 11
    float weight[most];  // p_hat / pmf
};

/// The light that was kept among M candidates.
struct Kept {
    size_t light = 0;
    float W = 0;  // what it counts for all others, in place of 1 / probability; 0: none gives light
};

/// Fills scene.light_bounds, from the lights and their table.
void prepare_light_bounds(Scene& scene);

/// Draws one candidate from each of M slices of the table; u in [0,1) is the place in each slice.
///
/// The same lights and potentials as chapter 11's, one after the other, but for rounding.
/// tested by  "identity: candidates all at once are those of chapter 11"
Candidates draw_candidates(const Scene& scene, const Hit& x, int M, float u);

/// Keeps each candidate with probability weight / weight_sum.      W = weight_sum / (M p_hat)
///
/// u in [0,1) decides. The same chances as a reservoir's, but no candidate waits for another.
/// tested by  "identity: each candidate is kept for its share of u"
Kept keep_one(const Candidates& candidates, float u);
