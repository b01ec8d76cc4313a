#include "tests/measure/reference.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/base/error.h"
#include "common/picture/stats_file.h"

std::string reference_path(const std::string& scene, const std::string& method) {
    return std::string(reference_folder) + "/" + file_name(scene) + "." + method;
}

Reference reference_for(const std::string& scene, const NamedMethod& under_test, int width,
                        int height, int max_depth) {
    Reference reference;
    reference.image = Image(width, height);
    // Take those that find light another way; else of other chapters; else of other options.
    auto made = [&](const NamedMethod& method) {
        return std::filesystem::exists(reference_path(scene, method.name) + ".pfm");
    };
    auto finds_light = [](const NamedMethod& m) { return std::pair(m.search, m.number() < 14); };
    auto difference = [&](const NamedMethod& method) {
        if (!made(method) || method.name == under_test.name) return 0;
        if (method.name.substr(0, 2) == under_test.name.substr(0, 2)) return 1;
        return finds_light(method) == finds_light(under_test) ? 2 : 3;
    };
    int most = 1;
    for (const NamedMethod& method : all_methods()) most = std::max(most, difference(method));
    double weights = 0, rel_weights = 0;
    for (const NamedMethod& method : all_methods()) {
        if (difference(method) < most) continue;
        std::string path = reference_path(scene, method.name);
        Image image = read_image(path + ".pfm");
        std::optional<StatsFile> stats = StatsFile::beside(path + ".pfm");
        if (image.width != width || image.height != height || !stats ||
            stats->number("max_depth") != max_depth) {
            throw InputError(path +
                             ".pfm: error: not of this size and depth; run: make references");
        }

        // The less sure a picture is, the less it counts.
        double weight = 1 / std::pow(stats->number("rmse").value_or(INFINITY), 2);
        for (size_t i = 0; i < image.pixels.size(); i++) {
            reference.image.pixels[i] += static_cast<float>(weight) * image.pixels[i];
        }
        weights += weight;
        rel_weights += 1 / stats->number("rel_mse").value_or(INFINITY);
        reference.made_by += (weights > weight ? " and " : "") + method.name;
    }
    if (weights == 0) {
        throw InputError(scene + ": error: no reference that another method than " +
                         under_test.name + " has made; run: make references");
    }
    for (Rgb& p : reference.image.pixels) p /= static_cast<float>(weights);
    reference.rmse = std::sqrt(1 / weights);
    reference.rel_mse = 1 / rel_weights;
    return reference;
}
