// From what is off, and by how much, to the mistake that would make it so.
#pragma once
#include <string>
#include <vector>

#include "tests/check/findings.h"

/// A mistake, and where it shows best.
struct Name {
    std::string probe, path_class;
    std::string text;
    bool known = true;  // false: nothing in the list of mistakes makes it so
};

/// The mistake that explains the findings of a chapter; empty: nothing is off. `other`: those of
/// the chapter's second way (09: by area; 13: by the BSDF alone), or null.
///
/// From the pictures alone: nothing here knows the code of the chapter.
/// tested by  "truth: ratios and the mistakes that make them"
std::vector<Name> name_mistake(int chapter, const Findings& found, const Findings* other);

/// "1/pi" for 0.318: the nearest factor that mistakes are known to make, or "".
std::string name_factor(double ratio);
