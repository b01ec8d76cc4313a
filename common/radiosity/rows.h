// The matrix of what patches exchange, row by row, as long as there is room for it.
#pragma once
#include <span>

#include "common/radiosity/patches.h"

/// G_ij = A_i F_ij, m^2, as found from patch i, and from j. Nearly the same: their mean is taken.
struct Exchange {
    double from_i = 0, from_j = 0;
};
/// Of patches i < j. Any thread may ask.
using ExchangeOf = std::function<Exchange(uint32_t i, uint32_t j)>;

/// What is wrong with the form factors before they are repaired.
struct Faults {
    double lowest = 1e300, highest = 0;  // of the sums of rows
    double apart = 0, all = 0;           // sums of |from_i - from_j|, and of their means
};

/// All of G, m^2, row by row.
using Matrix = std::vector<std::vector<float>>;

/// Rows of G, worked out when they are asked for, and kept if there is room for all.
/// tested by  "identity: rows that are not kept are the rows that are, for any threads and order"
class Rows {
public:
    static constexpr size_t most_kept = size_t{1} << 30;  // bytes

    Rows() = default;
    Rows(const std::vector<Patch>& patch, int threads, ExchangeOf exchange);

    size_t bytes() const { return area_.size() * area_.size() * sizeof(float); }
    bool keeps() const { return !kept_.empty(); }
    const Faults& faults() const { return faults_; }

    /// What patch i exchanges with each patch; valid until the next call.
    std::span<const float> row(size_t i);
    /// All of them, which are kept no more. Where there is no room for all: nothing.
    Matrix take_all();

private:
    std::vector<float> work_out(size_t i);
    float work_out(size_t i, size_t j, Faults& faults) const;

    std::vector<double> area_;  // m^2
    int threads_ = 1;
    ExchangeOf exchange_;
    Matrix kept_;
    std::vector<float> last_;
    Faults faults_;
};
