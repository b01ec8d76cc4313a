// The matrix of what patches exchange, row by row; and a solution, and where the light went.
#pragma once
#include <memory>
#include <span>

#include "chapters/26_radiosity/patches.h"

namespace ch26 {

/// G_ij, m^2, row by row; a row that is not known yet is empty.
using Matrix = std::vector<std::vector<float>>;

/// What patches i < j exchange. Any thread may ask.
using ExchangeOf = std::function<double(uint32_t i, uint32_t j)>;

/// Row i of G; computes what other rows do not know yet.
/// tested by  "identity: repaired rows sum to 1, and both ends agree"
inline const std::vector<float>& row_of(Matrix& G, size_t i, int threads,
                                        const ExchangeOf& exchange) {
    if (!G[i].empty()) return G[i];
    constexpr size_t block = 256;
    size_t n = G.size(), blocks = (n + block - 1) / block;
    std::vector<float> row(n);
    parallel_for(static_cast<int>(blocks), threads, [&](int number) {
        size_t first = static_cast<size_t>(number) * block;
        for (size_t j = first; j < std::min(n, first + block); j++) {
            auto a = static_cast<uint32_t>(i), b = static_cast<uint32_t>(j);
            if (!G[j].empty()) {
                row[j] = G[j][i];
            } else if (j != i) {
                row[j] = static_cast<float>(exchange(std::min(a, b), std::max(a, b)));
            }
        }
    });
    return G[i] = row;
}

/// The share of the light of a patch that arrives anywhere, by its row: 1 in a closed room.
inline double row_sum(const std::vector<float>& row, const Patch& p) {
    double sum = 0;
    for (float G : row) sum += double{G};
    return sum / double{p.area};
}

/// Makes the rows' sums right, and keeps G_ij = G_ji: each row and column is multiplied by d_i.
///
///   sum over j of d_i G_ij d_j = A_i        in a closed room; in an open one only where it is more
///
/// tested by  "identity: repaired rows sum to 1, and both ends agree"
inline void repair(Matrix& G, const std::vector<Patch>& patch, bool closed,
                   const Stopped& stopped = {}) {
    std::vector<double> d(G.size(), 1), sum(G.size());
    for (int round = 0; round < 1000; round++) {
        double off = 0;
        for (size_t i = 0; i < G.size(); i++) {
            sum[i] = 0;
            for (size_t j = 0; j < G.size(); j++) sum[i] += double{G[i][j]} * d[j];
            sum[i] *= d[i] / double{patch[i].area};
            if (sum[i] == 0 || (!closed && sum[i] < 1)) sum[i] = 1;  // right, for all we know
            off = std::max(off, std::abs(sum[i] - 1));
        }
        if (off < 1e-7 || (stopped && stopped())) break;
        for (size_t i = 0; i < G.size(); i++) d[i] /= std::sqrt(sum[i]);
    }
    for (size_t i = 0; i < G.size(); i++) {
        for (size_t j = 0; j < G.size(); j++)
            G[i][j] = static_cast<float>(double{G[i][j]} * (d[i] * d[j]));
    }
}

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
    auto [patch, b] = place_of(*shown.patches, x);
    if (patch == no_side) return {};
    const auto& B = shown.B[patch];
    return b[0] * B[0] + b[1] * B[1] + b[2] * B[2];
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
