// Measures what each mistake does to the small scenes, in the copies that tests/diagnose/plant
// makes.
#include "tests/measure/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/diagnose/planted.h"
#include "tests/diagnose/tiles.h"

namespace {

/// Pictures of a scene, of two seeds.
using Pair = std::array<Image, 2>;

/// A way of finding light: its method, how it samples directions and the sky, and how many times as
/// many samples it takes.
struct Way {
    const char* method;
    bool cosine, sky;
    int times;
};
const std::map<char, Way> ways = {
    {'u', {"07", false, false, 2}},      {'c', {"07", true, false, 2}},
    {'n', {"09-area", false, false, 1}}, {'a', {"09-area", true, false, 1}},
    {'k', {"09-area", true, true, 1}},   {'m', {"14", true, false, 1}},
    {'b', {"14-balance", true, true, 1}}};

Image picture_of(std::string text, const Way& way, const MeasureOptions& o, int mistake, int spp,
                 uint32_t seed) {
    planted::cosine = way.cosine, planted::sky = way.sky, planted::mistake = mistake;
    if (text.find("rgb L") == std::string::npos)  // a scene must have a light
        text += "LightSource \"infinite\" \"rgb L\" [1e-9 1e-9 1e-9]\n";
    Scene scene = parse_scene("small.pbrt", text, nullptr);
    prepare(scene, o.threads);
    const NamedMethod method = methods_named({way.method}).at(0);
    return render_once(method, scene, o, spp * way.times, seed).film.image();
}
Pair pair_of(const std::string& text, const Way& way, const MeasureOptions& o, int mistake,
             int times = 1) {
    return {picture_of(text, way, o, mistake, o.spp * times, 1),
            picture_of(text, way, o, mistake, o.spp * times, 2)};
}

/// What a mistake in the picture alone does to it.
Image changed(const Image& right, const std::string& how) {
    Image image = right;
    double power = how.starts_with("power ") ? std::stod(how.substr(6)) : 1;
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            int mx = how == "mirrored" || how == "turned" ? image.width - 1 - x : x;
            int my = how == "upside down" || how == "turned" ? image.height - 1 - y : y;
            if (how == "transposed" && image.width == image.height) std::swap(mx, my);
            Rgb c = right.at(mx, my);
            auto each = [&](auto of) { c = {of(c.r), of(c.g), of(c.b)}; };
            auto code = [](float v) {
                return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
            };
            if (how == "sRGB codes") each(code);
            if (how == "linear twice") each([](float v) { return from_srgb(v); });
            if (power != 1) each([&](float v) { return std::pow(v, static_cast<float>(power)); });
            if (how == "clamped") each([](float v) { return std::min(v, 1.0f); });
            if (how == "reinhard") each([](float v) { return v / (1 + v); });
            if (how == "exponential") each([](float v) { return 1 - std::exp(-v); });
            if (how == "blue first") std::swap(c.r, c.b);
            if (how == "green first") c = {c.g, c.b, c.r};
            if (how == "grey") c = {average(c), average(c), average(c)};
            image.at(x, y) = c;
        }
    return image;
}

/// The tiles of pictures with a mistake over those of pictures without. Their errors: from how far
/// the two seeds lie apart, pixel by pixel.
Tiles effects_on(const SmallScene& scene, const Pair& wrong, const Pair& right) {
    Tiles tiles;
    for (size_t i = 0; i < scene.should.size(); i++) {
        double sum_w = 0, sum_r = 0, squares = 0, n = 0, scale = scale_of(scene, i);
        auto each_number = [&](auto visit) {
            visit_tile(i, scene.coloured, right[0].width, 16, visit);
        };
        each_number([&](int x, int y, int c) {
            for (const Image& image : wrong) sum_w += channel(image.at(x, y), c) / 2;
            for (const Image& image : right) sum_r += channel(image.at(x, y), c) / 2;
            n++;
        });
        bool dark = key_of(scene, i).ends_with(" dark");
        double ratio = dark || sum_r == 0 ? sum_w / n / scale : sum_w / sum_r;
        each_number([&](int x, int y, int c) {
            auto off = [&](size_t k) {
                double expected = dark ? sum_w / n : ratio * channel(right[k].at(x, y), c);
                return channel(wrong[k].at(x, y), c) - expected;
            };
            double d = (off(0) - off(1)) / 2;
            squares += d * d * (scene.coloured ? 1 : 3);
        });
        tiles.push_back({ratio, std::sqrt(squares) / n / scale});
    }
    return tiles;
}

/// Whether two rows say the same.
bool are_alike(const std::map<std::string, Tiles>& one, const std::map<std::string, Tiles>& two) {
    for (const auto& [scene, tiles] : one)
        for (size_t i = 0; i < tiles.size(); i++) {
            Quantity a = tiles[i], b = two.at(scene)[i];
            double error = std::hypot(3.5 * a.se, 3.5 * b.se, 0.004 * a.mean);
            if (std::abs(a.mean - b.mean) > error + 1e-4) return false;
        }
    return true;
}

/// A row of rows.tsv, which tests/diagnose/plant writes into the folder.
struct Row {
    std::string number, ways, words, how;
};

/// Renders the small scenes with mistakes and without.
class Effects {
public:
    Effects(const MeasureOptions& o, const std::string& folder) : o_(o), folder_(folder) {}

    /// The tiles of a scene with the mistake of this row, by one way: 's' in the scene, 'p' in the
    /// picture, or a letter of `ways`.
    Tiles of(const Row& row, char name, const SmallScene& scene) {
        bool in_code = ways.contains(name);
        const Way& way = ways.at(in_code ? name : 'm');
        // The lamp of bulb is found by chance alone: noisy, if no numbers are shared.
        int times = scene.name == "bulb" && name == 's' ? 64 : 1;
        std::string key = std::string(1, name) + "/" + scene.name;
        if (!right_.contains(key)) {
            right_[key] = pair_of(scene.pbrt, way, o_, 0, times);
            briefly_[key] = picture_of(scene.pbrt, way, o_, 0, 16, 1);
        }
        const Pair& right = right_[key];
        Pair wrong = right;
        if (name == 'p') wrong = {changed(right[0], row.how), changed(right[1], row.how)};
        if (name == 's') {
            std::string file = folder_ + "/" + row.number + "/" + scene.name + ".pbrt";
            if (std::filesystem::exists(file)) wrong = pair_of(read_file(file), way, o_, 0, times);
        }
        if (in_code) {
            int mistake = std::stoi(row.number);
            if (picture_of(scene.pbrt, way, o_, mistake, 16, 1).pixels != briefly_[key].pixels)
                wrong = pair_of(scene.pbrt, way, o_, mistake);
        }
        return effects_on(scene, wrong, right);
    }

private:
    const MeasureOptions& o_;
    std::string folder_;
    std::map<std::string, Pair> right_;     // by way and scene
    std::map<std::string, Image> briefly_;  // the same with few samples
};

/// Measures the effects, and writes them down.
int write_effects(const MeasureOptions& o, const std::string& folder) {
    Effects effects(o, folder);
    std::string text =
        "# What planted mistakes do to the tiles of the small scenes, over what these should be: "
        "the way\n"
        "# of finding light, the mistake, and each scene in which something is off, with a "
        "standard\n"
        "# error. One number: all tiles alike. Of tiles that should be black: over the scene's "
        "mean.\n"
        "# By make effects.\n";
    std::map<std::string, std::vector<std::map<std::string, Tiles>>> known;  // by words
    std::istringstream lines(read_file(folder + "/rows.tsv"));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream cells(line);
        Row row;
        for (std::string* cell : {&row.number, &row.ways, &row.words, &row.how})
            std::getline(cells, *cell, '\t');
        for (char name : row.ways) {
            std::string off;
            std::map<std::string, Tiles> all;
            for (const SmallScene& scene : small_scenes()) {
                all[scene.name] = effects.of(row, name, scene);
                std::string effect = effect_text(scene, all[scene.name]);
                if (!effect.empty()) off += (off.empty() ? "" : ";") + effect;
            }
            std::printf("%s %c %s: %zu letters\n", row.number.c_str(), name, row.words.c_str(),
                        off.size());
            std::fflush(stdout);
            auto& others = known[row.words];  // the same may be known of another way
            bool is_known = std::any_of(others.begin(), others.end(),
                                        [&](const auto& other) { return are_alike(all, other); });
            if (off.empty() || is_known) continue;
            others.push_back(all);
            text += std::string(1, name) + "\t" + row.words + "\t" + off + "\n";
        }
    }
    write_file_atomically(effects_file, text);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o =
            parse_measure_options(argc, argv, "FOLDER", "Measures the small scenes.", {});
        return write_effects(o, o.words.at(0));
    });
}
