// What a comparison of two pictures says, in words.
#pragma once
#include <cmath>
#include <string>

#include "common/picture/comparison.h"

/// What is known of a picture beside its pixels; NaN and "": not known.
struct PictureFacts {
    double standard_error = NAN;  // of its mean
    double spp = NAN;
    std::string scene, command;
};

/// From the statistics beside a picture (see StatsFile) and the command that a .png keeps.
PictureFacts facts_of(const std::string& picture);

/// Why the two should not be compared, or not by these files: one line each.
///
///   other scenes; a picture of 8 bits, in which all that is brighter than 1 is cut off
std::vector<std::string> doubts(const std::string& name_a, const PictureFacts& a,
                                const std::string& name_b, const PictureFacts& b);

/// One sentence: is the mean the same, and which of both has less error? standard_error: of the
/// difference of the means.
///
/// Five standard errors make a difference. Errors are compared where both are known; variance falls
/// as 1 / samples, so that the ratio of the squares is one of samples.
/// tested by  "truth: verdicts"
std::string verdict(const Comparison& c, double standard_error, const PictureFacts& a,
                    const PictureFacts& b);
