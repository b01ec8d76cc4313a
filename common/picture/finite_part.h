// What a film says of its picture where some samples are not finite.
#pragma once
#include "common/picture/film.h"

/// The mean of a picture and its standard error. Where a sample is not finite, its pixel has no
/// mean: then they are those of the other pixels, and unknown (NaN) where there are no others.
struct FinitePart {
    double mean = 0, error = 0;
    Rgb rgb;
    double share = 1;  // of the pixels that have samples: those with finite ones alone
};

/// tested by  "failure: where samples are not finite, the mean is that of the other pixels"
FinitePart finite_part(const Film& film);
