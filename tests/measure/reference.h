// Pictures so exact that the charts can take them for the truth.
#pragma once
#include <string>

#include "common/picture/image.h"
#include "tests/measure/measure.h"

/// The mean of a scene's references, of how little it is sure, and by which methods it was made.
struct Reference {
    Image image;
    double rmse = 0, rel_mse = 0;  // expected, against the truth
    std::string made_by;
};

inline constexpr const char* reference_folder = "tests/measure/references";

/// The file of the reference of `scene` that a method made, without its ending.
std::string reference_path(const std::string& scene, const std::string& method);

/// The references of a scene (by scene_name) that were made by methods as different as can be from
/// the one under test, weighed by their errors. Throws InputError when there is none of this size
/// and depth.
Reference reference_for(const std::string& scene, const NamedMethod& under_test, int width,
                        int height, int max_depth);
