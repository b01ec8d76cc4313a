// Damages scenes and meshes at random, and asks that the reader refuses or reads them, no more.
#pragma once
#include <chrono>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/path/sampler.h"
#include "common/picture/image.h"
#include "common/scene_file/ply.h"
#include "common/scene_file/reader.h"

/// Draws whole numbers; the same ones for the same seed.
class Dice {
public:
    explicit Dice(uint32_t seed) : sampler_(SamplerType::independent, seed, 1) {
        sampler_.start(0, 0);
    }
    /// From 0 to n - 1; 0 for n = 0.
    size_t below(size_t n) { return static_cast<size_t>(sampler_.u1() * static_cast<float>(n)); }

private:
    Sampler sampler_;
};

/// The input with one change; `words` are such that are likely to meet a weak spot.
inline std::string mutate(std::string bytes, const std::string& other,
                          const std::vector<std::string>& words, Dice& dice) {
    size_t at = dice.below(bytes.size() + 1), from = dice.below(other.size() + 1);
    size_t length = dice.below(dice.below(2) == 0 ? 4 : 40);
    size_t end = std::min(bytes.size(), at + length);
    const std::string& word = words[dice.below(words.size())];
    switch (dice.below(10)) {
        case 0: return bytes.erase(at, length);
        case 1: return bytes.insert(at, bytes.substr(at, length));
        case 2: return bytes.insert(at, other.substr(from, length));
        case 3: return bytes.replace(at, end - at, other.substr(from, length));
        case 4: return bytes.insert(at, word);
        case 5: return bytes.replace(at, end - at, word);
        case 6: return dice.below(10) == 0 ? bytes.substr(0, at) : bytes;
        case 7:
            if (at < bytes.size()) bytes[at] = static_cast<char>(dice.below(256));
            return bytes;
        default:  // a whole word or number for another
            size_t start = bytes.find_last_of(" \n[\"", at),
                   stop = bytes.find_first_of(" \n]\"", at);
            if (start == std::string::npos || stop == std::string::npos || start >= stop) {
                return bytes;
            }
            return bytes.replace(start + 1, stop - start - 1, word);
    }
}

/// The lines of a file.
inline std::vector<std::string> read_lines(const std::string& path) {
    std::vector<std::string> lines;
    std::istringstream text(read_file(path));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
}

/// Throws unless everything in the scene is what a renderer may rely on.
inline void check_scene(const Scene& scene) {
    auto require = [](bool holds, const char* what) {
        if (!holds) throw std::logic_error(what);
    };
    const Geometry& g = scene.geometry;
    require(scene.width > 0 && scene.height > 0 && scene.spp > 0 && scene.max_depth >= 0, "film");
    const Camera& c = scene.camera;
    require(is_finite(c.o) && is_finite(c.right) && is_finite(c.up) && is_finite(c.forward),
            "camera is not finite");
    require(length(cross(c.right, c.up)) > 0 && length(c.forward) > 0, "camera is flat");
    require(g.size() > 0 && !scene.lights.empty(), "nothing there");
    for (Vec3 p : g.positions) require(is_finite(p) && max_component(abs(p)) <= 1e9f, "position");
    require(g.normals.empty() || g.normals.size() == g.positions.size(), "count of normals");
    for (Vec3 n : g.normals) require(is_finite(n) && std::isfinite(dot(n, n)), "normal");
    for (const Triangle& t : g.triangles) {
        for (uint32_t v : t.v) require(v < g.positions.size(), "corner");
        require(t.shape < scene.shapes.size(), "shape of a triangle");
        Vec3 n = cross(g.positions[t.v[1]] - g.positions[t.v[0]],
                       g.positions[t.v[2]] - g.positions[t.v[0]]);
        require(std::abs(length(normalize(n)) - 1) < 1e-3f, "triangle without a normal");
    }
    for (const Sphere& s : g.spheres) {
        require(is_finite(s.c) && s.r > 0 && s.r * s.r > 0, "sphere");
        require(s.shape < scene.shapes.size(), "shape of a sphere");
    }
    for (const Disk& d : g.disks) {
        require(is_finite(d.c) && d.r > 0 && std::abs(length(d.n) - 1) < 1e-3f, "disk");
        require(d.shape < scene.shapes.size(), "shape of a disk");
    }
    for (const Shape& s : scene.shapes) {
        require(s.material < scene.materials.size(), "material");
        require(s.light < static_cast<int>(scene.lights.size()), "light");
    }
    for (const Light& light : scene.lights) {
        require(is_finite(light.L) && std::min({light.L.r, light.L.g, light.L.b}) >= 0 &&
                    !is_black(light.L),
                "radiance");
        require(is_finite(light.p), "place of a light");
        bool is_area = light.type == LightType::area;
        require(is_area == (light.prims > 0) && light.first_prim + light.prims <= g.size(),
                "prims");
    }
    for (const Material& m : scene.materials) {
        require(is_finite(m.reflectance) && max_component(m.reflectance) <= 1, "reflectance");
        require(is_finite(m.eta) && is_finite(m.k) && m.ior > 0 && m.alpha >= 0, "metal");
    }
}

/// Throws unless the message is a few lines that name a file each.
inline void check_message(const std::string& message) {
    constexpr size_t most = 21, longest = 2000;
    size_t count = 0;
    std::istringstream lines(message);
    for (std::string line; std::getline(lines, line); count++) {
        bool named = line.find(": error: ") != std::string::npos;
        if (!named || line.size() > longest) throw std::logic_error("message: " + line);
    }
    if (count == 0 || count > most) throw std::logic_error("messages: " + message);
}

struct FuzzResult {
    uint64_t read = 0, refused = 0;
    double slowest = 0;  // s
};

/// Reads `count` damaged inputs, from number `first` on. Each is a pure function of its number.
/// Throws for anything but a scene in which all is well, or an InputError of one line.
inline FuzzResult fuzz(uint32_t first, uint32_t count) {
    const std::string folder = "tests/fuzz/corpus/";
    std::vector<std::pair<std::string, std::string>> corpus;
    for (const char* name : {"features.pbrt", "part.pbrt", "square-ascii.ply", "square-little.ply",
                             "square-big.ply", "sky.pfm", "sky.png"}) {
        corpus.emplace_back(folder + name, read_file(folder + name));
    }
    for (const char* name : {"furnace", "veach-mis", "tiny-close-light"}) {
        std::string path = "tests/pictures/references/" + std::string(name) + ".pbrt";
        corpus.emplace_back(path, read_file(path));
    }

    std::vector<std::string> words = read_lines("tests/fuzz/words.txt");
    FuzzResult result;
    for (uint32_t i = first; i < first + count; i++) {
        Dice dice(i);
        auto [path, bytes] = corpus[dice.below(corpus.size())];
        for (size_t changes = 1 + dice.below(5) * dice.below(2); changes > 0; changes--) {
            bytes = mutate(bytes, corpus[dice.below(corpus.size())].second, words, dice);
        }
        auto start = std::chrono::steady_clock::now();
        try {
            if (path.ends_with(".ply")) {
                parse_ply(path, bytes);
            } else if (!path.ends_with(".pbrt")) {
                decode_image(path, bytes);
            } else {
                check_scene(parse_scene(path, bytes, nullptr));
            }
            result.read++;
        } catch (const InputError& error) {
            check_message(error.what());
            result.refused++;
        } catch (const std::exception& error) {
            throw std::logic_error("input " + std::to_string(i) + ": " + error.what());
        }
        std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        result.slowest = std::max(result.slowest, seconds.count());
    }
    return result;
}
