#include "common/render/class_sheet.h"

#include <algorithm>
#include <cmath>

#include "common/base/numbers.h"
#include "common/picture/sheet.h"

namespace {

/// The factor by which a picture is brightened: the largest for which at most 1 % of the pixels
/// that are not black become white.
int brightening(const Image& image) {
    std::vector<float> values;
    for (Rgb p : image.pixels) {
        if (!is_black(p)) values.push_back(is_finite(p) ? average(p) : 1);
    }
    if (values.empty()) return 1;
    auto bright = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
    std::nth_element(values.begin(), bright, values.end());
    int times = 1;
    while (times < 64 && 2 * static_cast<float>(times) * *bright <= 1) times *= 2;
    return times;
}

}  // namespace

Image class_sheet(const std::map<std::string, Film>& classes) {
    constexpr int most_width = 320;  // pixels, of a tile
    std::multimap<double, const std::string*> order;
    double all = 0;
    for (const auto& [name, film] : classes) {
        double mean = std::isnan(film.mean()) ? 0 : film.mean();
        order.insert({-mean, &name});
        all += mean;
    }
    std::vector<Tile> tiles;
    for (const auto& [minus_mean, name] : order) {
        Image image = classes.at(*name).image();
        int times = brightening(image);
        for (Rgb& p : image.pixels) p *= static_cast<float>(times);
        int n = (std::max(image.width, image.height) + most_width - 1) / most_width;
        std::string shown = times == 1 ? "" : std::to_string(times) + "x as bright";
        tiles.push_back({shrunk(image, n), {*name + "  " + percent(-minus_mean / all), shown}});
    }
    double columns = std::ceil(std::sqrt(static_cast<double>(tiles.size())));
    return sheet(tiles, std::max(1, static_cast<int>(columns)));
}
