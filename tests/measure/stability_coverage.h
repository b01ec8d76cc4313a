// Do the standard errors that programs print hold, for every chapter and sampler?
#pragma once
#include "tests/measure/measure.h"
#include "tests/support/work.h"

/// Renders pictures with many seeds by every chapter and sampler, and prints for each the error
/// that is reported over the real one (the spread of the pictures' means), and how often the
/// interval mean +- 1.96 errors holds the truth. Returns how many break what is promised:
///
///   smooth scenes    the reported error is within a factor of 1.25 of the real one
///   all scenes       the intervals hold the truth, or most of the renders warn that they may not
int show_coverage(const MeasureOptions& options, Work& work);
/// The steps that it takes.
size_t coverage_steps();

/// Renders caustics, and the Cornell box, with many seeds by chapter 25. Where its bias exceeds the
/// reported error, each render must say that it blurs; and of the renders that do not say so, the
/// intervals of 85 % must hold the truth. Returns on how many scenes that breaks.
int show_blur(Work& work);
size_t blur_steps();
