// From what is off, and by how much, to the mistakes that would make it so.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "tests/check/findings.h"

/// One number for each tile of each scene: measured over expected; of a tile that should be black,
/// what it brings. The key is "scene/tile", or "scene/tile dark".
using Evidence = std::map<std::string, Quantity>;

/// A mistake, and what it makes of each number. What is not in `predicted` is as it should be.
struct Hypothesis {
    std::string routine;  // of mistakes that are alike: their common words
    std::string text;
    Evidence predicted;
};

/// How well a hypothesis predicts the evidence.
struct Fit {
    const Hypothesis* hypothesis;
    double log_likelihood;
    double worst;  // the largest distance of a prediction, in standard errors
};
/// The hypotheses that explain all evidence, to 6 standard errors and a thousand times better than
/// a right program does; the most likely one first.
std::vector<Fit> explanations(const std::vector<Hypothesis>& hypotheses, const Evidence& evidence);
