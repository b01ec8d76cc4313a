#include "common/picture/comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stats.h"
#include "common/base/text.h"

namespace {

constexpr const char* channels[] = {"red", "green", "blue", "brightness"};
constexpr size_t brightness = 3;

double value(Rgb c, size_t channel) {
    const double values[] = {double{c.r}, double{c.g}, double{c.b}};
    return channel < brightness ? values[channel] : (values[0] + values[1] + values[2]) / 3;
}

bool is_grey(const Image& image) {
    auto same = [](Rgb c) { return c.r == c.g && c.g == c.b; };
    return std::all_of(image.pixels.begin(), image.pixels.end(), same);
}

/// The squared error of a pixel, averaged over its channels: plain, and relative.
struct PixelError {
    double squared = 0, relative = 0;
};
bool is_smaller(PixelError x, PixelError y) { return x.relative < y.relative; }

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
    for (Rgb p : a.pixels) mean_a.add(value(p, channel));
    for (Rgb p : b.pixels) mean_b.add(value(p, channel));
    ChannelComparison row{channels[channel], mean_a.mean(), mean_b.mean()};
    double variance = 0, pixels = 0;  // of the sum of the differences
    result.blocks = 0;
    for (int y0 = 0; y0 < a.height; y0 += side) {
        for (int x0 = 0; x0 < a.width; x0 += side) {
            RunningStats difference, level;
            for (int y = y0; y < std::min(a.height, y0 + side); y++) {
                for (int x = x0; x < std::min(a.width, x0 + side); x++) {
                    difference.add(value(a.at(x, y), channel) - value(b.at(x, y), channel));
                    level.add(std::abs(value(b.at(x, y), channel)));
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

/// Whether both have this note, with different values; and (below) with the same value.
bool differ(const Picture& a, const Picture& b, const std::string& name) {
    std::string x = value_of(a, name), y = value_of(b, name);
    return !x.empty() && !y.empty() && x != y;
}
bool agree(const Picture& a, const Picture& b, const std::string& name) {
    return !value_of(a, name).empty() && value_of(a, name) == value_of(b, name);
}

/// "2 % brighter"
std::string how_bright(const ChannelComparison& row) {
    double d = row.difference();
    std::string much = std::isinf(d) ? "" : percent(std::abs(d)) + " ";
    return much + (d > 0 ? "brighter" : "darker");
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
    bool are_grey = is_grey(a) && is_grey(b);
    for (size_t channel = 0; channel < 3 && !are_grey; channel++) add_row(a, b, channel, result);
    std::vector<PixelError> errors = errors_of(a, b);
    std::sort(errors.begin(), errors.end(), is_smaller);
    size_t left_out = static_cast<size_t>(trim / 100 * static_cast<double>(errors.size()));
    errors.resize(errors.size() - left_out);
    for (PixelError e : errors) {
        result.mse += e.squared / static_cast<double>(errors.size());
        result.rel_mse += e.relative / static_cast<double>(errors.size());
    }
    result.rmse = std::sqrt(result.mse);
    return result;
}

void check_comparable(const Image& a, const std::string& name_a, const Image& b,
                      const std::string& name_b) {
    auto size = [](const Image& image) {
        return std::to_string(image.width) + "x" + std::to_string(image.height);
    };
    if (size(a) != size(b))
        fail({name_b}, "has " + size(b) + " pixels, but " + name_a + " has " + size(a));
    for (const auto& [image, name] : {std::pair(&a, name_a), {&b, name_b}})
        for (size_t i = 0; i < image->pixels.size(); i++) {
            if (is_finite(image->pixels[i])) continue;
            size_t width = static_cast<size_t>(image->width), x = i % width, y = i / width;
            fail({name}, "pixel " + std::to_string(x) + "," + std::to_string(y) + " is not finite");
        }
}

Rgb false_colour(double x) {
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

Image error_image(const Image& a, const Image& b, double range) {
    Image picture(a.width, a.height);
    std::vector<PixelError> errors = errors_of(a, b);
    for (size_t i = 0; i < errors.size(); i++) {
        picture.pixels[i] = false_colour(range > 0 ? std::sqrt(errors[i].relative) / range : 0);
    }
    return picture;
}

double error_range(const Image& a, const Image& b) {
    std::vector<PixelError> errors = errors_of(a, b);
    auto place =
        errors.begin() + static_cast<std::ptrdiff_t>(errors.size() - 1 - errors.size() / 100);
    std::nth_element(errors.begin(), place, errors.end(), is_smaller);
    return std::sqrt(place->relative);
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
    for (const char* name : {"scene", "checksum", "stand-ins", "max-depth", "paths"}) {
        std::string x = value_of(a, name), y = value_of(b, name);
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
    // A picture with stand-ins shows another scene than one without.
    if (differ(a, b, "checksum") || value_of(a, "stand-ins") != value_of(b, "stand-ins"))
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
