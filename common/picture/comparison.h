// The errors of one picture relative to another, in numbers, colours and words.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "common/picture/film.h"

/// One channel, or the brightness, which is the mean of the three; a: the picture, b: the
/// reference.
struct ChannelComparison {
    const char* name;
    double mean_a = 0, mean_b = 0;
    double standard_error = 0;  // of mean_a - mean_b; NaN where there is no block
    int beyond_5 = 0;           // blocks that differ by more than 5 standard errors of their own

    double difference() const;  // of the means, relative; 0 where they differ by rounding alone
    double z() const;           // how many standard errors they differ by
};

/// Errors are means over pixels and channels. The standard errors come from the spread of a - b
/// within blocks of 8 x 8 pixels, which needs pixels with independent noise.
struct Comparison {
    std::vector<ChannelComparison> rows;  // brightness, red, green, blue
    int blocks = 0;
    double mse = 0;
    double rel_mse = 0;  // of (a-b)^2 / (b^2 + 0.01)
};

/// Compares a with the reference b, pictures of the same size. The errors leave out `trim` percent
/// of the pixels, those with the largest relative error.
/// tested by  "brute: a comparison's numbers counted in another way"
Comparison compare(const Image& a, const Image& b, double trim = 0);

/// Throws InputError when the sizes differ, or a pixel is not finite.
void check_comparable(const Image& a, const std::string& name_a, const Image& b,
                      const std::string& name_b);

/// The error of a pixel, sqrt of the mean over its channels of (a-b)^2 / (b^2 + 0.01), as a colour:
/// black for 0, then blue, purple, orange and yellow, to white for `range` and more. A range of 0
/// is set so that 1 % of the pixels are white.
Image error_image(const Image& a, const Image& b, double& range);

/// A picture, and what is known of how it was made.
struct Picture {
    std::string file;
    Image image = {};
    Notes notes = {};             // empty: not known
    double standard_error = NAN;  // of its mean; known of a film alone
};

/// Reads a film, or a picture with its notes. Throws InputError.
Picture read_picture(const std::string& path);

/// What speaks against comparing the two, one line each: other scenes, depths or classes of paths,
/// samples in common, 8 bits. "note: ..." where it is not known what they show.
std::vector<std::string> doubts(const Picture& a, const Picture& b);

/// One sentence: do the means agree? They differ if they are more than five standard errors apart,
/// in brightness or in a channel, which is then named. For different scenes it says only that they
/// differ.
/// tested by  "truth: verdicts", "truth: the verdict names the channels that differ"
std::string verdict(const Comparison& c, const Picture& a, const Picture& b);
