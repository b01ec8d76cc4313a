// The matrix of what patches exchange, row by row, as long as there is room for it.
#pragma once
#include <span>

#include "chapters/26_radiosity/patches.h"

namespace ch26 {

/// What patches i < j exchange: G_ij = A_i F_ij, m^2. Any thread may ask.
using ExchangeOf = std::function<double(uint32_t i, uint32_t j)>;

/// The least and the largest sum of a row, before rows are repaired.
struct RowSums {
    double lowest = 1e300, highest = 0;
};

/// All of G, m^2, row by row.
using Matrix = std::vector<std::vector<float>>;

/// Rows of G. Each is computed when it is asked for, and kept if there is room for all.
/// tested by  "identity: rows that are not kept are the rows that are, for any threads and order"
class Rows {
public:
    static constexpr size_t most_kept = size_t{1} << 30;  // bytes

    Rows(const std::vector<Patch>& patch, int threads, ExchangeOf exchange)
        : threads_(threads), exchange_(std::move(exchange)) {
        for (const Patch& p : patch) area_.push_back(double{p.area});
        if (bytes() <= most_kept) kept_.resize(patch.size());
    }

    size_t bytes() const { return area_.size() * area_.size() * sizeof(float); }
    bool keeps() const { return !kept_.empty(); }
    const RowSums& sums() const { return sums_; }

    /// What patch i exchanges with each patch; valid until the next call.
    std::span<const float> row(size_t i) {
        if (!keeps()) return last_ = compute(i);
        if (kept_[i].empty()) kept_[i] = compute(i);
        return kept_[i];
    }
    /// All rows, which are kept no more. Where there is no room for all: nothing.
    Matrix take_all() {
        for (size_t i = 0; i < kept_.size(); i++) row(i);
        return std::move(kept_);
    }

private:
    std::vector<float> compute(size_t i) {
        constexpr size_t block = 256;
        size_t n = area_.size(), blocks = (n + block - 1) / block;
        std::vector<float> row(n);
        parallel_for(static_cast<int>(blocks), threads_, [&](int b) {
            size_t first = static_cast<size_t>(b) * block;
            for (size_t j = first; j < std::min(n, first + block); j++) {
                if (keeps() && !kept_[j].empty()) {
                    row[j] = kept_[j][i];
                } else if (j != i) {
                    row[j] = static_cast<float>(exchange_(static_cast<uint32_t>(std::min(i, j)),
                                                          static_cast<uint32_t>(std::max(i, j))));
                }
            }
        });
        double sum = 0;
        for (float G : row) sum += double{G} / area_[i];
        sums_.lowest = std::min(sums_.lowest, sum);
        sums_.highest = std::max(sums_.highest, sum);
        return row;
    }

    std::vector<double> area_;  // m^2
    int threads_ = 1;
    ExchangeOf exchange_;
    Matrix kept_;
    std::vector<float> last_;
    RowSums sums_;
};

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
