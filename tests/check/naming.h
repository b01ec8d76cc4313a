// From what is off, and by how much, to the mistakes that would make it so.
#pragma once
#include <string>
#include <vector>

#include "tests/check/findings.h"

/// One number for each class of path of each probe: measured over expected; of a class that should
/// bring nothing, what it brings. The key is "probe/class"; of a chapter's second way
/// "2:probe/class".
using Evidence = std::map<std::string, Quantity>;

/// All that was measured. `other`: of the chapter's second way (09: by area; 13: by the BSDF
/// alone), or null.
Evidence evidence_of(const Findings& found, const Findings* other);

/// A mistake, and what it makes of each number. What is not in `predicted` is as it should be.
struct Hypothesis {
    std::string routine;  // in which it stands
    std::string text;
    Evidence predicted;
    bool own = true;  // false: planted in another chapter that finds light in the same ways
};

/// The mistakes that were planted in a chapter, and measured: tests/check/hypotheses.tsv. Also
/// those of chapters that find light in the same ways, in routines that stand in this one's code.
std::vector<Hypothesis> read_hypotheses(const std::string& text, const std::string& chapter,
                                        const std::string& code);
/// The part of the evidence that is not as it should be, as it stands in a line of that file.
std::string prediction_text(const Evidence& evidence);

/// How well a hypothesis predicts the evidence.
struct Fit {
    const Hypothesis* hypothesis;
    double log_likelihood;
    double worst;  // the largest distance of a prediction, in standard errors
    bool explains() const { return worst < 6; }
};
/// The hypotheses that explain all evidence, a thousand times better than a right program does, the
/// most likely one first, and of them only those that are not `ratio` times less likely than the
/// first.
std::vector<Fit> explanations(const std::vector<Hypothesis>& hypotheses, const Evidence& evidence,
                              double ratio = 1000);

/// Sentences on what all paths that are off have in common; empty: none is off.
std::string where_to_look(const Evidence& evidence);

/// What is said of a chapter whose pictures are not right; empty: they are.
///
/// From the pictures alone: nothing here knows the code of the chapter. A mistake is named only if
/// it explains all probes, and a thousand times better than every other; else two that explain them
/// are named, with the probe that tells them apart; else what all paths that are off have in
/// common. tested by  "truth: a mistake is named only if it explains all that was measured"
std::string name_mistake(const std::vector<Hypothesis>& hypotheses, const Findings& found,
                         const Findings* other);

/// "1/pi" for 0.318: the nearest factor that mistakes are known to make, or "".
std::string name_factor(double ratio);
