#include "common/picture/comparison.h"

#include <algorithm>
#include <cmath>

#include "common/base/position.h"
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

void sum_errors(std::vector<PixelError> errors, double trim, Comparison& result) {
    // Leave out the pixels with the largest errors.
    auto smaller = [](PixelError x, PixelError y) { return x.relative < y.relative; };
    std::sort(errors.begin(), errors.end(), smaller);
    size_t left_out = static_cast<size_t>(trim / 100 * static_cast<double>(errors.size()));
    errors.resize(errors.size() - left_out);

    // Average the rest.
    std::vector<double> squared;
    double sum = 0;
    for (PixelError e : errors) {
        squared.push_back(e.squared);
        sum += e.squared;
        result.rel_mse += e.relative / static_cast<double>(errors.size());
    }
    result.mse = sum / static_cast<double>(errors.size());
    result.rmse = std::sqrt(result.mse);

    // Compute the share of the worst thousandth.
    std::sort(squared.rbegin(), squared.rend());
    double worst = 0;
    size_t few = std::max<size_t>(1, squared.size() / 1000);
    for (size_t i = 0; i < few; i++) worst += squared[i];
    result.worst_share = sum > 0 ? worst / sum : 0;
}

double median_ratio(const Image& a, const Image& b, int channel) {
    std::vector<double> ratios;
    for (size_t i = 0; i < a.pixels.size(); i++) {
        double y = value(b.pixels[i], channel);
        if (y > 0) ratios.push_back(value(a.pixels[i], channel) / y);
    }
    if (ratios.empty()) return NAN;
    std::sort(ratios.begin(), ratios.end());
    size_t middle = ratios.size() / 2;
    return ratios.size() % 2 ? ratios[middle] : (ratios[middle - 1] + ratios[middle]) / 2;
}

/// Compares one channel, block by block; `worst`: by block, what is worst in any channel so far.
ChannelComparison compare_channel(const Image& a, const Image& b, int channel,
                                  std::vector<double>& worst) {
    RunningStats mean_a, mean_b;
    for (Rgb p : a.pixels) mean_a.add(value(p, channel));
    for (Rgb p : b.pixels) mean_b.add(value(p, channel));
    ChannelComparison result{mean_a.mean(), mean_b.mean(), median_ratio(a, b, channel)};
    double variance = 0, pixels = 0;  // of the sum of the differences
    size_t block = 0;
    for (int y0 = 0; y0 < a.height; y0 += comparison_block) {
        for (int x0 = 0; x0 < a.width; x0 += comparison_block) {
            RunningStats difference, level;
            for (int y = y0; y < std::min(a.height, y0 + comparison_block); y++) {
                for (int x = x0; x < std::min(a.width, x0 + comparison_block); x++) {
                    difference.add(value(a.at(x, y), channel) - value(b.at(x, y), channel));
                    level.add(std::abs(value(b.at(x, y), channel)));
                }
            }
            double& z = worst[block++];
            if (difference.count() < 16) continue;  // too few pixels to estimate the spread
            double n = static_cast<double>(difference.count());
            variance += n * difference.variance();
            pixels += n;
            z = std::max(z, 0.0);
            double d = std::abs(difference.mean());
            if (d <= 1e-6 * level.mean()) continue;  // rounding
            z = std::max(z, d / difference.standard_error());
            result.beyond_5 += d / difference.standard_error() > 5;
        }
    }
    result.standard_error = pixels > 0 ? std::sqrt(variance) / pixels : NAN;
    return result;
}

}  // namespace

Comparison compare(const Image& a, const Image& b, double trim) {
    // Compare the brightness and, where they can differ otherwise, the channels.
    int across = (a.width + comparison_block - 1) / comparison_block;
    int down = (a.height + comparison_block - 1) / comparison_block;
    std::vector<double> worst(static_cast<size_t>(across * down), -1);  // -1: too small a block
    Comparison result{compare_channel(a, b, brightness, worst)};
    bool are_grey = is_grey(a) && is_grey(b);
    for (int channel = 0; channel < 3 && !are_grey; channel++)
        result.channels.push_back(compare_channel(a, b, channel, worst));
    for (int i = 0; i < across * down; i++) {
        double z = worst[static_cast<size_t>(i)];
        result.blocks += z >= 0;
        if (z <= result.worst_z) continue;
        result.worst_z = z;
        result.worst_x = i % across * comparison_block;
        result.worst_y = i / across * comparison_block;
    }
    result.beyond_5 =
        static_cast<int>(std::count_if(worst.begin(), worst.end(), [](double z) { return z > 5; }));

    sum_errors(errors_of(a, b), trim, result);
    for (size_t i = 0; i < a.pixels.size(); i++) {
        Rgb p = a.pixels[i], q = b.pixels[i];
        bool differ =
            (p.r == 1) != (q.r == 1) || (p.g == 1) != (q.g == 1) || (p.b == 1) != (q.b == 1);
        result.cut_off += differ;
    }
    return result;
}

void check_comparable(const Image& a, const std::string& name_a, const Image& b,
                      const std::string& name_b) {
    auto size = [](const Image& image) {
        return std::to_string(image.width) + "x" + std::to_string(image.height);
    };
    if (a.width != b.width || a.height != b.height) {
        fail({name_b}, "has " + size(b) + " pixels, but " + name_a + " has " + size(a));
    }
    auto check = [](const Image& image, const std::string& name) {
        for (size_t i = 0; i < image.pixels.size(); i++) {
            if (is_finite(image.pixels[i])) continue;
            int x = static_cast<int>(i) % image.width, y = static_cast<int>(i) / image.width;
            fail({name}, "pixel " + std::to_string(x) + "," + std::to_string(y) + " is not finite");
        }
    };
    check(a, name_a);
    check(b, name_b);
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
    auto smaller = [](PixelError x, PixelError y) { return x.relative < y.relative; };
    auto place =
        errors.begin() + static_cast<std::ptrdiff_t>(errors.size() - 1 - errors.size() / 100);
    std::nth_element(errors.begin(), place, errors.end(), smaller);
    return std::sqrt(place->relative);
}
