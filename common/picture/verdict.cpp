#include "common/picture/verdict.h"

#include <cstdio>
#include <filesystem>

#include "common/base/files.h"
#include "common/base/json.h"
#include "common/base/numbers.h"
#include "common/base/percent.h"
#include "common/base/position.h"
#include "common/base/system.h"
#include "common/picture/stats_file.h"

namespace {

/// Two digits, without an exponent.
std::string short_number(double x) {
    char text[40];
    std::snprintf(text, sizeof text, x < 10 ? "%.2g" : "%.0f", x);
    return text;
}

bool has_8_bits(const PictureFacts& facts) { return !has_ending(facts.file, ".pfm"); }

/// The relative difference of the means; 0 where they differ by rounding alone.
double difference_of(const ChannelComparison& c) {
    double difference = c.mean_a - c.mean_b;
    if (std::abs(difference) <= 1e-6 * std::abs(c.mean_b)) return 0;
    return difference / std::abs(c.mean_b);  // infinite for 0
}

/// How many standard errors the means differ by.
double z_of(const ChannelComparison& c, double standard_error) {
    return difference_of(c) == 0 ? 0 : std::abs(c.mean_a - c.mean_b) / standard_error;
}

/// "2 % brighter"
std::string how_bright(const ChannelComparison& c) {
    double d = difference_of(c);
    std::string much = std::isinf(d) ? "" : percent(std::abs(d)) + " ";
    return much + (d > 0 ? "brighter" : "darker");
}

/// Noise alone puts about one block of a million beyond 5; some more, as errors are estimates.
bool has_bad_blocks(const ChannelComparison& c, int blocks) {
    return c.beyond_5 > 2 && c.beyond_5 > blocks / 200;
}

/// Those channels whose means differ, each with how; empty where none does, or all in the same way,
/// which the brightness says. `z`: is set to the largest.
std::string about_channels(const Comparison& c, double standard_error, double& z) {
    double least = INFINITY, most = -INFINITY, blocks_error = 0;
    for (const ChannelComparison& channel : c.channels) {
        least = std::min(least, difference_of(channel));
        most = std::max(most, difference_of(channel));
        blocks_error += channel.standard_error / 3;
    }
    if (z > 5 && (least > most / 2 || most < least / 2)) return "";
    // Where pixels share their noise, the blocks know only a part of it.
    double share = std::max(1.0, standard_error / blocks_error);
    std::string text;
    for (size_t i = 0; i < c.channels.size(); i++) {
        double channel_z = z_of(c.channels[i], share * c.channels[i].standard_error);
        if (!(channel_z > 5)) continue;
        z = text.empty() ? channel_z : std::max(z, channel_z);
        text += (text.empty() ? "" : ", ") + how_bright(c.channels[i]) + " in " + channel_names[i];
    }
    return text;
}

std::string about_means(const Comparison& c, double standard_error, bool is_cut_off) {
    double z = z_of(c, standard_error);
    std::string channels = about_channels(c, standard_error, z);
    if (!channels.empty() || z > 5) {
        return "other means: A is " + (channels.empty() ? how_bright(c) : channels) + " than B, " +
               (is_cut_off ? "perhaps by noise that 8 bits cut off"
                           : "and noise does not do that") +
               " (" + short_number(z) + " standard errors)";
    }
    bool are_same = z == 0;
    std::string where;
    for (size_t i = 0; i < c.channels.size(); i++) {
        are_same &= difference_of(c.channels[i]) == 0;
        if (!has_bad_blocks(c.channels[i], c.blocks)) continue;
        where += (where.empty() ? " in " : " and ") + std::string(channel_names[i]);
    }
    if (where == " in red and green and blue") where = "";
    bool is_known = c.blocks > 0 || are_same || z > 0;
    if (std::isnan(z) || !is_known) return "how sure the means are is not known";
    if (!is_cut_off && has_bad_blocks(c, c.blocks)) {
        return "the same mean within the noise, but not everywhere: " + std::to_string(c.beyond_5) +
               " of " + std::to_string(c.blocks) + " blocks differ" + where +
               " by more than noise does";
    }
    return are_same ? "the same mean" : "the same mean within the noise";
}

std::string about_errors(const PictureFacts& a, const PictureFacts& b) {
    bool known = a.standard_error > 0 && b.standard_error > 0;
    if (!known) return "";
    bool b_is_better = b.standard_error < a.standard_error;
    const PictureFacts &good = b_is_better ? b : a, &bad = b_is_better ? a : b;
    double times = std::pow(bad.standard_error / good.standard_error, 2);
    if (times < 1.1) return "; both have the same error";
    std::string text = std::string("; ") + (b_is_better ? "B" : "A") + " has " +
                       percent(1 - 1 / times) + " less squared error";
    return text + ", worth " + short_number(times) + " times as many samples";
}

/// Whether both have this note, with different values; and (below) with the same value.
bool differ(const PictureFacts& a, const PictureFacts& b, const std::string& name) {
    std::string x = value_of(a.notes, name), y = value_of(b.notes, name);
    return !x.empty() && !y.empty() && x != y;
}
bool agree(const PictureFacts& a, const PictureFacts& b, const std::string& name) {
    std::string x = value_of(a.notes, name);
    return !x.empty() && x == value_of(b.notes, name);
}

/// A picture with stand-ins shows another scene than one without.
bool show_different_scenes(const PictureFacts& a, const PictureFacts& b) {
    return differ(a, b, "checksum") ||
           value_of(a.notes, "stand-ins") != value_of(b.notes, "stand-ins");
}

/// A value that may come from a damaged file.
std::string shown(const PictureFacts& facts, const std::string& name) {
    return printable(quote_file(value_of(facts.notes, name)));
}

/// The standard error of the mean, from one sample of that of each pixel: the squares add up.
double error_of_mean(const Image& errors) {
    double squares = 0;
    for (Rgb e : errors.pixels) squares += std::pow(static_cast<double>(average(e)), 2);
    return std::sqrt(squares) / static_cast<double>(errors.pixels.size());
}

}  // namespace

PictureFacts facts_of(const std::string& picture, const Image& image) {
    PictureFacts facts{picture};
    facts.notes = notes_in(decode_comment(picture, read_file(picture)));
    if (std::optional<StatsFile> stats = StatsFile::beside(picture)) {
        std::string path = StatsFile::path_beside(picture);
        PictureFacts beside{path, stats->number("standard_error").value_or(NAN), path,
                            notes_in(stats->texts("notes"))};
        if (beside.notes.empty())
            beside.notes = {{"spp", json_number(stats->number("spp").value_or(NAN))}};
        for (const auto& [name, value] : beside.notes) {
            if (name != "paths" && differ(facts, beside, name)) facts.other_stats = path;
        }
        if (facts.other_stats.empty()) {
            if (facts.notes.empty()) facts.notes = beside.notes;
            facts.standard_error = beside.standard_error;
            facts.known_from = path;
        }
    }
    std::string path = file_name(file_path(picture).replace_extension(".err.pfm"));
    if (std::filesystem::exists(file_path(path))) {
        Image errors = read_image(path);
        check_comparable(image, picture, errors, path);
        facts.standard_error = error_of_mean(errors);
        facts.known_from = path;
    }
    return facts;
}

std::vector<std::string> doubts(const PictureFacts& a, const PictureFacts& b) {
    std::vector<std::string> lines;
    auto warn = [&](const std::string& text) { lines.push_back("warning: " + text); };
    std::string unknown;
    for (const PictureFacts* facts : {&a, &b}) {
        if (!facts->other_stats.empty()) {
            warn(facts->other_stats + " is of another picture than " + facts->file +
                 ", and not used");
        }
        if (!value_of(facts->notes, "checksum").empty()) continue;
        unknown += (unknown.empty() ? "" : " and ") + facts->file;
    }
    for (const PictureFacts* facts : {&a, &b}) {
        if (value_of(facts->notes, "stand-ins").empty()) continue;
        warn(facts->file + " is not what its scene describes, but has stand-ins: " +
             printable(value_of(facts->notes, "stand-ins")));
    }
    if (differ(a, b, "checksum")) {
        warn(agree(a, b, "scene") ? "A and B show different versions of " + shown(a, "scene")
                                  : "A shows " + shown(a, "scene") + ", B " + shown(b, "scene"));
    }
    std::optional<int> depth_a = to_integer(value_of(a.notes, "max-depth"));
    std::optional<int> depth_b = to_integer(value_of(b.notes, "max-depth"));
    if (depth_a && depth_b && *depth_a != *depth_b) {
        warn("A has light of up to " + std::to_string(*depth_a) +
             " scattering events, B of up to " + std::to_string(*depth_b));
    }
    if (unknown.empty() && value_of(a.notes, "paths") != value_of(b.notes, "paths")) {
        auto paths = [](const PictureFacts& facts) {
            return value_of(facts.notes, "paths").empty() ? "all paths"
                                                          : "paths " + shown(facts, "paths");
        };
        warn("A has light of " + paths(a) + ", B of " + paths(b));
    }
    if (agree(a, b, "checksum") && agree(a, b, "chapter") && agree(a, b, "sampler") &&
        agree(a, b, "seed") && differ(a, b, "spp")) {
        warn(
            "A and B have samples in common: A - B is less than their errors; give one "
            "another --seed");
    }
    for (const PictureFacts* facts : {&a, &b}) {
        if (!has_8_bits(*facts)) continue;
        warn(facts->file +
             " has 8 bits: all that is brighter than 1 is cut off, and its mean with it");
    }
    if (!unknown.empty()) {
        lines.push_back("note: whether both show the same scene is not known: no word of it in " +
                        unknown + " (a .pfm needs --stats NAME.json beside it)");
    }
    return lines;
}

std::string verdict(const Comparison& c, double standard_error, const PictureFacts& a,
                    const PictureFacts& b) {
    if (c.mse == 0) return "the same picture";
    if (show_different_scenes(a, b))
        return "the pictures show different scenes, so their difference is no noise";
    bool is_cut_off = c.cut_off > 0 && (has_8_bits(a) || has_8_bits(b));
    return about_means(c, standard_error, is_cut_off) + about_errors(a, b);
}
