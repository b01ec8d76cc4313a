// The matrix of what patches exchange, row by row.
#pragma once
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

}  // namespace ch26
