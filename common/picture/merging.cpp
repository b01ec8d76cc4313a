#include "common/picture/merging.h"

#include <cmath>
#include <filesystem>
#include <set>

#include "common/base/numbers.h"
#include "common/base/position.h"

namespace {

std::string number(double x) {
    char text[64];
    std::snprintf(text, sizeof text, "%.9g", x);
    return text;
}

std::vector<double> seeds_of(const StatsFile& stats) {
    std::vector<double> seeds = stats.numbers("seeds");
    return seeds.empty() ? stats.numbers("seed") : seeds;
}

}  // namespace

MergePart read_part(const std::string& word) {
    MergePart part;
    part.file = word;
    size_t colon = word.rfind(':');
    bool digits_follow = colon != std::string::npos && colon + 1 < word.size() &&
                         word.find_first_not_of("0123456789", colon + 1) == std::string::npos;
    if (digits_follow && !std::filesystem::exists(word)) {
        part.file = word.substr(0, colon);
        part.spp = to_number(word.substr(colon + 1)).value_or(0);
    }
    part.image = read_image(part.file);
    part.stats = StatsFile::beside(part.file);
    if (!digits_follow && part.stats) part.spp = part.stats->number("spp").value_or(0);
    if (part.spp > 0) return part;
    fail({part.file}, "how many samples per pixel has it? Name them as " + part.file +
                          ":SPP, or render with --stats " + StatsFile::path_beside(part.file));
}

void check_parts(const std::vector<MergePart>& parts) {
    std::set<double> seeds;
    const MergePart& first = parts[0];
    for (const MergePart& part : parts) {
        if (part.image.width != first.image.width || part.image.height != first.image.height) {
            fail({part.file}, "its size is not that of " + first.file);
        }
        if (!part.stats || !first.stats) continue;
        for (const char* name : {"scene", "chapter"}) {
            std::string a = part.stats->text(name), b = first.stats->text(name);
            if (a != b)
                fail({part.file},
                     std::string(name) + " " + a + ", but " + first.file + " has " + b);
        }
        if (part.stats->number("max_depth") != first.stats->number("max_depth")) {
            fail({part.file}, "its --max-depth is not that of " + first.file);
        }
        for (double seed : seeds_of(*part.stats)) {
            if (seeds.insert(seed).second) continue;
            fail({part.file}, "seed " + number(seed) + " is in another part already: its samples " +
                                  "would count twice");
        }
    }
}

Image merged_image(const std::vector<MergePart>& parts) {
    double spp = 0;
    for (const MergePart& part : parts) spp += part.spp;
    Image image(parts[0].image.width, parts[0].image.height);
    for (size_t i = 0; i < image.pixels.size(); i++) {
        double r = 0, g = 0, b = 0;
        for (const MergePart& part : parts) {
            Rgb p = part.image.pixels[i];
            r += part.spp * double{p.r}, g += part.spp * double{p.g}, b += part.spp * double{p.b};
        }
        image.pixels[i] = {static_cast<float>(r / spp), static_cast<float>(g / spp),
                           static_cast<float>(b / spp)};
    }
    return image;
}

std::string merged_stats(const std::vector<MergePart>& parts, const Image& image) {
    double spp = 0, seconds = 0, not_finite = 0, squares = 0, mean = 0;
    std::string seeds;
    for (const MergePart& part : parts) {
        if (!part.stats) return "";
        auto of = [&](const char* name) { return part.stats->number(name).value_or(NAN); };
        spp += part.spp;
        seconds += of("seconds");
        not_finite += of("samples_not_finite");
        squares += std::pow(part.spp * of("standard_error"), 2);
        mean += part.spp * of("mean");
        for (double seed : seeds_of(*part.stats))
            seeds += (seeds.empty() ? "" : ", ") + number(seed);
    }
    auto known = [](double x) { return std::isfinite(x) ? number(x) : "null"; };
    const StatsFile& first = *parts[0].stats;
    return "{\n  \"scene\": \"" + first.text("scene") + "\",\n  \"chapter\": \"" +
           first.text("chapter") + "\",\n  \"width\": " + std::to_string(image.width) +
           ",\n  \"height\": " + std::to_string(image.height) + ",\n  \"spp\": " + number(spp) +
           ",\n  \"max_depth\": " + known(first.number("max_depth").value_or(NAN)) +
           ",\n  \"seeds\": [" + seeds + "],\n  \"seconds\": " + known(seconds) +
           ",\n  \"mean\": " + known(mean / spp) +
           ",\n  \"standard_error\": " + known(std::sqrt(squares) / spp) +
           ",\n  \"samples_not_finite\": " + known(not_finite) + "\n}\n";
}
