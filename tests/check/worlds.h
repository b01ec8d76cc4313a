// Random scenes, rendered by the reader's file and by the chapter's with the same random
// numbers: what both do alike cancels, so that few samples show what they do not.
#pragma once
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stats.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/known/scenes.h"
#include "tests/measure/measure.h"

/// Of what the chapter rendered: method, number of the world, and what was measured there: the mean
/// of a color, or of a class of path, in each of several renders; or the noise between two.
using WorldValues = std::map<std::tuple<std::string, int, std::string>, std::vector<double>>;

namespace worlds {
constexpr size_t batches = 32;
constexpr double sure = 6.5;   // standard errors, from 32 renders or 16 pairs
constexpr double seconds = 8;  // of processor time, of all methods of a chapter

/// Between each two renders: the mean square of their difference, beside the pixels' means.
inline std::vector<double> noise_of(const std::vector<Image>& images) {
    std::vector<double> mean(images[0].pixels.size()), noise;
    double all = 0, pixels = static_cast<double>(mean.size());
    for (const Image& image : images)
        for (size_t i = 0; i < mean.size(); i++) mean[i] += average(image.pixels[i]) / batches;
    for (double m : mean) all += m / pixels;
    if (all == 0) return {};
    for (size_t b = 0; b < images.size(); b += 2) {
        noise.push_back(0);
        for (size_t i = 0; i < mean.size(); i++) {
            double d = average(images[b].pixels[i]) - average(images[b + 1].pixels[i]);
            noise.back() += d * d / (mean[i] * mean[i] + 0.01 * all * all) / pixels;
        }
    }
    return noise;
}

/// Renders a world, if the chapter can render it.
inline void measure(const NamedMethod& method, const MeasureOptions& o, int number,
                    WorldValues& values) {
    std::string text = random_world(method.number(), static_cast<uint32_t>(number));
    Scene scene = parse_scene("world.pbrt", text, nullptr);
    if (!can_render(method, scene)) return;
    prepare(scene, o.threads);
    std::vector<Image> images;
    for (size_t batch = 0; batch < batches; batch++) {
        int spp = method.number() == 19 ? 24 : 2;  // 19 begins to choose after 16
        Rendering r = render_once(method, scene, o, spp, static_cast<uint32_t>(batch + 1), true);
        Rgb mean = r.film.mean_rgb();
        std::map<std::string, double> found = {
            {"red", mean.r}, {"green", mean.g}, {"blue", mean.b}};
        for (const auto& [name, film] : r.classes) found[name] = film.mean();
        for (const auto& [name, value] : found) {
            auto& list = values[{method.name, number, name}];
            list.resize(batches);
            list[batch] = value;
        }
        images.push_back(r.film.image());
    }
    values[{method.name, number, "noise"}] = noise_of(images);
}

/// Of all methods of the chapter, as many worlds as there is time for.
inline WorldValues measure_all(const std::string& chapter, const MeasureOptions& o) {
    WorldValues values;
    std::vector<NamedMethod> methods = methods_named({chapter + "+"});
    for (const NamedMethod& method : methods) {
        double start = cpu_seconds(), share = seconds / double(methods.size());
        for (int number = 0; cpu_seconds() - start < share; number++)
            measure(method, o, number, values);
    }
    return values;
}

inline void write(const WorldValues& values, const std::string& file) {
    std::ostringstream text;
    text.precision(17);
    for (const auto& [at, list] : values) {
        auto [method, number, name] = at;
        text << method << ' ' << number << ' ' << name;
        for (double x : list) text << ' ' << x;
        text << '\n';
    }
    write_file_atomically(file, text.str());
}
inline WorldValues read(const std::string& file) {
    WorldValues values;
    std::istringstream lines(read_file(file));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream cells(line);
        std::string method, name, x;
        int number = 0;
        cells >> method >> number >> name;
        auto& list = values[{method, number, name}];
        while (cells >> x) list.push_back(std::stod(x));
    }
    return values;
}

/// The reader's values over the chapter's, with the standard error of their difference: it is small
/// where both draw the same random numbers.
inline Quantity ratio_of(std::vector<double> mine, std::vector<double> chapters) {
    RunningStats difference, should;
    size_t n = std::max(mine.size(), chapters.size());
    mine.resize(n), chapters.resize(n);
    for (size_t i = 0; i < n; i++) difference.add(mine[i] - chapters[i]), should.add(chapters[i]);
    double by = difference.mean(), mean = std::abs(should.mean());
    if (by == 0) return {1, 0};
    if (mean == 0 && std::abs(by) <= sure * difference.standard_error()) return {1, 0};
    return {1 + by / mean, mean == 0 ? 0 : difference.standard_error() / mean};
}

/// Whether it is off: so surely that it is not by chance in one of the 10,000 numbers. More noise
/// is off, less is not.
inline bool is_off(const std::string& name, Quantity ratio) {
    double by = ratio.mean - 1;
    if (name == "noise") return by > std::max(0.5, sure * ratio.se);
    return !(std::abs(by) <= std::max(0.005, sure * ratio.se));
}
}  // namespace worlds
