// Damages scenes and meshes at random, and asks that the reader refuses or reads them, no more.
#pragma once
#include <ctime>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/path/sampler.h"
#include "common/picture/image.h"
#include "common/scene/mover.h"
#include "common/scene/sky_image.h"
#include "common/scene/texture.h"
#include "common/scene_file/reader.h"
#include "tests/support/folder.h"

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
    const std::string& word = words[dice.below(words.size())];
    switch (dice.below(10)) {
        case 0: return bytes.erase(at, length);
        case 1: return bytes.insert(at, bytes.substr(at, length));
        case 2: return bytes.replace(at, length, other.substr(from, length));
        case 3: return bytes.insert(at, word);
        case 4:
            if (at < bytes.size()) bytes[at] = static_cast<char>(dice.below(256));
            return bytes;
        case 5: return dice.below(10) == 0 ? bytes.substr(0, at) : bytes;
        default:  // a whole word or number for another
            size_t start = bytes.find_last_of(" \n[\"", at) + 1;
            return bytes.replace(start, bytes.find_first_of(" \n]\"", start) - start, word);
    }
}

/// The .png with right checksums wherever its chunks have a right length.
inline std::string with_checksums(std::string png) {
    for (size_t at = 8; at + 12 <= png.size();) {
        size_t length = 0;
        for (size_t i = 0; i < 4; i++) length = length << 8 | static_cast<uint8_t>(png[at + i]);
        if (length > png.size() - at - 12) break;
        png.replace(at, 12 + length, png_chunk(png.substr(at + 4, 4 + length)));
        at += 12 + length;
    }
    return png;
}

inline std::vector<std::string> lines_of_file(const std::string& path) {
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
    auto is_light = [](Rgb L) { return is_finite(L) && std::min({L.r, L.g, L.b}) >= 0; };
    auto check_geometry = [&](const Geometry& g) {
        for (Vec3 p : g.positions)
            require(is_finite(p) && max_component(abs(p)) <= 1e9f, "position");
        require(g.normals.empty() || g.normals.size() == g.positions.size(), "count of normals");
        require(g.uvs.empty() || g.uvs.size() == g.positions.size(), "count of uv");
        for (Vec3 n : g.normals) require(std::isfinite(dot(n, n)), "normal");
        for (const Triangle& t : g.triangles) {
            require(t.shape < scene.shapes.size(), "shape of a triangle");
            bool textured = scene.materials[scene.shapes[t.shape].material].texture != 0;
            for (uint32_t v : t.v)
                require(v < g.positions.size() && (!textured || v < g.uvs.size()), "corner");
            Vec3 n = cross(g.positions[t.v[1]] - g.positions[t.v[0]],
                           g.positions[t.v[2]] - g.positions[t.v[0]]);
            require(std::abs(length(normalize(n)) - 1) < 1e-3f, "triangle without a normal");
        }
        for (const Sphere& s : g.spheres)
            require(is_finite(s.c) && s.r * s.r > 0 && s.shape < scene.shapes.size(), "sphere");
        for (const Disk& d : g.disks)
            require(is_finite(d.c) && d.r > 0 && std::abs(length(d.n) - 1) < 1e-3f, "disk");
    };
    check_geometry(scene.geometry);
    for (const auto& mover : scene.movers) check_geometry(mover->geometry);
    if (scene.sky_image)
        for (Rgb L : scene.sky_image->pixels) require(is_light(L), "pixel of the sky");
    require(scene.width > 0 && scene.height > 0 && scene.spp > 0 && scene.max_depth >= 0, "film");
    const Camera& c = scene.camera;
    require(is_finite(c.o) && is_finite(c.forward), "camera is not finite");
    require(length(cross(c.right, c.up)) > 0 && length(c.forward) > 0, "camera is flat");
    require(!scene.lights.empty() || scene.sky_image, "no light");
    for (const Shape& s : scene.shapes)
        require(
            s.material < scene.materials.size() && s.light < static_cast<int>(scene.lights.size()),
            "shape");
    for (const Light& light : scene.lights)
        require(is_light(light.L) && !is_black(light.L) && is_finite(light.p) &&
                    light.first_prim + light.prims <= scene.geometry.size(),
                "light");
    for (const Material& m : scene.materials) {
        require(is_finite(m.reflectance) && max_component(m.reflectance) <= 1, "reflectance");
        require(is_finite(m.eta) && is_finite(m.k) && m.ior > 0 && m.alpha >= 0, "metal");
        require(m.texture <= (scene.textures ? scene.textures->all.size() : 0), "texture");
        for (Vec2 uv : {Vec2{0.3f, 0.8f}, Vec2{-1e9f, 1e9f}})
            require(m.texture == 0 || is_light(value_at(*scene.textures, m.texture - 1u, uv)),
                    "value of a texture");
    }
}

/// Throws unless the message is a few lines that name a file each, fit for a terminal.
inline void check_message(const std::string& message) {
    constexpr size_t most = 1021, longest = 10'000;  // each missing file has a line
    size_t count = 0;
    std::istringstream lines(message);
    for (std::string line; std::getline(lines, line); count++) {
        bool named = line.find(": error: ") != std::string::npos && line == printable(line);
        if (!named || line.size() > longest) throw std::logic_error("message: " + line);
    }
    if (count == 0 || count > most) throw std::logic_error("messages: " + message);
}

struct FuzzResult {
    uint32_t read = 0, refused = 0;
};

/// Reads `count` damaged inputs, from number `first` on. Each is a pure function of its number.
/// Meshes and pictures are named by a scene, and read as parts of it. Throws for anything but a
/// scene in which all is well or an InputError of some lines; one that takes too long ends all.
inline FuzzResult fuzz(uint32_t first, uint32_t count) {
    TemporaryFolder temporary;
    std::vector<std::pair<std::string, std::string>> corpus;
    for (const char* name :
         {"damage/corpus/features.pbrt", "damage/corpus/part.pbrt",
          "damage/corpus/square-ascii.ply", "damage/corpus/square-little.ply",
          "damage/corpus/square-big.ply", "damage/corpus/sky.pfm", "damage/corpus/sky.png",
          "damage/corpus/sky.jpg", "damage/corpus/sky.tga", "pictures/references/furnace.pbrt",
          "pictures/references/veach-mis.pbrt", "pictures/references/tiny-close-light.pbrt",
          "pictures/real-scenes/cornell-box/scene-v4.pbrt"}) {
        std::string path = std::string("tests/") + name;
        corpus.emplace_back(path, read_file(path));
    }
    // All that pbrt has, from line to line of another one of them.
    std::string all = "Camera \"perspective\" WorldBegin LightSource \"infinite\"\n";
    for (const std::string& line : lines_of_file("tests/support/pbrt_v4.txt"))
        if (line.starts_with("w ")) all += "AttributeBegin " + line.substr(2) + " AttributeEnd\n";
    corpus.emplace_back("tests/damage/corpus/all.pbrt", all);
    std::vector<std::string> words = lines_of_file("tests/damage/words.txt");

    FuzzResult result;
    for (uint32_t i = first; i < first + count; i++) {
        Dice dice(i);
        auto [path, bytes] = corpus[dice.below(corpus.size())];
        for (size_t changes = 1 + dice.below(5) * dice.below(2); changes > 0; changes--)
            bytes = mutate(bytes, corpus[dice.below(corpus.size())].second, words, dice);
        if (path.ends_with(".png")) bytes = with_checksums(bytes);
        if (!path.ends_with(".pbrt")) {
            std::string name = "part" + path.substr(path.rfind('.'));
            std::string file = " \"string filename\" \"" + name + '"';
            write_file_atomically(temporary / name, bytes);
            path = temporary / "scene.pbrt";
            bytes = "Camera \"perspective\" WorldBegin LightSource \"infinite\" ";
            bytes += name == "part.ply" ? "Shape \"plymesh\"" + file
                     : dice.below(2) == 0
                         ? "Shape \"sphere\" LightSource \"infinite\"" + file
                         : "Texture \"a\" \"spectrum\" \"imagemap\"" + file +
                               " Material \"diffuse\" \"texture reflectance\" \"a\" "
                               "Shape \"sphere\"";
        }
        std::vector<std::string> notes;
        ::alarm(100);  // s, until a signal ends the program
        std::clock_t start = std::clock();
        try {
            check_scene(parse_scene(path, bytes, &notes, {}, {}, dice.below(2) == 0));
            result.read++;
        } catch (const InputError& error) {
            check_message(error.what());
            result.refused++;
        } catch (const std::exception& error) {
            throw std::logic_error("input " + std::to_string(i) + ": " + error.what());
        }
        if (notes.size() > 101) throw std::logic_error("notes without an end");
        if (std::clock() - start > 10 * CLOCKS_PER_SEC)
            throw std::logic_error("input " + std::to_string(i) + " takes more than 10 s");
    }
    ::alarm(0);
    return result;
}
