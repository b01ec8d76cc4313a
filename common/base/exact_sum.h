// A sum of floats that is the same in any order.
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

/// The exact sum of floats >= 0, to which any thread may add: a whole number of the smallest float,
/// 2^-149, in words of 64 bits, since whole numbers have the same sum in any order.
///
///   x = mantissa 2^(shift - 149);   word[shift / 64] += mantissa << shift % 64,  and carry
///
/// There is room for 2^43 times the largest float. A negative number, an infinity or NaN makes the
/// sum NaN for good.
/// tested by  "identity: splats make the same bits in any order and on any number of threads"
class ExactSum {
public:
    void add(float x) {
        if (!(x >= 0 && x <= std::numeric_limits<float>::max())) {
            words_.back() |= not_a_number;
            return;
        }
        if (x == 0) return;  // or -0
        uint32_t bits = std::bit_cast<uint32_t>(x), shift = bits >> 23;
        uint64_t mantissa = bits & 0x7fffff;
        if (shift > 0) mantissa |= 0x800000, shift--;  // a normal number has one bit more
        uint32_t in_word = shift % 64;
        add_word(shift / 64, mantissa << in_word);
        if (in_word > 40) add_word(shift / 64 + 1, mantissa >> (64 - in_word));
    }

    /// Rounded to double; not while others add.
    double value() const {
        if (words_.back() & not_a_number) return std::nan("");
        double sum = 0;
        for (size_t i = words_.size(); i-- > 0;) {
            sum += std::ldexp(static_cast<double>(words_[i]), 64 * static_cast<int>(i) - 149);
        }
        return sum;
    }

private:
    static constexpr uint64_t not_a_number = uint64_t{1} << 63;  // in the last word

    void add_word(size_t i, uint64_t x) {
        for (; x > 0; i++) {
            uint64_t before = words_[i].fetch_add(x, std::memory_order_relaxed);
            x = before + x < before;  // the carry
        }
    }

    std::array<std::atomic<uint64_t>, 5> words_ = {};
};
