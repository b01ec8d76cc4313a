// The state of a solution, and where the light went.
#pragma once
#include <memory>

#include "chapters/26_radiosity/patches.h"

namespace ch26 {

using Radiosity = Rgbd;  // W m^-2. In double: a thousand sweeps must not lose energy

/// What each patch has received so far.
struct Solution {
    std::vector<Radiosity> H;       // W m^-2
    std::vector<Radiosity> unshot;  // W m^-2, of B: not yet sent on; progressive refinement alone
    uint64_t steps = 0;             // sweeps, or shots
    Radiosity escaped;              // W, out of the room
};

/// A solution made ready for the picture.
struct Shown {
    std::shared_ptr<const Patches> patches;
    std::vector<std::array<Rgb, 3>> B;  // of each patch, at its corners, W m^-2
};

/// B at a point of a surface, W m^-2: linear between the corners of its patch; black where there is
/// no patch.
inline Rgb radiosity_at(const Shown& shown, const Hit& x) {
    Place at = place_of(*shown.patches, x);
    if (at.patch == no_side) return {};
    const auto& b = shown.B[at.patch];
    return at.b[0] * b[0] + at.b[1] * b[1] + at.b[2] * b[2];
}

/// Where the power of the lamps went, W: emitted = absorbed + escaped + unshot.
/// tested by  "identity: all that lamps emit is absorbed, escapes, or is unshot"
struct Balance {
    double emitted = 0, absorbed = 0, escaped = 0, unshot = 0;
    double error() const { return (absorbed + escaped + unshot) / emitted - 1; }
};
inline Balance balance_of(const std::vector<Patch>& patch, const Solution& s) {
    Balance b;
    for (size_t i = 0; i < patch.size(); i++) {
        double A = double{patch[i].area};
        b.emitted += A * sum_of(patch[i].E);
        b.absorbed += A * sum_of(s.H[i] - patch[i].rho * s.H[i]);
        if (!s.unshot.empty()) b.unshot += A * sum_of(s.unshot[i]);
    }
    b.escaped = sum_of(s.escaped);
    return b;
}

}  // namespace ch26
