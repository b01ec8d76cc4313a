// Sums of the samples of one pixel that are the same in any order.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "common/base/vec.h"

namespace pixel_sum {
/// What belongs to bins that begin at `top`.
struct Tops {
    std::array<double, 29> rounder = {};  // M
    std::array<double, 29> limit = {};    // all numbers must be below

    constexpr Tops() {
        double unit = 0x1p-364;
        for (size_t top = 0; top < rounder.size(); top++, unit *= 0x1p26) {
            rounder[top] = 0x1.8p52 * unit, limit[top] = 0x1p25 * unit;
        }
    }
};
inline constexpr Tops tops;
}  // namespace pixel_sum

/// The samples of one pixel so far: their number, the sum of each channel, and the sum of the
/// squares of their brightness. The bits of the sums do not depend on the order of the samples, nor
/// on whether they were added one by one or as partial sums.
///
/// A number x is cut in pieces, each a multiple of its bin's unit and at most 2^25 of them:
///
///   unit_t = 2^(26 t - 364);   piece_t = (x + M) - M,  M = 1.5 2^52 unit_t;   x -= piece_t
///
/// (M is so large that x + M is rounded to the unit.) Each sum has three bins, in which the pieces
/// are added without any rounding. The first bin is t = `top`, chosen so that no number so far has
/// larger pieces. Pieces below the third bin are left out. So which pieces are added depends only
/// on the largest number.
///
/// error   at most 2^-53 of the largest number for each number added, like rounding to double; for
///         n above 2^28 the sums are rounded as usual
/// NaN     a channel becomes and stays NaN if one of its numbers is not finite
/// source  Demmel, Nguyen 2013, "Fast reproducible floating-point summation"
/// tested by  "identity: a pixel's sums have the same bits in any order and any grouping"
struct PixelSum {
    enum Sum { red, green, blue, squares, sums };
    static constexpr uint32_t most = 1u << 28;  // samples

    double bins[3][sums] = {};
    uint8_t top_channels = 2, top_squares = 2;
    uint8_t is_edge = 0, is_audited = 0;  // 0 or 1; see Film::start_audit()
    uint32_t n = 0;

    /// Adds a sample.
    void add(Rgb L) {
        double r{L.r}, g{L.g}, b{L.b}, y = r + g + b;
        add_numbers(r, g, b, y * y);
        n++;
    }
    /// Adds part of a sample, to the sums of the channels only.
    void add_part(Rgb L) { add_numbers(double{L.r}, double{L.g}, double{L.b}, 0); }
    /// Adds the samples of another sum.
    void add(const PixelSum& other);

    /// The sums of the channels.
    double r() const { return value(red).high; }
    double g() const { return value(green).high; }
    double b() const { return value(blue).high; }
    /// The mean of the brightness Y (the average of the channels), sum Y^2, sum (Y - mean)^2.
    double mean() const { return brightness().high / 3 / std::max(1.0, static_cast<double>(n)); }
    double sum_of_squares() const { return value(squares).high / 9; }
    double m2() const;

private:
    /// A number as the sum of two doubles, with twice the digits.
    struct Double2 {
        double high, low;
    };
    static Double2 add(Double2 a, Double2 b);
    Double2 value(Sum sum) const;
    Double2 brightness() const;  // of all samples, times 3

    void add_numbers(double r, double g, double b, double y2) {
        bool fits = std::abs(r) + std::abs(g) + std::abs(b) < pixel_sum::tops.limit[top_channels] &&
                    y2 < pixel_sum::tops.limit[top_squares];
        if (!fits) return add_large(r, g, b, y2);
        add_fitting(r, g, b, y2);
    }
    void add_fitting(double r, double g, double b, double y2) {
        using Double4 = double __attribute__((vector_size(32)));  // four at once
        double m = pixel_sum::tops.rounder[top_channels];
        Double4 x = {r, g, b, y2}, M = {m, m, m, pixel_sum::tops.rounder[top_squares]};
        for (auto& bin : bins) {
            Double4 piece = (x + M) - M, sum;
            std::memcpy(&sum, bin, sizeof sum);
            sum += piece;
            std::memcpy(bin, &sum, sizeof sum);
            x -= piece;
            M *= 0x1p-26;
        }
    }
    /// Adds numbers that may be too large for the bins, or not finite.
    void add_large(double r, double g, double b, double y2);
    /// Moves the bins of one sum up.
    void raise(Sum sum, int by);
    void raise_to(int channels, int squares_to);
};
static_assert(sizeof(PixelSum) == 104);
