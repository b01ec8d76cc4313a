#include "common/radiosity/rows.h"

#include "common/base/parallel.h"

Rows::Rows(const std::vector<Patch>& patch, int threads, ExchangeOf exchange)
    : threads_(threads), exchange_(std::move(exchange)) {
    for (const Patch& p : patch) area_.push_back(double{p.area});
    if (bytes() <= most_kept) kept_.resize(patch.size());
}

std::span<const float> Rows::row(size_t i) {
    if (!keeps()) return last_ = work_out(i);
    if (kept_[i].empty()) kept_[i] = work_out(i);
    return kept_[i];
}

Matrix Rows::take_all() {
    for (size_t i = 0; i < kept_.size(); i++) row(i);
    return std::move(kept_);
}

std::vector<float> Rows::work_out(size_t i) {
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
