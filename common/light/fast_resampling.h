// Choosing among candidate lights by what they could give: chapter 12's way, all candidates at
// once.
#pragma once
#include "common/light/light_table.h"

/// A light of any type in one form, from which its target at a point follows without a branch.
struct LightBounds {
    Vec3 centre;          // m; unit, towards a light without a place
    float has_place = 1;  // 0: distant and infinite lights
    Vec3 n;               // unit, of a flat light; else 0
    float back = 1;       // -1: a flat light that shines to both sides
    float radius = 0;     // m, of a sphere around it; 1: the sky, which is around x
    float least_cos_y = 1;
    float power = 0;    // L A or what corresponds to it
    float inv_pmf = 0;  // 1 / its probability in the table
};

/// All lights of a scene: a table to draw candidates from, and what their targets need.
struct ManyLights {
    LightTable table;
    std::vector<LightBounds> bounds;
    int M;  // how many are candidates for one shadow ray: at most as many as there are
};
ManyLights many_lights(const Scene& scene, LightTable table, int M);

/// Candidates for one shadow ray, each with its target at a point.
struct Candidates {
    static constexpr int most = 1024;
    int M;
    int light[most];
    float p_hat[most];   // W m^-2: the target, as in chapter 12
    float weight[most];  // p_hat / pmf
};

/// The light that was kept among M candidates.
struct Kept {
    size_t light = 0;
    float W = 0;  // what it counts for all others, in place of 1 / probability; 0: none gives light
};

/// Draws one candidate from each of M slices of the table; u in [0,1) is the place in each slice.
///
/// The same lights and targets as chapter 12's, one after the other, but for rounding.
/// tested by  "identity: candidates all at once are those of chapter 12"
Candidates draw_candidates(const ManyLights& lights, const Hit& x, double u);

/// Keeps each candidate with probability weight / weight_sum.      W = weight_sum / (M p_hat)
///
/// u in [0,1) decides. The same chances as a reservoir's, but no candidate waits for another.
/// tested by  "identity: each candidate is kept for its share of u"
Kept keep_one(const Candidates& candidates, float u);
