// Measures what each mistake does to the small scenes, in the copies that tests/diagnose/plant
// makes.
#include "tests/measure/measure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <regex>
#include <set>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stats.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/diagnose/planted.h"
#include "tests/diagnose/tiles.h"

namespace {

using Change = std::function<void(Scene&)>;

Image picture_of(const std::string& text, const NamedMethod& method, const MeasureOptions& o,
                 int spp, uint32_t seed, const Change& change = {}) {
    bool shines = text.find("rgb L") != std::string::npos;  // a scene must have a light
    std::string dim = shines ? "" : "LightSource \"infinite\" \"rgb L\" [1e-9 1e-9 1e-9]\n";
    Scene scene = parse_scene("small.pbrt", text + dim, nullptr);
    if (change) change(scene);
    prepare(scene, o.threads);
    return render_once(method, scene, o, spp, seed).film.image();
}

/// What a row that is no code does to a picture that is right.
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

/// What such a row does to a scene.
Change change_of(const std::string& how) {
    std::istringstream words(how);
    std::string what, argument, then;
    words >> what >> argument >> then;
    return [=](Scene& s) {
        double half = double{s.camera.fov} * std::numbers::pi / 360;
        double aspect = static_cast<double>(s.width) / s.height, tangent = std::tan(half);
        if (argument == "half") tangent /= 2;
        if (argument == "radians") tangent = half;
        if (argument == "longer") tangent /= aspect;
        if (argument == "2") tangent = std::tan(2 * half);  // below 0: turned by half a turn
        if (argument == "degrees") tangent = std::tan(double{s.camera.fov} / 2);
        if (argument == "whole") tangent = std::tan(double{s.camera.fov});
        if (what == "fov")
            s.camera.fov = static_cast<float>(360 / std::numbers::pi * std::atan(tangent));
        if (what == "shift") {  // all scenes are 16 pixels high
            float x = std::stof(argument) / 8, y = std::stof(then) / 8;
            float half_width = static_cast<float>(s.width) / 16;
            s.camera.screen_window = {x - half_width, x + half_width, y - 1, y + 1};
        }
        if (how == "aspect") s.camera.frame_aspect = 1;
        if (what == "radius")
            for (Sphere& sphere : s.geometry.spheres) sphere.r *= std::stof(argument);
        if (how != "watts of lamps" && how != "by area") return;
        for (Light& light : s.lights) {
            if (light.type != LightType::area) continue;
            double area = 0;
            for (uint32_t i = light.first_prim; i < light.first_prim + light.prims; i++)
                area += visit(
                    s.geometry, i,
                    [&](const Triangle& t) {
                        const std::vector<Vec3>& p = s.geometry.positions;
                        return double{length(cross(p[t.v[1]] - p[t.v[0]], p[t.v[2]] - p[t.v[0]]))} /
                               2;
                    },
                    [](const Sphere& b) {
                        return 4 * std::numbers::pi * double{b.r} * double{b.r};
                    },
                    [](const Disk&) { return 1.0; });
            double by = area * (how == "by area" ? 1 : std::numbers::pi);
            light.L = light.L / static_cast<float>(by);
        }
    };
}

/// The text of a scene whose albedos, or albedos and lamps, are taken to a power.
std::string with_power(std::string text, const std::string& how) {
    std::istringstream words(how);
    std::string what;
    float power = 1;
    words >> what >> power;
    for (const char* name : {"rgb reflectance\" [", "rgb L\" ["}) {
        if (what != "all" && (what != "albedo" || name[4] == 'L')) continue;
        for (size_t at = 0; (at = text.find(name, at)) != std::string::npos; at++) {
            size_t from = text.find('[', at) + 1, end = text.find(']', from);
            std::istringstream numbers(text.substr(from, end - from));
            std::string changed;
            for (float x; numbers >> x;) changed += std::to_string(std::pow(x, power)) + " ";
            text.replace(from, end - from, changed);
        }
    }
    return text;
}

/// Pictures of a scene with a mistake and without, of one seed.
struct Pair {
    Image wrong, right;
};
/// The tiles of a picture with a mistake over those of one without, with errors from the pixels; or
/// from a second pair, where a mistake moves edges.
Tiles effects_on(const SmallScene& scene, const Pair& one, const Pair* two) {
    Tiles tiles;
    auto of = [&](const Image Pair::*which, int x, int y, int c) {
        double first = channel((one.*which).at(x, y), c);
        return two ? (first + channel((two->*which).at(x, y), c)) / 2 : first;
    };
    for (size_t i = 0; i < scene.should.size(); i++) {
        double sum_p = 0, sum_b = 0, squares = 0, n = 0, scale = scale_of(scene, i);
        bool dark = key_of(scene, i).ends_with(" dark");
        visit_tile(i, scene.coloured, one.right.width, one.right.height, [&](int x, int y, int c) {
            sum_p += of(&Pair::wrong, x, y, c), sum_b += of(&Pair::right, x, y, c), n++;
        });
        double r = dark || sum_b == 0 ? sum_p / n / scale : sum_p / sum_b;
        visit_tile(i, scene.coloured, one.right.width, one.right.height, [&](int x, int y, int c) {
            auto off = [&](const Pair& pair) {
                double right = dark ? sum_p / n : r * channel(pair.right.at(x, y), c);
                return channel(pair.wrong.at(x, y), c) - right;
            };
            double d = two ? (off(one) - off(*two)) / 2 : off(one);
            squares += d * d * (scene.coloured ? 1 : 3);
        });
        tiles.push_back({r, std::sqrt(squares) / n / scale});
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

/// Measures the effects, and writes them down.
int write_effects(const MeasureOptions& o, const std::string& rows) {
    struct Way {
        const char* method;
        bool cosine, sky;
        int times;  // the samples
    };
    const std::map<char, Way> ways = {
        {'u', {"07", false, false, 2}},      {'c', {"07", true, false, 2}},
        {'n', {"09-area", false, false, 1}}, {'a', {"09-area", true, false, 1}},
        {'k', {"09-area", true, true, 1}},   {'m', {"14", true, false, 1}},
        {'b', {"14-balance", true, true, 1}}};
    std::map<std::string, Image> right, again, briefly;  // by way and scene; again: another seed
    std::string text =
        "# What planted mistakes do to the tiles of the small scenes, over what these should be: "
        "the way\n"
        "# of finding light, the mistake, and each scene in which something is off, with a "
        "standard\n"
        "# error. One number: all tiles alike. Of tiles that should be black: over the scene's "
        "mean.\n"
        "# By make effects.\n";
    std::map<std::string, std::vector<std::map<std::string, Tiles>>> known;  // by words
    std::map<std::string, bool> shown;  // by words: in any scene
    std::istringstream lines(read_file(rows));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream stream(line);
        std::string cells[6];
        for (std::string& cell : cells) std::getline(stream, cell, '\t');
        const std::string& how = cells[3];
        std::map<std::string, Tiles> with_uniform_sky;  // way a: of other scenes, k has the same
        for (char name : cells[1]) {
            bool is_code = ways.contains(name);
            const Way& way = ways.at(is_code ? name : 'm');
            const NamedMethod method = methods_named({way.method}).at(0);
            planted::cosine = way.cosine, planted::sky = way.sky;
            std::string effects;
            std::map<std::string, Tiles> all;
            for (const SmallScene& scene : small_scenes()) {
                if (name == 'k' && !scene.has_sky && !with_uniform_sky.empty()) {
                    const Tiles& tiles = all[scene.name] = with_uniform_sky[scene.name];
                    std::string effect = effect_text(scene, tiles);
                    if (!effect.empty()) effects += (effects.empty() ? "" : ";") + effect;
                    continue;
                }
                std::string key = std::string(is_code ? 1 : 0, name) + "/" + scene.name;
                auto render = [&](const std::string& in, int mistake, const Change& change, int spp,
                                  uint32_t seed = 1) {
                    planted::mistake = mistake;
                    // The lamp of bulb is found by chance alone: noisy, if no numbers are shared.
                    int times = scene.name == "bulb" && !is_code ? 64 : way.times;
                    return picture_of(in, method, o, spp * times, seed, change);
                };
                bool has_edges =
                    std::set<std::string>{"frame", "wide", "tilted"}.contains(scene.name);
                if (!right.contains(key)) {
                    right[key] = render(scene.pbrt, 0, {}, o.spp);
                    briefly[key] = render(scene.pbrt, 0, {}, 16);
                    if (!is_code || has_edges) again[key] = render(scene.pbrt, 0, {}, o.spp, 2);
                }
                const Image& b = right[key];
                Image p = b;
                std::optional<Pair> second;
                int mistake = is_code ? std::stoi(cells[0]) : 0;
                bool same =
                    is_code && render(scene.pbrt, mistake, {}, 16).pixels == briefly[key].pixels;
                if (is_code && !same) p = render(scene.pbrt, mistake, {}, o.spp);
                if (is_code && !same && has_edges)
                    second = {render(scene.pbrt, mistake, {}, o.spp, 2), again[key]};
                if (!is_code) {
                    std::string in =
                        name == 's' ? std::regex_replace(scene.pbrt, std::regex(cells[4]), cells[5])
                                    : with_power(scene.pbrt, how);
                    auto with = [&](const Image& image, uint32_t seed) {
                        Image other = name == 'p' ? changed(image, how) : image;
                        bool is_picture = other.pixels != image.pixels;
                        return is_picture ? other : render(in, 0, change_of(how), o.spp, seed);
                    };
                    p = with(b, 1), second = {with(again[key], 2), again[key]};
                }
                Tiles tiles = effects_on(scene, {p, b}, second ? &*second : nullptr);
                all[scene.name] = tiles;
                std::string effect = effect_text(scene, tiles);
                if (!effect.empty()) effects += (effects.empty() ? "" : ";") + effect;
            }
            if (name == 'a') with_uniform_sky = all;
            std::printf("%s %c %s: %zu letters\n", cells[0].c_str(), name, cells[2].c_str(),
                        effects.size());
            std::fflush(stdout);
            shown[cells[2]] |= !effects.empty();
            auto& others = known[cells[2]];  // the same may be known of another way
            if (effects.empty() ||
                std::any_of(others.begin(), others.end(),
                            [&](const auto& other) { return are_alike(all, other); }))
                continue;
            others.push_back(all);
            text += std::string(1, name) + "\t" + cells[2] + "\t" + effects + "\n";
        }
    }
    write_file_atomically(effects_file, text);
    for (const auto& [words, in_a_scene] : shown)
        if (!in_a_scene) std::printf("no scene shows this mistake: %s\n", words.c_str());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o =
            parse_measure_options(argc, argv, "ROWS", "Measures the small scenes.", {});
        return write_effects(o, o.words.at(0));
    });
}
