// The result of comparing two pictures, in words.
#pragma once
#include <cmath>
#include <string>

#include "common/picture/comparison.h"
#include "common/picture/notes.h"

/// What is known of a picture besides its pixels.
struct PictureFacts {
    std::string file;
    double standard_error = NAN;   // of its mean; NaN: not known
    std::string known_from = {};   // the file it was read from
    Notes notes = {};              // what made it; empty: not known
    std::string other_stats = {};  // a file beside it that belongs to another picture
};

/// From the notes in a picture, and from the files beside it: NAME.err.pfm, one sample of the
/// standard error of each pixel, and NAME.json, the statistics. These count only where they do not
/// contradict the notes. Throws InputError where NAME.err.pfm does not fit the picture.
PictureFacts facts_of(const std::string& picture, const Image& image);

/// Why the two should not be compared, or not by these files: one line each, "warning: ...".
///
///   other scenes, depths, or classes of paths; samples in common; statistics of another picture; a
///   picture of 8 bits, in which values above 1 are clamped
///
/// Or "note: ..." where it is not known what they show.
std::vector<std::string> doubts(const PictureFacts& a, const PictureFacts& b);

/// One sentence: do the means agree, and which picture has the smaller error? standard_error: that
/// of the difference of the means.
///
/// Means differ if they are more than five standard errors apart, in brightness or in a channel,
/// which is then named. Errors are compared if both are known. The ratio of their squares is a
/// ratio of samples, since variance falls as 1 / samples. For different scenes it says only that
/// they differ.
/// tested by  "truth: verdicts", "truth: the verdict names the channels that differ"
std::string verdict(const Comparison& c, double standard_error, const PictureFacts& a,
                    const PictureFacts& b);
