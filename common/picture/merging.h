// One picture out of several renders of a scene with different seeds.
#pragma once
#include <string>
#include <vector>

#include "common/picture/image.h"
#include "common/picture/stats_file.h"

/// A render to be merged.
struct MergePart {
    std::string file;
    Image image;
    double spp = 0;                  // its weight
    std::optional<StatsFile> stats;  // what --stats wrote beside it
};

/// The picture FILE, or FILE:SPP; without SPP its samples are those that FILE's statistics name.
/// Throws InputError where they are not known.
MergePart read_part(const std::string& word);

/// Throws InputError where parts do not belong together: other sizes, scenes, depths, or the same
/// seed, which would count the same samples twice.
void check_parts(const std::vector<MergePart>& parts);

/// The mean of all samples:  sum spp_i image_i / sum spp_i.
///
/// The same, up to rounding of the parts to float, as one render of all samples.
/// tested by  "identity: merged renders equal one long run"
Image merged_image(const std::vector<MergePart>& parts);

/// Statistics of the whole as JSON; empty where a part has none.
std::string merged_stats(const std::vector<MergePart>& parts, const Image& image);
