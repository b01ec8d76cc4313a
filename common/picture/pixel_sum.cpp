#include "common/picture/pixel_sum.h"

void PixelSum::raise(Sum sum, int by) {
    if (std::isnan(bins[0][sum])) return;
    for (int i = 2; i >= 0; i--) bins[i][sum] = i >= by ? bins[i - by][sum] : 0;
}

void PixelSum::raise_to(int channels, int squares_to) {
    for (Sum sum : {red, green, blue}) raise(sum, std::max(0, channels - top_channels));
    raise(squares, std::max(0, squares_to - top_squares));
    top_channels = std::max(top_channels, static_cast<uint8_t>(channels));
    top_squares = std::max(top_squares, static_cast<uint8_t>(squares_to));
}

void PixelSum::add_large(double r, double g, double b, double y2) {
    double numbers[sums] = {r, g, b, y2};
    for (Sum sum : {red, green, blue, squares}) {
        if (std::isfinite(numbers[sum])) continue;
        numbers[sum] = 0;
        for (auto& bin : bins) bin[sum] = std::nan("");
    }
    const auto& limit = pixel_sum::tops.limit;
    double largest = std::abs(numbers[0]) + std::abs(numbers[1]) + std::abs(numbers[2]);
    int channels = top_channels, squares_to = top_squares;
    while (!(largest < limit[static_cast<size_t>(channels)])) channels++;
    while (!(numbers[squares] < limit[static_cast<size_t>(squares_to)])) squares_to++;
    raise_to(channels, squares_to);
    add_fitting(numbers[0], numbers[1], numbers[2], numbers[3]);
}

void PixelSum::add(const PixelSum& other) {
    PixelSum aligned = other;
    aligned.raise_to(top_channels, top_squares);
    raise_to(aligned.top_channels, aligned.top_squares);
    for (size_t i = 0; i < 3; i++) {
        for (Sum sum : {red, green, blue, squares}) bins[i][sum] += aligned.bins[i][sum];
    }
    n += other.n;
}

PixelSum::Double2 PixelSum::add(Double2 a, Double2 b) {  // source: Knuth's two-sum
    double sum = a.high + b.high, from_b = sum - a.high;
    double lost = (a.high - (sum - from_b)) + (b.high - from_b);
    return {sum, lost + a.low + b.low};
}

PixelSum::Double2 PixelSum::value(Sum sum) const {
    return add(add({bins[0][sum], 0}, {bins[1][sum], 0}), {bins[2][sum], 0});
}

PixelSum::Double2 PixelSum::brightness() const {
    return add(add(value(red), value(green)), value(blue));
}

double PixelSum::m2() const {
    if (n == 0) return 0;
    // sum (X - q)^2 = sum X^2 - 2 q sum X + n q^2 with q = mean X. Where the mean is large, almost
    // all of it cancels: so fma() keeps what the products lose by rounding.
    Double2 sum = brightness(), sum2 = value(squares);
    double count = n, q = sum.high / count;
    double a = 2 * q * sum.high, a_lost = std::fma(2 * q, sum.high, -a);
    double q2 = q * q, q2_lost = std::fma(q, q, -q2);
    double b = count * q2, b_lost = std::fma(count, q2, -b);
    double high = (sum2.high - a) + b;
    double low = (sum2.low - a_lost) + b_lost + count * q2_lost - 2 * q * sum.low;
    double all = high + low;
    return (all < 0 ? 0 : all) / 9;  // keeps NaN
}
