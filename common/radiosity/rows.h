// The matrix of what patches exchange, row by row, as long as there is room for it.
#pragma once
#include <span>

#include "common/radiosity/patches.h"

/// What patches i < j exchange: G_ij = A_i F_ij, m^2. Any thread may ask.
using ExchangeOf = std::function<double(uint32_t i, uint32_t j)>;

/// The least and the largest sum of a row, before rows are repaired.
struct RowSums {
    double lowest = 1e300, highest = 0;
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
    const RowSums& sums() const { return sums_; }

    /// What patch i exchanges with each patch; valid until the next call.
    std::span<const float> row(size_t i);
    /// All of them, which are kept no more. Where there is no room for all: nothing.
    Matrix take_all();

private:
    std::vector<float> work_out(size_t i);

    std::vector<double> area_;  // m^2
    int threads_ = 1;
    ExchangeOf exchange_;
    Matrix kept_;
    std::vector<float> last_;
    RowSums sums_;
};
