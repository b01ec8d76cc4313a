// Damages scenes and meshes at random, and asks that the reader refuses or reads them, no more.
#pragma once
#include <bit>
#include <ctime>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/path/sampler.h"
#include "common/picture/png.h"
#include "common/scene_file/ply.h"
#include "common/scene_file/ply_bytes.h"
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

/// The input with one of its lines many times, in some of them with another number in each: to find
/// what takes time or memory with the square of the input, or prints without an end.
inline std::string repeat_line(const std::string& bytes, Dice& dice) {
    constexpr size_t most_bytes = 200'000;
    size_t start = bytes.rfind('\n', dice.below(bytes.size() + 1)) + 1;
    size_t end = std::min(bytes.find('\n', start), bytes.size());
    std::string line = bytes.substr(start, end - start) + '\n', lines;
    size_t number_at = dice.below(2) == 0 ? line.find_last_of("0123456789\"") : std::string::npos;
    for (size_t i = 0; lines.size() < most_bytes; i++) {
        size_t length = lines.size();
        lines += line;
        if (number_at < line.size()) lines.insert(length + number_at, std::to_string(i));
    }
    return bytes.substr(0, start) + lines + bytes.substr(start);
}

/// A mesh as a PLY file that was never seen before: elements and properties in any order, of any
/// types, in any format; and what must be read from it.
struct RandomPly {
    std::string bytes;
    TriangleMesh mesh;
};
inline RandomPly random_ply(Dice& dice) {
    RandomPly ply;
    PlyFormat format = static_cast<PlyFormat>(dice.below(3));
    const std::string line_end = dice.below(3) == 0 ? "\r\n" : dice.below(8) == 0 ? "\r" : "\n";
    std::string header = "ply" + line_end, body;
    header += format == PlyFormat::ascii    ? "format ascii 1.0"
              : format == PlyFormat::little ? "format binary_little_endian 1.0"
                                            : "format binary_big_endian 1.0";
    header += line_end;
    auto put = [&](const PlyScalar& type, double value) {
        if (format == PlyFormat::ascii) {
            body += type.is_float ? std::to_string(value) : std::to_string(static_cast<int>(value));
            body += dice.below(9) == 0 ? line_end : " ";
            return;
        }
        uint64_t bits = static_cast<uint64_t>(static_cast<int64_t>(type.is_float ? 0 : value));
        if (type.is_float && type.size == 8) bits = std::bit_cast<uint64_t>(value);
        if (type.is_float && type.size == 4) {
            bits = std::bit_cast<uint32_t>(static_cast<float>(value));
        }
        for (size_t i = 0; i < type.size; i++) {
            size_t byte = format == PlyFormat::little ? i : type.size - 1 - i;
            body += static_cast<char>(bits >> (8 * byte) & 255);
        }
    };
    auto any_type = [&](bool may_be_float) {
        return ply_scalars[dice.below(may_be_float ? ply_scalars.size() : 6)];
    };
    auto name_of = [&](const PlyScalar& type) {
        return std::string(dice.below(2) == 0 ? type.name : type.other_name);
    };
    auto put_list = [&](const PlyScalar& count, const PlyScalar& type,
                        const std::vector<uint32_t>& values) {
        put(count, static_cast<double>(values.size()));
        for (uint32_t value : values) put(type, value);
    };

    // Write vertices, faces and two elements that nobody knows, with properties around what counts.
    size_t vertices = 1 + dice.below(20), faces = dice.below(20);
    bool has_normals = dice.below(2) == 0;
    std::vector<std::string> elements = {"vertex", "face", "edge", "camera"};
    for (size_t i = 4; i > 1; i--) std::swap(elements[i - 1], elements[dice.below(i)]);
    for (const std::string& element : elements) {
        if (dice.below(3) == 0) header += "comment element vertex 7" + line_end;
        bool is_vertex = element == "vertex", is_face = element == "face";
        size_t count = is_vertex ? vertices : is_face ? faces : dice.below(5);
        std::vector<std::string> names = {"u"};
        if (is_vertex) names.insert(names.end(), {"x", "y", "z"});
        if (is_vertex && has_normals) names.insert(names.end(), {"nx", "ny", "nz"});
        if (is_face) names.push_back(dice.below(4) == 0 ? "vertex_index" : "vertex_indices");
        if (dice.below(2) == 0) names.push_back("flags");
        if (!is_face) names.push_back("values");
        for (size_t i = names.size(); i > 1; i--) std::swap(names[i - 1], names[dice.below(i)]);
        std::vector<PlyScalar> types, counts;
        header += "element " + element + ' ' + std::to_string(count) + line_end;
        for (const std::string& name : names) {
            bool is_list = name == "values" || name.starts_with("vertex_ind");
            types.push_back(any_type(!name.starts_with("vertex_ind")));
            counts.push_back(any_type(false));
            header += "property " + (is_list ? "list " + name_of(counts.back()) + ' ' : "") +
                      name_of(types.back()) + ' ' + name + line_end;
        }
        for (size_t n = 0; n < count; n++) {
            std::array<float, 6> v = {};
            for (size_t i = 0; i < names.size(); i++) {
                if (names[i] == "values") {
                    put_list(counts[i], types[i], std::vector<uint32_t>(dice.below(4), 1));
                } else if (names[i].starts_with("vertex_ind")) {
                    std::vector<uint32_t> corners(dice.below(5));
                    for (uint32_t& c : corners) c = static_cast<uint32_t>(dice.below(vertices));
                    put_list(counts[i], types[i], corners);
                    std::vector<uint32_t>& all = ply.mesh.indices;
                    for (size_t k = 2; k < corners.size(); k++) {
                        all.insert(all.end(), {corners[0], corners[k - 1], corners[k]});
                    }
                    ply.mesh.faces_left_out += corners.size() < 3;
                } else {
                    constexpr std::array<const char*, 6> known = {"x", "y", "z", "nx", "ny", "nz"};
                    double value = static_cast<double>(dice.below(100));
                    for (size_t k = 0; is_vertex && k < 6; k++) {
                        if (names[i] == known[k]) v[k] = static_cast<float>(value);
                    }
                    put(types[i], value);
                }
            }
            if (format == PlyFormat::ascii) body += line_end;
            if (is_vertex) ply.mesh.positions.push_back({v[0], v[1], v[2]});
            if (is_vertex && has_normals) ply.mesh.normals.push_back({v[3], v[4], v[5]});
        }
    }
    ply.bytes = header + "end_header" + line_end + body;
    return ply;
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

/// The parts of a text between these characters: of a file, its lines.
inline std::vector<std::string> split(const std::string& text, char at = '\n') {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
    return parts;
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
        for (Vec3 n : g.normals) require(is_finite(n) && std::isfinite(dot(n, n)), "normal");
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
    for (const Mover& mover : scene.movers) check_geometry(mover.geometry);
    if (scene.sky_image)
        for (Rgb L : scene.sky_image->pixels) require(is_light(L), "pixel of the sky");
    require(scene.width > 0 && scene.height > 0 && scene.spp > 0 && scene.max_depth >= 0, "film");
    const Camera& c = scene.camera;
    require(is_finite(c.o) && is_finite(c.forward), "camera is not finite");
    require(length(cross(c.right, c.up)) > 0 && length(c.forward) > 0, "camera is flat");
    require(!scene.lights.empty() || scene.sky_image, "no light");
    for (const Shape& s : scene.shapes)
        require(s.material < scene.materials.size() &&
                    s.light < static_cast<int>(scene.lights.size()) &&
                    s.axes < static_cast<int>(scene.axes.size()),
                "shape");
    for (const Light& light : scene.lights) {
        require(is_light(light.L) && !is_black(light.L) && is_finite(light.p), "light");
        require((light.type == LightType::area) == (light.prims > 0) &&
                    light.first_prim + light.prims <= scene.geometry.size(),
                "prims");
    }
    for (const Material& m : scene.materials) {
        require(is_finite(m.reflectance) && max_component(m.reflectance) <= 1, "reflectance");
        require(is_finite(m.eta) && is_finite(m.k) && m.ior > 0 && m.alpha >= 0, "metal");
        require(m.texture <= scene.textures.all.size(), "texture");
        if (m.texture == 0) continue;
        float most = m.type == MaterialType::diffuse ? max_component(m.reflectance) : 1;
        for (Vec2 uv : {Vec2{0, 0}, Vec2{0.3f, 0.8f}, Vec2{-1e9f, 1e9f}, Vec2{1, 1}}) {
            Rgb value = value_at(scene.textures, m.texture - 1u, uv);
            require(is_light(value) && max_component(value) <= most + 1e-6f, "texture's value");
        }
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
    uint64_t read = 0, refused = 0;
    double slowest = 0;  // s of the processor
};
inline constexpr double most_seconds = 10;  // that an input may take

/// Seconds of the processor that this process has taken.
inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Reads `count` damaged inputs, from number `first` on. Each is a pure function of its number, of
/// which `begin` is told. Meshes and pictures are named by a scene, and read as parts of it. Throws
/// for anything but a scene in which all is well or an InputError of some lines, and for what takes
/// longer than it may.
inline FuzzResult fuzz(uint32_t first, uint32_t count,
                       const std::function<void(uint32_t)>& begin = {}) {
    TemporaryFolder temporary;
    const std::string folder = "tests/damage/corpus/";
    std::vector<std::pair<std::string, std::string>> corpus;
    for (const char* name : {"features.pbrt", "part.pbrt", "square-ascii.ply", "square-little.ply",
                             "square-big.ply", "sky.pfm", "sky.png", "sky.jpg", "sky.tga"}) {
        corpus.emplace_back(folder + name, read_file(folder + name));
    }
    for (const char* name :
         {"references/furnace.pbrt", "references/veach-mis.pbrt",
          "references/tiny-close-light.pbrt", "real-scenes/cornell-box/scene-v4.pbrt"}) {
        std::string path = "tests/pictures/" + std::string(name);
        corpus.emplace_back(path, read_file(path));
    }

    // All that pbrt has, from line to line of another one of them.
    std::string all = "Camera \"perspective\" WorldBegin LightSource \"infinite\"\n";
    for (const std::string& line : split(read_file("tests/support/pbrt_v4.txt"))) {
        if (line.starts_with("w ")) all += "AttributeBegin " + line.substr(2) + " AttributeEnd\n";
    }
    corpus.emplace_back(folder + "all.pbrt", all);
    std::vector<std::string> words = split(read_file("tests/damage/words.txt"));
    FuzzResult result;
    for (uint32_t i = first; i < first + count; i++) {
        Dice dice(i);
        if (begin) begin(i);
        auto [path, bytes] = corpus[dice.below(corpus.size())];
        if (path.ends_with(".ply") && dice.below(2) == 0) bytes = random_ply(dice).bytes;
        if (dice.below(200) == 0) bytes = repeat_line(bytes, dice);
        for (size_t changes = 1 + dice.below(5) * dice.below(2); changes > 0; changes--) {
            bytes = mutate(bytes, corpus[dice.below(corpus.size())].second, words, dice);
        }
        if (path.ends_with(".png")) bytes = with_checksums(bytes);
        if (!path.ends_with(".pbrt")) {
            std::string name = "part" + path.substr(path.rfind('.'));
            write_file_atomically(temporary / name, bytes);
            path = temporary / "scene.pbrt";
            bytes = "Camera \"perspective\" WorldBegin LightSource \"infinite\" ";
            std::string file = " \"string filename\" \"" + name + '"';
            if (name == "part.ply") {
                bytes += "Shape \"plymesh\"" + file;
            } else if (dice.below(2) == 0) {
                bytes += "Shape \"sphere\" LightSource \"infinite\"" + file;
            } else {
                bytes += "Texture \"a\" \"spectrum\" \"imagemap\"" + file +
                         " Material \"diffuse\" \"texture reflectance\" \"a\" Shape \"sphere\"";
            }
        }
        std::vector<std::string> notes;
        double start = processor_seconds();
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
        double seconds = processor_seconds() - start;
        if (seconds > most_seconds) {
            throw std::logic_error("input " + std::to_string(i) + " takes " +
                                   std::to_string(seconds) + " s");
        }
        result.slowest = std::max(result.slowest, seconds);
    }
    return result;
}
