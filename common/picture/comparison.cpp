#include "common/picture/comparison.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stats.h"
#include "common/base/text.h"

namespace {

constexpr const char* channel_names[] = {"red", "green", "blue", "brightness"};
constexpr size_t brightness = 3;

double value(Rgb c, size_t channel) {
    const double values[] = {double{c.r}, double{c.g}, double{c.b}};
    return channel < brightness ? values[channel] : (values[0] + values[1] + values[2]) / 3;
}

/// The squared error of a pixel, averaged over its channels; in the order of the relative one.
struct PixelError {
    double relative = 0, squared = 0;
    auto operator<=>(const PixelError&) const = default;  // NOLINT(*-use-nullptr): version 14
};

std::vector<PixelError> errors_of(const Image& a, const Image& b) {
    std::vector<PixelError> errors(a.pixels.size());
    for (size_t i = 0; i < errors.size(); i++) {
        for (size_t channel = 0; channel < brightness; channel++) {
            double y = value(b.pixels[i], channel), d = value(a.pixels[i], channel) - y;
            errors[i].squared += d * d / 3;
            errors[i].relative += d * d / (y * y + 0.01) / 3;
        }
    }
    return errors;
}

/// Adds the row of one channel, block by block.
void add_row(const Image& a, const Image& b, size_t channel, Comparison& result) {
    constexpr int side = 8, fewest = 16;  // pixels of a block, to estimate their spread
    RunningStats mean_a, mean_b;
    ChannelComparison row{channel_names[channel]};
    double variance = 0, pixels = 0;  // of the sum of the differences
    result.blocks = 0;
    for (int y0 = 0; y0 < a.height; y0 += side) {
        for (int x0 = 0; x0 < a.width; x0 += side) {
            RunningStats difference, level;
            for (int y = y0; y < std::min(a.height, y0 + side); y++) {
                for (int x = x0; x < std::min(a.width, x0 + side); x++) {
                    double of_a = value(a.at(x, y), channel), of_b = value(b.at(x, y), channel);
                    mean_a.add(of_a);
                    mean_b.add(of_b);
                    difference.add(of_a - of_b);
                    level.add(std::abs(of_b));
                }
            }
            if (difference.count() < fewest) continue;
            double n = static_cast<double>(difference.count()), d = std::abs(difference.mean());
            variance += n * difference.variance();
            pixels += n;
            result.blocks++;
            bool is_rounding = d <= 1e-6 * level.mean();
            row.beyond_5 += !is_rounding && d / difference.standard_error() > 5;
        }
    }
    row.mean_a = mean_a.mean(), row.mean_b = mean_b.mean();
    row.standard_error = pixels > 0 ? std::sqrt(variance) / pixels : NAN;
    result.rows.push_back(row);
}

/// The value of a note; empty where there is none.
std::string value_of(const Picture& picture, const std::string& name) {
    for (const auto& [its_name, value] : picture.notes)
        if (its_name == name) return value;
    return "";
}
bool is_known(const Picture& picture) { return !value_of(picture, "checksum").empty(); }

bool agree(const Picture& a, const Picture& b, const std::string& name) {
    return value_of(a, name) == value_of(b, name);
}

}  // namespace

double ChannelComparison::difference() const {
    double d = mean_a - mean_b;
    return std::abs(d) <= 1e-6 * std::abs(mean_b) ? 0 : d / std::abs(mean_b);  // infinite for 0
}

double ChannelComparison::z() const {
    return difference() == 0 ? 0 : std::abs(mean_a - mean_b) / standard_error;
}

Comparison compare(const Image& a, const Image& b, double trim) {
    Comparison result;
    add_row(a, b, brightness, result);
    for (size_t channel = 0; channel < 3; channel++) add_row(a, b, channel, result);
    std::vector<PixelError> errors = errors_of(a, b);
    std::sort(errors.begin(), errors.end());
    size_t left_out = static_cast<size_t>(trim / 100 * static_cast<double>(errors.size()));
    errors.resize(errors.size() - left_out);
    for (PixelError e : errors) {
        result.mse += e.squared / static_cast<double>(errors.size());
        result.rel_mse += e.relative / static_cast<double>(errors.size());
    }
    return result;
}

void check_comparable(const Image& a, const std::string& name_a, const Image& b,
                      const std::string& name_b) {
    auto size = [](const Image& image) { return format("%dx%d", image.width, image.height); };
    if (size(a) != size(b))
        fail({name_b}, "has " + size(b) + " pixels, but " + name_a + " has " + size(a));
    for (const auto& [image, name] : {std::pair(&a, name_a), {&b, name_b}})
        for (Rgb p : image->pixels)
            if (!is_finite(p)) fail({name}, "not all of its pixels are finite");
}

/// The colour of share x of the range, linear.
static Rgb false_colour(double x) {
    constexpr Rgb stops[] = {{0, 0, 0},
                             {0.02f, 0.01f, 0.15f},
                             {0.2f, 0.01f, 0.25f},
                             {0.6f, 0.06f, 0.1f},
                             {0.95f, 0.3f, 0.01f},
                             {1, 0.75f, 0.1f},
                             {1, 1, 1}};
    constexpr double last = 6;
    double at = std::clamp(x, 0.0, 1.0) * last;
    size_t i = std::min(static_cast<size_t>(at), static_cast<size_t>(last) - 1);
    float t = static_cast<float>(at - static_cast<double>(i));
    return (1 - t) * stops[i] + t * stops[i + 1];
}

Image error_image(const Image& a, const Image& b, double& range) {
    Image picture(a.width, a.height);
    const std::vector<PixelError> errors = errors_of(a, b);
    if (range == 0) {
        std::vector<PixelError> sorted = errors;
        std::sort(sorted.begin(), sorted.end());
        range = std::sqrt(sorted[sorted.size() - 1 - sorted.size() / 100].relative);
    }
    for (size_t i = 0; i < errors.size(); i++) {
        picture.pixels[i] = false_colour(range > 0 ? std::sqrt(errors[i].relative) / range : 0);
    }
    return picture;
}

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
    if (!is_known(a) || !is_known(b)) return lines;
    for (const char* name : {"scene", "checksum", "stand-ins", "max-depth", "paths"}) {
        if (agree(a, b, name)) continue;
        lines.push_back(printable("warning: A has " + std::string(name) + " '" + value_of(a, name) +
                                  "', B '" + value_of(b, name) + "'"));
    }
    bool is_same_render = agree(a, b, "checksum") && agree(a, b, "chapter") &&
                          agree(a, b, "sampler") && agree(a, b, "seed");
    if (is_same_render && !value_of(a, "seed").empty() && !agree(a, b, "spp"))
        lines.push_back(
            "warning: A and B have samples in common, and so less difference than error: give one "
            "another --seed");
    return lines;
}

std::string verdict(const Comparison& c, const Picture& a, const Picture& b) {
    if (c.mse == 0) return "the same picture";
    // A picture with stand-ins shows another scene than one without.
    bool is_other = is_known(a) && is_known(b) && !agree(a, b, "checksum");
    if (is_other || !agree(a, b, "stand-ins"))
        return "the pictures show different scenes, so their difference is no noise";
    const ChannelComparison& all = c.rows[0];
    if (std::isnan(all.z())) return "how sure the means are is not known";
    std::string means;
    double most = 0;
    int blocks = 0;
    for (const ChannelComparison& row : c.rows) {
        double d = row.difference(), of_all = all.difference();
        std::string much = std::isinf(d) ? "" : percent(std::abs(d)) + " ";
        std::string in = &row == &all ? "" : std::string(" in ") + row.name;
        most = std::max(most, row.z());
        // A channel that differs as the brightness does is not named.
        bool is_told = !means.empty() && std::abs(d - of_all) <= std::abs(of_all) / 2;
        if (row.z() > 5 && !is_told)
            means += (means.empty() ? "" : ", ") + much + (d > 0 ? "brighter" : "darker") + in;
        // Noise alone puts about one block of a million beyond 5; some more, as errors are
        // estimates.
        if (row.beyond_5 > std::max(2, c.blocks / 200)) blocks = std::max(blocks, row.beyond_5);
    }
    std::string z = format(" (%.3g standard errors)", most);
    if (!means.empty()) return "other means: A is " + means + " than B" + z;
    if (blocks > 0)
        z = format(", but not everywhere: %d of %d blocks differ by more than noise does", blocks,
                   c.blocks);
    return "the same mean within the noise" + z;
}
