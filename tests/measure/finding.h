// What a chart of error against time says: how many times faster.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

/// An error that falls with time: relMSE, which is inverse to the time where all is well.
struct ErrorLine {
    std::vector<double> seconds, error;
};

/// Seconds until the line is at this error for good: between two of its points on the straight line
/// of their logarithms, before the first and after the last as if error times seconds stayed what
/// it is there. NaN for a line without points; tested by "truth: times faster at equal error".
inline double seconds_at(const ErrorLine& line, double error) {
    size_t n = line.error.size(), above = n;
    if (n == 0) return NAN;
    for (size_t i = 0; i < n; i++)
        if (line.error[i] >= error) above = i;
    if (above == n) return line.seconds[0] * line.error[0] / error;
    if (above == n - 1) return line.seconds[above] * line.error[above] / error;
    double part =
        std::log(line.error[above] / error) / std::log(line.error[above] / line.error[above + 1]);
    return line.seconds[above] * std::pow(line.seconds[above + 1] / line.seconds[above], part);
}

/// How many times less time the one takes than the other, at the smallest error that one of them
/// has reached. At larger errors the faster one takes so few samples that most of its time is that
/// before the first sample.
inline double times_faster(const ErrorLine& one, const ErrorLine& other) {
    if (one.error.empty() || other.error.empty()) return NAN;
    double error = std::min(one.error.back(), other.error.back());
    return seconds_at(other, error) / seconds_at(one, error);
}
