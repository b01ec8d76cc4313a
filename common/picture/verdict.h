// The result of comparing two pictures, in words.
#pragma once
#include <cmath>
#include <string>

#include "common/picture/comparison.h"
#include "common/picture/film_label.h"

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
