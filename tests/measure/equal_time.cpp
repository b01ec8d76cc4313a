#include <cmath>
#include <cstdio>
#include <filesystem>

#include "common/picture/comparison.h"
#include "tests/measure/curves.h"
#include "tests/measure/gnuplot.h"

namespace {

struct Shot {
    const Method* method;
    Image image;
    double rel_mse;
};

void put(Image& montage, const Image& image, int left, int top, int scale) {
    for (int y = 0; y < image.height * scale; y++) {
        for (int x = 0; x < image.width * scale; x++) {
            montage.at(left + x, top + y) = image.at(x / scale, y / scale);
        }
    }
}

std::string label(const std::string& text, double x, double y) {
    return "set label " + quoted_for_gnuplot(text) + " at screen " + digits(x) + "," + digits(y) +
           " center\n";
}

/// The shots above, their errors below, side by side; names over them by gnuplot.
void draw(const std::string& path, const std::string& title, const std::vector<Shot>& shots,
          const Reference& reference, double range) {
    constexpr int scale = 2, gap = 8;
    int side_x = reference.image.width * scale + gap, side_y = reference.image.height * scale + gap;
    int columns = static_cast<int>(shots.size()) + 1;
    Image montage(columns * side_x, 2 * side_y);
    for (Rgb& p : montage.pixels) p = {1, 1, 1};
    put(montage, reference.image, 0, 0, scale);
    int width = montage.width + 20, height = montage.height + 90;
    std::string labels = label(title, 0.5, 1 - 16.0 / height);
    auto name_column = [&](int column, const std::string& name, const std::string& below) {
        double x = (10 + (column + 0.5) * side_x) / width;
        labels += label(name, x, 1 - 42.0 / height) + label(below, x, 1 - 60.0 / height);
    };
    name_column(0, "reference", "");
    for (int i = 1; i < columns; i++) {
        const Shot& shot = shots[static_cast<size_t>(i) - 1];
        put(montage, shot.image, i * side_x, 0, scale);
        put(montage, error_image(shot.image, reference.image, range), i * side_x, side_y, scale);
        name_column(i, shot.method->name, short_number(shot.rel_mse));
    }
    std::string pixels = path + ".pixels.png";
    write_image(pixels, montage, "");
    draw_chart(path,
               labels + "unset border\nunset tics\nunset key\nset lmargin at screen " +
                   digits(10.0 / width) + "\nset rmargin at screen " + digits(1 - 10.0 / width) +
                   "\nset bmargin at screen " + digits(15.0 / height) + "\nset tmargin at screen " +
                   digits(1 - 75.0 / height) + "\nplot '" + pixels +
                   "' binary filetype=png with rgbimage",
               width, height);
    std::filesystem::remove(pixels);
}

}  // namespace

void draw_equal_time(const std::string& path, const std::string& title,
                     const std::vector<Curve>& curves, const std::string& scene_path,
                     const Reference& reference, const MeasureOptions& o) {
    // As long as the slowest takes for 8 samples.
    double seconds = 0;
    auto per_sample = [](const Curve& c) { return c.points.back().seconds / c.points.back().spp; };
    for (const Curve& c : curves) {
        if (!c.points.empty()) seconds = std::max(seconds, 8 * per_sample(c));
    }
    Scene scene = load_scene_for(scene_path, o);
    std::vector<Shot> shots;
    std::vector<double> ranges;
    for (const Curve& c : curves) {
        if (c.points.empty()) continue;
        int spp = std::max(1, static_cast<int>(std::lround(seconds / per_sample(c))));
        Image image = render_once(*c.method, scene, o, spp, 77).film.image();
        shots.push_back({c.method, image, compare(image, reference.image).rel_mse});
        ranges.push_back(error_range(image, reference.image));
    }
    if (shots.empty()) return;
    double range = median(ranges);
    draw(path,
         title + ": each " + short_number(1000 * seconds) +
             " ms; names with relMSE. Below: relative error, black 0, white " +
             short_number(range) + " and more",
         shots, reference, range);
}
