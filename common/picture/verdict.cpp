#include "common/picture/verdict.h"

#include <cstdio>
#include <filesystem>
#include <regex>

#include "common/base/percent.h"
#include "common/picture/stats_file.h"

namespace {

/// Two digits, without an exponent.
std::string short_number(double x) {
    char text[40];
    std::snprintf(text, sizeof text, x < 10 ? "%.2g" : "%.0f", x);
    return text;
}

std::string about_means(const Comparison& c, double standard_error) {
    double difference = c.mean_a - c.mean_b;
    if (c.mse == 0) return "the same picture";
    if (std::abs(difference) <= 1e-6 * std::abs(c.mean_b)) return "the same mean";
    double z = std::abs(difference) / standard_error;
    if (std::isnan(z)) return "how sure the means are is not known";
    if (z > 5) {
        std::string much = c.mean_b == 0 ? "" : percent(std::abs(difference / c.mean_b)) + " ";
        return "other means: A is " + much + (difference > 0 ? "brighter" : "darker") +
               " than B, and noise does not do that (" + short_number(z) + " standard errors)";
    }
    // Of so many blocks, noise alone puts one of a million beyond 5; their spread is an estimate.
    if (c.beyond_5 > 2 && c.beyond_5 > c.blocks / 200) {
        return "the same mean within the noise, but not everywhere: " + std::to_string(c.beyond_5) +
               " of " + std::to_string(c.blocks) + " blocks differ by more than noise does";
    }
    return "the same mean within the noise";
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
    bool equal = a.spp == b.spp, spp_known = a.spp > 0 && b.spp > 0;
    if (equal) return text + ": at equal samples that is " + short_number(times) + " times fewer";
    if (!spp_known) return text + ", worth " + short_number(times) + " times as many samples";
    double each = times * bad.spp / good.spp;
    return text + " with " + short_number(good.spp) + " samples against " + short_number(bad.spp) +
           ": sample by sample " +
           (each >= 1 ? short_number(each) + " times fewer"
                      : short_number(1 / each) + " times more");
}

}  // namespace

PictureFacts facts_of(const std::string& picture) {
    PictureFacts facts;
    if (picture.ends_with(".png")) facts.command = read_comment(picture);
    static const std::regex scene("[^ ']+\\.pbrt");
    std::smatch found;
    if (std::regex_search(facts.command, found, scene)) facts.scene = found.str();
    if (std::optional<StatsFile> stats = StatsFile::beside(picture)) {
        facts.standard_error = stats->number("standard_error").value_or(NAN);
        facts.spp = stats->number("spp").value_or(NAN);
        facts.scene = stats->text("scene");
    }
    return facts;
}

std::vector<std::string> doubts(const std::string& name_a, const PictureFacts& a,
                                const std::string& name_b, const PictureFacts& b) {
    std::vector<std::string> lines;
    auto file = [](const std::string& scene) { return std::filesystem::path(scene).filename(); };
    if (!a.scene.empty() && !b.scene.empty() && file(a.scene) != file(b.scene))
        lines.push_back("A shows " + a.scene + ", B " + b.scene);
    for (const std::string* name : {&name_a, &name_b}) {
        if (name->ends_with(".pfm")) continue;
        lines.push_back(
            *name + " has 8 bits: all that is brighter than 1 is cut off, and its mean with it");
    }
    return lines;
}

std::string verdict(const Comparison& c, double standard_error, const PictureFacts& a,
                    const PictureFacts& b) {
    return about_means(c, standard_error) + (c.mse == 0 ? "" : about_errors(a, b));
}
