#include "common/picture/verdict.h"

#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/text.h"
#include "common/picture/film_file.h"

namespace {

/// Whether both have this note, with different values; and (below) with the same value.
bool differ(const Picture& a, const Picture& b, const std::string& name) {
    std::string x = value_of(a.notes, name), y = value_of(b.notes, name);
    return !x.empty() && !y.empty() && x != y;
}
bool agree(const Picture& a, const Picture& b, const std::string& name) {
    std::string x = value_of(a.notes, name);
    return !x.empty() && x == value_of(b.notes, name);
}

bool is_known(const Picture& picture) { return !value_of(picture.notes, "checksum").empty(); }

/// A picture with stand-ins shows another scene than one without.
bool show_different_scenes(const Picture& a, const Picture& b) {
    return differ(a, b, "checksum") ||
           value_of(a.notes, "stand-ins") != value_of(b.notes, "stand-ins");
}

/// "2 % brighter"
std::string how_bright(const ChannelComparison& row) {
    double d = row.difference();
    std::string much = std::isinf(d) ? "" : percent(std::abs(d)) + " ";
    return much + (d > 0 ? "brighter" : "darker");
}

}  // namespace

Picture read_picture(const std::string& path) {
    if (has_ending(path, film_ending)) {
        auto [label, film] = read_film(path);
        return {path, film.image(), notes_of(label, film.spp()), film.standard_error()};
    }
    std::string bytes = read_file(path);
    return {path, decode_image(path, bytes), notes_in(decode_comment(path, bytes))};
}

std::vector<std::string> doubts(const Picture& a, const Picture& b) {
    std::vector<std::string> lines;
    for (const Picture* picture : {&a, &b}) {
        if (!is_known(*picture))
            lines.push_back("note: " + picture->file + " does not tell which scene it shows");
        if (has_ending(picture->file, ".ppm") || has_ending(picture->file, ".png"))
            lines.push_back("warning: " + picture->file +
                            " has 8 bits: all that is brighter than 1 is cut off");
    }
    for (const char* name : {"scene", "checksum", "stand-ins", "max-depth", "paths"}) {
        std::string x = value_of(a.notes, name), y = value_of(b.notes, name);
        if (x == y || !is_known(a) || !is_known(b)) continue;
        lines.push_back(
            printable("warning: A has " + std::string(name) + " '" + x + "', B '" + y + "'"));
    }
    bool is_same_render = agree(a, b, "checksum") && agree(a, b, "chapter") &&
                          agree(a, b, "sampler") && agree(a, b, "seed");
    if (is_same_render && differ(a, b, "spp"))
        lines.push_back(
            "warning: A and B have samples in common, and so less difference than error: give one "
            "another --seed");
    return lines;
}

std::string verdict(const Comparison& c, const Picture& a, const Picture& b) {
    if (c.mse == 0) return "the same picture";
    if (show_different_scenes(a, b))
        return "the pictures show different scenes, so their difference is no noise";
    const ChannelComparison& all = c.rows[0];
    if (std::isnan(all.z())) return "how sure the means are is not known";
    std::string means, places;
    double most = 0;
    int most_blocks = 0;
    for (const ChannelComparison& row : c.rows) {
        std::string in = &row == &all ? "" : std::string(" in ") + row.name;
        most = std::max(most, row.z());
        // A channel that differs as the brightness does is not named.
        bool is_told = !means.empty() && std::abs(row.difference() - all.difference()) <=
                                             std::abs(all.difference()) / 2;
        if (row.z() > 5 && !is_told) means += (means.empty() ? "" : ", ") + how_bright(row) + in;
        // Noise alone puts about one block of a million beyond 5; some more, as errors are
        // estimates.
        if (row.beyond_5 <= std::max(2, c.blocks / 200)) continue;
        most_blocks = std::max(most_blocks, row.beyond_5);
        places += (places.empty() ? " in " : " and ") + std::string(row.name);
    }
    char z[40];
    std::snprintf(z, sizeof z, " (%.3g standard errors)", most);
    if (!means.empty()) return "other means: A is " + means + " than B" + z;
    if (most_blocks > 0)
        return "the same mean within the noise, but not everywhere: " +
               std::to_string(most_blocks) + " of " + std::to_string(c.blocks) + " blocks differ" +
               places + " by more than noise does";
    return std::string("the same mean within the noise") + z;
}
