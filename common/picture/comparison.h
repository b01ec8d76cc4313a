// The errors of one picture relative to another.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "common/picture/image.h"

/// The means of one channel, or of the brightness, which is the mean of the three.
struct ChannelComparison {
    double mean_a = 0, mean_b = 0;
    double median_ratio = 0;    // median ratio of a / b where b > 0
    double standard_error = 0;  // of mean_a - mean_b; NaN where there is no block
    int beyond_5 = 0;           // blocks
};

/// The result of compare(). Errors are means of a - b over pixels and channels; b: the reference.
struct Comparison : ChannelComparison {         // of the brightness
    std::vector<ChannelComparison> channels{};  // red, green and blue; none where both are grey
    double mse = 0, rmse = 0;
    double rel_mse = 0;      // of (a-b)^2 / (b^2 + 0.01)
    double worst_share = 0;  // of the squared error, in the worst 0.1 % of the pixels
    int cut_off = 0;         // pixels with a channel of 1, the most in 8 bits, in one picture only

    // Differences of blocks of 8 x 8 pixels, in standard errors. These are estimated from the
    // spread of a - b within a block, which needs pixels with independent noise. Of the brightness
    // and the channels, the one that differs most counts.
    int blocks = 0;
    double worst_z = 0;
    int worst_x = 0, worst_y = 0;  // top left pixel of that block
};

inline constexpr int comparison_block = 8;
inline constexpr const char* channel_names[] = {"red", "green", "blue"};

/// Compares a with the reference b, pictures of the same size.
///
/// trim  percent of the pixels, those with the largest relative error, that mse, rmse, rel_mse and
///       worst_share leave out; means, ratio and blocks take all
/// tested by  "brute: a comparison's numbers counted in another way"
Comparison compare(const Image& a, const Image& b, double trim = 0);

/// Throws InputError when the sizes differ, or a pixel is not finite.
void check_comparable(const Image& a, const std::string& name_a, const Image& b,
                      const std::string& name_b);

/// The error of a pixel, sqrt of the mean over its channels of (a-b)^2 / (b^2 + 0.01), as a colour:
/// black for 0, then blue, purple, orange and yellow, to white for `range` and more.
Image error_image(const Image& a, const Image& b, double range);

/// A range that leaves 1 % of the pixels white.
double error_range(const Image& a, const Image& b);

/// The colour of share x of the range, linear.
Rgb false_colour(double x);
