// The mean and error of a picture where some samples are not finite.
#pragma once
#include "common/picture/film.h"

/// The mean of a picture and its standard error. Pixels with a sample that is not finite have no
/// mean, and are left out; both numbers are unknown (NaN) if no other pixels exist.
struct FinitePart {
    double mean = 0, error = 0;
    Rgb rgb;
    double share = 1;  // of the pixels that have samples: those with finite ones alone
};

/// tested by  "truth: where samples are not finite, mean and error are those of the others"
FinitePart finite_part(const Film& film);
