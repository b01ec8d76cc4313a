#include "common/picture/comparison.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/base/stats.h"

namespace {

constexpr int brightness = 3;  // behind red, green and blue

double value(Rgb c, int channel) {
    if (channel == brightness) return (double{c.r} + double{c.g} + double{c.b}) / 3;
    return double{channel == 0 ? c.r : channel == 1 ? c.g : c.b};
}

bool is_grey(const Image& image) {
    auto same = [](Rgb c) { return c.r == c.g && c.g == c.b; };
    return std::all_of(image.pixels.begin(), image.pixels.end(), same);
}

/// The squared error of a pixel, averaged over its channels: plain, and relative.
struct PixelError {
    double squared, relative;
};

PixelError error_of(Rgb a, Rgb b) {
    PixelError sum{0, 0};
    auto add = [&](float x, float y) {
        double d = double{x} - double{y};
        sum.squared += d * d / 3;
        sum.relative += d * d / (double{y} * double{y} + 0.01) / 3;
    };
    add(a.r, b.r);
    add(a.g, b.g);
    add(a.b, b.b);
    return sum;
}

std::vector<PixelError> errors_of(const Image& a, const Image& b) {
    std::vector<PixelError> errors;
    for (size_t i = 0; i < a.pixels.size(); i++) {
        errors.push_back(error_of(a.pixels[i], b.pixels[i]));
    }
    return errors;
}

bool is_smaller(PixelError x, PixelError y) { return x.relative < y.relative; }

/// The means over the pixels, without those that have the largest errors.
void sum_errors(std::vector<PixelError> errors, double trim, Comparison& result) {
    std::sort(errors.begin(), errors.end(), is_smaller);
    size_t left_out = static_cast<size_t>(trim / 100 * static_cast<double>(errors.size()));
    errors.resize(errors.size() - left_out);
    for (PixelError e : errors) {
        result.mse += e.squared / static_cast<double>(errors.size());
        result.rel_mse += e.relative / static_cast<double>(errors.size());
    }
    result.rmse = std::sqrt(result.mse);
}

/// Adds the row of one channel, block by block.
void add_row(const Image& a, const Image& b, int channel, Comparison& result) {
    constexpr const char* names[] = {"red", "green", "blue", "brightness"};
    constexpr int side = 8, fewest = 16;  // pixels of a block, to estimate their spread
    RunningStats mean_a, mean_b;
    for (Rgb p : a.pixels) mean_a.add(value(p, channel));
    for (Rgb p : b.pixels) mean_b.add(value(p, channel));
    ChannelComparison row{names[channel], mean_a.mean(), mean_b.mean()};
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
    for (int channel = 0; channel < 3 && !are_grey; channel++) add_row(a, b, channel, result);
    sum_errors(errors_of(a, b), trim, result);
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
