#include "common/scene_file/ply.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "common/base/error.h"
#include "common/base/text.h"

namespace {

/// What the numbers of a vertex are: its position, its normal, its place in textures.
const std::map<std::string, size_t> roles = {
    {"x", 0},         {"y", 1}, {"z", 2},         {"nx", 3},       {"ny", 4},
    {"nz", 5},        {"u", 6}, {"s", 6},         {"v", 7},        {"texture_u", 6},
    {"texture_s", 6}, {"t", 7}, {"texture_v", 7}, {"texture_t", 7}};
constexpr size_t corners = 8, unused = 9;

struct Property {
    std::string name;
    const PlyScalar* type = nullptr;
    const PlyScalar* count_type = nullptr;  // of a list; null for a single value
    size_t role = unused;
};

struct Element {
    std::string name;
    uint64_t count = 0;
    Position at;
    std::vector<Property> properties;
};

/// Reads the bytes of the file in words, or in binary values.
class PlyReader {
public:
    PlyReader(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

    TriangleMesh read(const Limits& limits) {
        read_header();
        Element& vertex = find_element("vertex", limits.vertices);
        Element& face = find_element("face", limits.primitives);
        find_roles(vertex, face);

        TriangleMesh mesh;
        for (const Element& element : elements_) {
            if (element.properties.empty()) continue;
            for (uint64_t n = 0; n < element.count; n++) {
                std::array<float, corners> v = {};
                for (const Property& property : element.properties) {
                    read_values(property);
                    size_t role = property.role;
                    if (role == corners) add_face(vertex.count, mesh);
                    if (role >= corners) continue;
                    v[role] = static_cast<float>(values_[0]);
                    bool counts = role < 3 || (role < 6 && has_normals_);
                    if (counts && !std::isfinite(v[role])) fail_here("a vertex is not finite");
                }
                if (&element != &vertex) continue;
                mesh.positions.push_back({v[0], v[1], v[2]});
                if (has_normals_) mesh.normals.push_back({v[3], v[4], v[5]});
                if (has_uvs_) mesh.uvs.push_back({v[6], v[7]});
            }
        }
        if (!are_usable(mesh.uvs)) mesh.uvs.clear();
        if (mesh.indices.empty()) fail(face.at, "the mesh has no faces of 3 or 4 corners");
        return mesh;
    }

private:
    size_t left() const { return bytes_.size() - position_; }
    // Where the last word read starts.
    Position at() const { return {file_, line_, column_}; }
    // Throws at the last word read, or at the byte that is reached.
    [[noreturn]] void fail_here(const std::string& text) const {
        if (format_ == 0) fail(at(), text);
        fail({file_}, text + " at byte " + std::to_string(position_));
    }

    // The next word of the line; empty at its end.
    std::string_view word() {
        size_t start = std::min(bytes_.find_first_not_of(" \t", position_), bytes_.size());
        position_ = std::min(bytes_.find_first_of(" \t\r\n", start), bytes_.size());
        column_ = static_cast<int>(start - line_start_) + 1;
        return bytes_.substr(start, position_ - start);
    }
    // Reads over the rest of the line and its end: LF, CR LF or CR.
    void end_line() {
        position_ = std::min(bytes_.find_first_of("\r\n", position_), bytes_.size());
        size_t length = bytes_.substr(position_).starts_with("\r\n") ? 2 : 1;
        position_ = std::min(position_ + length, bytes_.size());
        line_start_ = position_;
        line_++;
    }

    double value(const PlyScalar& type) { return format_ == 0 ? text_value(type) : binary(type); }
    double text_value(const PlyScalar& type) {
        std::string_view text = word();
        while (text.empty() && left() > 0) {
            end_line();
            text = word();
        }
        auto number = to_number(text);
        bool is_whole = number && *number == std::floor(*number) && std::abs(*number) < 0x1p32;
        if (number && (type.is_float || is_whole)) return *number;
        fail_here("expected a " + std::string(type.is_float ? "" : "whole ") + "number, not " +
                  quote(text));
    }
    double binary(const PlyScalar& type) {
        if (left() < type.size) fail_here("the file ends too early");
        uint64_t bits = 0;
        for (size_t i = 0; i < type.size; i++) {
            size_t j = format_ == 1 ? i : type.size - 1 - i;
            bits |= uint64_t{static_cast<unsigned char>(bytes_[position_ + i])} << (8 * j);
        }
        position_ += type.size;
        if (type.size == 8) return std::bit_cast<double>(bits);
        if (type.is_float) return double{std::bit_cast<float>(static_cast<uint32_t>(bits))};
        if (!type.is_signed) return static_cast<double>(bits);
        // Spread the sign bit over the bits above it.
        int shift = static_cast<int>(64 - 8 * type.size);
        return static_cast<double>(static_cast<int64_t>(bits << shift) >> shift);
    }
    // Reads the value of a property, or those of its list.
    void read_values(const Property& property) {
        double count = property.count_type ? value(*property.count_type) : 1;
        if (!(count >= 0 && count <= static_cast<double>(left()))) {
            fail_here("the file is too short for " + std::to_string(static_cast<int64_t>(count)) +
                      " values");
        }
        values_.clear();
        for (double n = 0; n < count; n++) values_.push_back(value(*property.type));
    }

    const PlyScalar* scalar(std::string_view name) const {
        for (const PlyScalar& type : ply_scalars) {
            if (name == type.name || name == type.other_name) return &type;
        }
        fail_here("unknown property type " + quote(name));
    }
    Property read_property() {
        Property property;
        std::string_view type = word();
        if (type == "list") {
            property.count_type = scalar(word());
            type = word();
        }
        property.type = scalar(type);
        property.name = word();
        return property;
    }
    Element read_element() {
        Element element;
        element.name = word();
        element.at = at();
        std::string_view count = word();
        std::optional<int> number = to_integer(count);
        if (!number || *number < 0) {
            fail_here("expected how many elements there are, not " + quote(count));
        }
        element.count = static_cast<uint64_t>(*number);
        return element;
    }
    // The body starts where the header ends.
    void read_header() {
        if (word() != "ply") fail_here("not a PLY file: it does not start with ply");
        end_line();
        std::string format;
        while (true) {
            std::string_view keyword = word();
            if (keyword == "end_header") break;
            if (keyword == "format") {
                format = word();
            } else if (keyword == "element") {
                elements_.push_back(read_element());
            } else if (keyword == "property" && !elements_.empty()) {
                elements_.back().properties.push_back(read_property());
            } else if (keyword.empty() && left() == 0) {
                fail_here("the file ends inside the header");
            } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
                fail_here("unexpected word " + quote(keyword) + " in the header");
            }
            end_line();
        }
        auto found = std::find(ply_formats.begin(), ply_formats.end(), format);
        if (found == ply_formats.end()) fail_here("unknown format " + quote(format));
        end_line();
        format_ = static_cast<size_t>(found - ply_formats.begin());
    }

    Element& find_element(const std::string& name, uint64_t most) {
        auto has_name = [&](const Element& element) { return element.name == name; };
        auto found = std::find_if(elements_.begin(), elements_.end(), has_name);
        if (found == elements_.end()) fail({file_}, "no element " + quote(name));
        if (found->count <= most) return *found;
        fail(found->at, "more than " + std::to_string(most) + ' ' + name + " elements");
    }
    // Finds the coordinates of a vertex, its normal and its place in textures, and the faces.
    void find_roles(Element& vertex, Element& face) {
        std::array<bool, corners> has = {};
        for (Property& p : vertex.properties) {
            auto role = roles.find(p.name);
            if (p.count_type || role == roles.end() || has[role->second]) continue;
            p.role = role->second;
            has[p.role] = true;
        }
        for (size_t i = 0; i < 3; i++) {
            if (!has[i]) fail(vertex.at, "vertex has no number " + quote(std::string(1, "xyz"[i])));
        }
        has_normals_ = has[3] && has[4] && has[5];
        has_uvs_ = has[6] && has[7];
        auto is_list = [](const Property& p) {
            return p.name == "vertex_indices" || p.name == "vertex_index";
        };
        auto list = std::find_if(face.properties.begin(), face.properties.end(), is_list);
        if (list == face.properties.end() || !list->count_type || list->type->is_float) {
            fail(face.at, "face has no list of whole numbers \"vertex_indices\"");
        }
        list->role = corners;
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

    const std::string file_;
    const std::string_view bytes_;
    size_t format_ = 0;  // into ply_formats
    size_t position_ = 0, line_start_ = 0;
    int line_ = 1, column_ = 1;
    std::vector<Element> elements_;
    std::vector<double> values_;  // of the property that is read
    bool has_normals_ = false, has_uvs_ = false;
};

}  // namespace

bool are_usable(const std::vector<Vec2>& uvs) {
    constexpr float largest = 1e9f;
    return std::all_of(uvs.begin(), uvs.end(), [](Vec2 uv) {
        return std::abs(uv.x) <= largest && std::abs(uv.y) <= largest;
    });
}

TriangleMesh parse_ply(const std::string& file, const std::string& bytes, const Limits& limits) {
    return PlyReader(file, bytes).read(limits);
}
