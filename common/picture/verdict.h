// What a comparison of two pictures says, in words.
#pragma once
#include <cmath>
#include <string>

#include "common/picture/comparison.h"
#include "common/picture/notes.h"

/// What is known of a picture beside its pixels.
struct PictureFacts {
    std::string file;
    double standard_error = NAN;   // of its mean; NaN: not known
    std::string known_from = "";   // the file that says so
    Notes notes = {};              // what made it; empty: not known
    std::string other_stats = "";  // a file beside it that is of another picture
};

/// From the notes in a picture, and from the files beside it: NAME.err.pfm, one sample of the
/// standard error of each pixel, and NAME.json, the statistics. These count only where they do not
/// contradict the notes. Throws InputError where NAME.err.pfm does not fit the picture.
PictureFacts facts_of(const std::string& picture, const Image& image);

/// Why the two should not be compared, or not by these files: one line each, "warning: ...".
///
///   other scenes, depths, or classes of paths; samples in common; statistics of another picture; a
///   picture of 8 bits, in which all that is brighter than 1 is cut off
///
/// Or "note: ..." where it is not known what they show.
std::vector<std::string> doubts(const PictureFacts& a, const PictureFacts& b);

/// One sentence: is the mean the same, and which of both has less error? standard_error: of the
/// difference of the means.
///
/// Five standard errors make a difference. Errors are compared where both are known; variance falls
/// as 1 / samples, so that the ratio of the squares is one of samples. Of different scenes it says
/// only that they are.
/// tested by  "truth: verdicts"
std::string verdict(const Comparison& c, double standard_error, const PictureFacts& a,
                    const PictureFacts& b);
