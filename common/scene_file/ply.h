// Triangle meshes in PLY files, ASCII and binary.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "common/base/vec.h"
#include "common/scene_file/lexer.h"
#include "common/scene_file/reader.h"

/// A mesh in its own space.
struct TriangleMesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;      // of the vertices, as in the file; empty or one for each
    std::vector<Vec2> uvs;          // the same
    std::vector<uint32_t> indices;  // three for each triangle, all < positions.size()
    uint64_t faces_left_out = 0;    // those without three or four corners
};

/// The types of numbers that a PLY file may have.
struct PlyScalar {
    const char *name, *other_name;
    size_t size;  // bytes
    bool is_float, is_signed;
};
inline constexpr std::array<PlyScalar, 8> ply_scalars = {{{"char", "int8", 1, false, true},
                                                          {"uchar", "uint8", 1, false, false},
                                                          {"short", "int16", 2, false, true},
                                                          {"ushort", "uint16", 2, false, false},
                                                          {"int", "int32", 4, false, true},
                                                          {"uint", "uint32", 4, false, false},
                                                          {"float", "float32", 4, true, true},
                                                          {"double", "float64", 8, true, true}}};
inline constexpr std::array<const char*, 3> ply_formats = {"ascii", "binary_little_endian",
                                                           "binary_big_endian"};

/// Reads a PLY file: its header and an ASCII body by tokens, another body by bytes.
class PlyReader {
public:
    PlyReader(const std::string& file, const std::string& bytes)
        : file_(file), bytes_(bytes), lexer_(file, text_of(bytes)) {}

    TriangleMesh read(const Limits& limits) {
        read_header();
        const Element& vertex = find_element("vertex", limits.vertices);
        const Element& face = find_element("face", limits.primitives);
        bool has_place = vertex.has(0) && vertex.has(1) && vertex.has(2);
        bool has_normals = vertex.has(3) && vertex.has(4) && vertex.has(5);
        bool has_uvs = vertex.has(6) && vertex.has(7);
        if (!has_place) fail(vertex.at, "vertex has no numbers \"x\", \"y\" and \"z\"");
        if (!face.has(corners))
            fail(face.at, "face has no list of whole numbers \"vertex_indices\"");

        TriangleMesh mesh;
        for (const Element& element : elements_) {
            bool is_vertex = &element == &vertex, is_empty = element.properties.empty();
            for (uint64_t n = 0; n < element.count && !is_empty; n++) {
                std::array<float, unused + 1> v = {};
                for (const Property& property : element.properties) {
                    read_values(property);
                    size_t role = property.role;
                    if (&element == &face && role == corners) add_face(vertex.count, mesh);
                    if (!is_vertex || property.count_type) continue;
                    v[role] = static_cast<float>(values_[0]);
                    bool counts = role < 3 || (role < 6 && has_normals);
                    if (counts && !std::isfinite(v[role])) fail_here("a vertex is not finite");
                }
                if (is_vertex) mesh.positions.push_back({v[0], v[1], v[2]});
                if (is_vertex && has_normals) mesh.normals.push_back({v[3], v[4], v[5]});
                if (is_vertex && has_uvs) mesh.uvs.push_back({v[6], v[7]});
            }
        }
        if (mesh.indices.empty()) fail(face.at, "the mesh has no faces of 3 or 4 corners");
        return mesh;
    }

private:
    /// What a property is: a number of the position, the normal or the place in textures of a
    /// vertex; the corners of a face; or nothing that is used.
    static constexpr std::string_view roles =
        " x:0 y:1 z:2 nx:3 ny:4 nz:5 u:6 v:7 s:6 t:7 texture_u:6 texture_v:7 texture_s:6 "
        "texture_t:7 vertex_indices:8 vertex_index:8 ";
    static constexpr size_t corners = 8, unused = 9;
    struct Property {
        const PlyScalar* type = nullptr;
        const PlyScalar* count_type = nullptr;  // of a list; null for a single value
        size_t role = unused;
    };
    struct Element {
        std::string name;
        Position at;
        uint64_t count = 0;
        std::vector<Property> properties;

        bool has(size_t role) const {
            return std::any_of(properties.begin(), properties.end(),
                               [&](const Property& p) { return p.role == role; });
        }
    };

    // The header without its comments, which end with their lines, and the body if it is text.
    std::string text_of(const std::string& bytes) {
        std::string text, line;
        while (!line.starts_with("end_header") && position_ < bytes.size()) {
            size_t end = std::min(bytes.find_first_of("\r\n", position_), bytes.size());
            line = bytes.substr(position_, end - position_);
            bool is_comment = line.starts_with("comment") || line.starts_with("obj_info");
            text += (is_comment ? "" : line) + '\n';
            position_ = end + (bytes.compare(end, 2, "\r\n") == 0 ? 2 : 1);
        }
        bool is_text = text.find("format ascii") != text.npos && position_ < bytes.size();
        if (is_text) text += bytes.substr(position_);
        std::replace(text.begin(), text.end(), '"', '?');  // a mesh has no strings
        return text;
    }
    Token next() { return last_ = lexer_.next(); }
    // Throws at the last token, or at the byte that is reached.
    [[noreturn]] void fail_here(const std::string& text) const {
        if (format_ == 0) fail(lexer_.at(last_), text);
        fail({file_}, text + " at byte " + std::to_string(position_));
    }

    double value(const PlyScalar& type) {
        if (format_ > 0) return binary(type);
        last_ = lexer_.peek();
        double number = lexer_.number("the mesh");
        bool is_whole = number == std::floor(number) && std::abs(number) < 0x1p32;
        if (!type.is_float && !is_whole) lexer_.fail_at(last_, "expected a whole number");
        return number;
    }
    double binary(const PlyScalar& type) {
        if (position_ + type.size > bytes_.size()) fail_here("the file ends too early");
        uint64_t bits = 0;
        for (size_t i = 0; i < type.size; i++) {
            size_t j = format_ == 1 ? i : type.size - 1 - i;
            bits |= uint64_t{static_cast<unsigned char>(bytes_[position_ + i])} << (8 * j);
        }
        position_ += type.size;
        if (type.size == 8) return std::bit_cast<double>(bits);
        if (type.is_float) return double{std::bit_cast<float>(static_cast<uint32_t>(bits))};
        // Spread the sign bit over the bits above it.
        int shift = type.is_signed ? static_cast<int>(64 - 8 * type.size) : 0;
        return static_cast<double>(static_cast<int64_t>(bits << shift) >> shift);
    }
    // Reads the value of a property, or those of its list.
    void read_values(const Property& property) {
        double count = property.count_type ? value(*property.count_type) : 1;
        if (!(count >= 0 && count <= static_cast<double>(bytes_.size()))) {
            fail_here("the file is too short for " + std::to_string(static_cast<int64_t>(count)) +
                      " values");
        }
        values_.clear();
        for (double n = 0; n < count; n++) values_.push_back(value(*property.type));
    }

    const PlyScalar* scalar(const Token& token) const {
        for (const PlyScalar& type : ply_scalars) {
            if (token.text == type.name || token.text == type.other_name) return &type;
        }
        lexer_.fail_at(token, "expected a type of numbers");
    }
    Property read_property() {
        Property property;
        bool is_list = lexer_.peek().text == "list";
        if (is_list) next();
        if (is_list) property.count_type = scalar(next());
        property.type = scalar(next());
        const std::string name = ' ' + std::string(next().text) + ':';
        size_t at = roles.find(name);
        if (at == roles.npos) return property;
        size_t role = static_cast<size_t>(roles[at + name.size()] - '0');
        bool fits = role == corners ? is_list && !property.type->is_float : !is_list;
        if (fits) property.role = role;
        return property;
    }
    void read_header() {
        if (next().text != "ply") lexer_.fail_at(last_, "a PLY file starts with ply");
        size_t format = ply_formats.size();
        while (next().text != "end_header") {
            if (last_.text == "format") {
                auto found = std::find(ply_formats.begin(), ply_formats.end(), next().text);
                if (found == ply_formats.end()) lexer_.fail_at(last_, "expected a format");
                format = static_cast<size_t>(found - ply_formats.begin());
                next();  // its version
            } else if (last_.text == "element") {
                std::string name(next().text);
                std::optional<int> count = to_integer(next().text);
                if (!count || *count < 0) lexer_.fail_at(last_, "expected a number of elements");
                elements_.push_back({name, lexer_.at(last_), static_cast<uint64_t>(*count), {}});
            } else if (last_.text == "property" && !elements_.empty()) {
                elements_.back().properties.push_back(read_property());
            } else {
                lexer_.fail_at(last_, "expected a word of the header");
            }
        }
        if (format == ply_formats.size()) fail_here("the header names no format");
        format_ = format;
    }

    const Element& find_element(const std::string& name, uint64_t most) const {
        for (const Element& element : elements_) {
            if (element.name != name) continue;
            if (element.count <= most) return element;
            fail(element.at, "more than " + std::to_string(most) + ' ' + name + " elements");
        }
        fail({file_}, "no element " + quote(name));
    }
    // Adds the face of the corners that were read; leaves it out where pbrt does.
    void add_face(uint64_t vertices, TriangleMesh& mesh) {
        if (values_.size() < 3 || values_.size() > 4) {
            mesh.faces_left_out++;
            return;
        }
        std::array<uint32_t, 4> v = {};
        for (size_t i = 0; i < values_.size(); i++) {
            double index = values_[i];
            if (!(index >= 0 && index < static_cast<double>(vertices))) {
                fail_here("vertex " + std::to_string(static_cast<int64_t>(index)) +
                          " of a face does not exist: there are " + std::to_string(vertices));
            }
            v[i] = static_cast<uint32_t>(index);
            if (i >= 2) mesh.indices.insert(mesh.indices.end(), {v[0], v[i - 1], v[i]});
        }
    }

    const std::string& file_;
    const std::string& bytes_;
    size_t position_ = 0;  // of the body
    Lexer lexer_;
    Token last_;
    size_t format_ = 0;  // into ply_formats
    std::vector<Element> elements_;
    std::vector<double> values_;  // of the property that is read
};

/// Reads the mesh from the bytes of a PLY file. A quad 0 1 2 3 becomes triangles 0 1 2 and 0 2 3;
/// faces of fewer than three or more than four corners are left out, as in pbrt. Elements and
/// properties other than x y z, nx ny nz, u v (or s t, texture_u texture_v, texture_s texture_t)
/// and the faces are read over. A mesh without vertices or faces is refused, as pbrt does.
///
/// file    its name, for messages
/// limits  a mesh beyond them is refused before there is memory for it
/// errors  InputError "file:line:column: error: ..." for the header and an ASCII body,
///         "file: error: ... at byte N" for a binary one
/// source  Turk 1994, "The PLY Polygon File Format"      tested by  "input: PLY ..."
inline TriangleMesh parse_ply(const std::string& file, const std::string& bytes,
                              const Limits& limits = {}) {
    return PlyReader(file, bytes).read(limits);
}
