#include "common/scene_file/ply.h"

#include "common/scene_file/ply_bytes.h"

namespace {

struct Property {
    std::string name;
    const PlyScalar* type = nullptr;
    const PlyScalar* count_type = nullptr;  // of a list; null for a single value
};

struct Element {
    std::string name;
    uint64_t count = 0;
    Position at;
    std::vector<Property> properties;

    const Property* find(const std::string& property) const {
        for (const Property& p : properties) {
            if (p.name == property) return &p;
        }
        return nullptr;
    }
};

const PlyScalar* read_scalar(PlyBytes& reader) {
    std::string_view name = reader.word();
    for (const PlyScalar& type : ply_scalars) {
        if (name == type.name || name == type.other_name) return &type;
    }
    reader.fail_here("unknown property type " + quote(name));
}

Property read_property(PlyBytes& reader) {
    Property property;
    PlyBytes look_ahead = reader;
    if (look_ahead.word() == "list") {
        reader.word();
        property.count_type = read_scalar(reader);
        if (property.count_type->is_float) reader.fail_here("a list cannot have a float for count");
    }
    property.type = read_scalar(reader);
    property.name = reader.word();
    if (property.name.empty()) reader.fail_here("a property without a name");
    return property;
}

Element read_element(PlyBytes& reader) {
    Element element;
    element.name = reader.word();
    element.at = reader.at();
    std::string_view count = reader.word();
    auto number = to_number(count);
    if (!number || !(*number >= 0) || *number != std::floor(*number) || *number > 1e15) {
        reader.fail_here("expected how many elements there are, not " + quote(count));
    }
    element.count = static_cast<uint64_t>(*number);
    return element;
}

PlyFormat read_format(PlyBytes& reader) {
    std::string_view name = reader.word();
    std::optional<PlyFormat> format;
    if (name == "ascii") format = PlyFormat::ascii;
    if (name == "binary_little_endian") format = PlyFormat::little;
    if (name == "binary_big_endian") format = PlyFormat::big;
    if (!format) reader.fail_here("unknown format " + quote(name));
    if (std::string_view version = reader.word(); version != "1.0") {
        reader.fail_here("unknown version " + quote(version));
    }
    return *format;
}

// Reads the header and returns what follows it; the body starts where the reader stands.
std::vector<Element> read_header(PlyBytes& reader) {
    if (reader.word() != "ply") reader.fail_here("not a PLY file: it does not start with ply");
    reader.end_line();
    std::vector<Element> elements;
    std::optional<PlyFormat> format;
    while (true) {
        std::string_view keyword = reader.word();
        if (keyword == "end_header") break;
        if (keyword == "format") {
            format = read_format(reader);
        } else if (keyword == "element") {
            elements.push_back(read_element(reader));
        } else if (keyword == "property") {
            if (elements.empty()) reader.fail_here("a property before the first element");
            elements.back().properties.push_back(read_property(reader));
        } else if (keyword.empty() && reader.left() == 0) {
            reader.fail_here("the file ends inside the header");
        } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
            reader.fail_here("unknown word " + quote(keyword) + " in the header");
        }
        reader.end_line();
    }
    if (!format) reader.fail_here("the header names no format");
    reader.end_line();
    reader.format = *format;
    return elements;
}

// Refuses a count that the rest of the file cannot hold, or that is beyond the limits, before
// anything is allocated for it.
void check_count(const PlyBytes& reader, const Element& element, const Limits& limits) {
    uint64_t bytes = 0;  // of the smallest element
    for (const Property& property : element.properties) {
        const PlyScalar& first = property.count_type ? *property.count_type : *property.type;
        bytes += reader.format == PlyFormat::ascii ? 2 : first.size;
    }
    if (bytes > 0 && element.count > (reader.left() + 1) / bytes) {
        fail(element.at, "the file is too short for " + std::to_string(element.count) + ' ' +
                             quote(element.name) + " elements");
    }
    uint64_t most = element.name == "vertex" ? limits.vertices : limits.primitives;
    bool is_kept = element.name == "vertex" || element.name == "face";
    if (is_kept && element.count > most) {
        fail(element.at, "more than " + std::to_string(most) + ' ' + element.name + " elements");
    }
}

// How many values the list has; 1 for a single value.
uint64_t read_length(PlyBytes& reader, const Property& property) {
    if (!property.count_type) return 1;
    double length = reader.value(*property.count_type);
    if (length < 0) reader.fail_here("a list of negative length");
    if (length > static_cast<double>(reader.left())) {
        reader.fail_here("the file is too short for a list of this length");
    }
    return static_cast<uint64_t>(length);
}

void skip(PlyBytes& reader, const Property& property) {
    for (uint64_t n = read_length(reader, property); n > 0; n--) reader.value(*property.type);
}

void read_vertices(PlyBytes& reader, const Element& element, TriangleMesh& mesh) {
    // Find where in a vertex its coordinates, its normal and its place in textures stand.
    constexpr size_t count = 8;
    std::array<const char*, count> names = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
    for (auto [u, v] : {std::pair("s", "t"), std::pair("texture_u", "texture_v"),
                        std::pair("texture_s", "texture_t")}) {
        if (!element.find(names[6]) || !element.find(names[7])) names[6] = u, names[7] = v;
    }
    std::array<const Property*, count> wanted;
    for (size_t i = 0; i < count; i++) {
        wanted[i] = element.find(names[i]);
        if (i < 3 && !wanted[i]) fail(element.at, "vertex has no property " + quote(names[i]));
        if (wanted[i] && wanted[i]->count_type) {
            fail(element.at, "property " + quote(names[i]) + " must not be a list");
        }
    }
    bool has_normals = wanted[3] && wanted[4] && wanted[5], has_uvs = wanted[6] && wanted[7];

    mesh.positions.reserve(element.count);
    for (uint64_t n = 0; n < element.count; n++) {
        std::array<float, count> v = {};
        for (const Property& property : element.properties) {
            size_t slot = 0;
            while (slot < count && wanted[slot] != &property) slot++;
            if (slot == count) {
                skip(reader, property);
                continue;
            }
            v[slot] = static_cast<float>(reader.value(*property.type));
            if (slot < 6 && !std::isfinite(v[slot])) reader.fail_here("a vertex is not finite");
        }
        mesh.positions.push_back({v[0], v[1], v[2]});
        if (has_normals) mesh.normals.push_back({v[3], v[4], v[5]});
        if (has_uvs) mesh.uvs.push_back({v[6], v[7]});
    }
    if (!are_usable(mesh.uvs)) mesh.uvs.clear();
}

void read_faces(PlyBytes& reader, const Element& element, size_t vertices, TriangleMesh& mesh) {
    const Property* corners = element.find("vertex_indices");
    if (!corners) corners = element.find("vertex_index");
    if (!corners || !corners->count_type || corners->type->is_float) {
        fail(element.at, "face has no list of whole numbers \"vertex_indices\"");
    }
    for (uint64_t n = 0; n < element.count; n++) {
        for (const Property& property : element.properties) {
            if (&property != corners) {
                skip(reader, property);
                continue;
            }
            uint64_t length = read_length(reader, property);
            if (length < 3 || length > 4) {  // as pbrt does
                for (uint64_t i = 0; i < length; i++) reader.value(*property.type);
                mesh.faces_left_out++;
                continue;
            }
            std::array<uint32_t, 4> v = {};
            for (uint64_t i = 0; i < length; i++) {
                double index = reader.value(*property.type);
                if (!(index >= 0 && index < static_cast<double>(vertices))) {
                    reader.fail_here("vertex " + std::to_string(static_cast<int64_t>(index)) +
                                     " of a face does not exist: there are " +
                                     std::to_string(vertices));
                }
                v[i] = static_cast<uint32_t>(index);
            }
            mesh.indices.insert(mesh.indices.end(), {v[0], v[1], v[2]});
            if (length == 4) mesh.indices.insert(mesh.indices.end(), {v[0], v[2], v[3]});
        }
    }
}

}  // namespace

bool are_usable(const std::vector<Vec2>& uvs) {
    constexpr float largest = 1e9f;
    return std::all_of(uvs.begin(), uvs.end(), [](Vec2 uv) {
        return std::abs(uv.x) <= largest && std::abs(uv.y) <= largest;
    });
}

TriangleMesh parse_ply(const std::string& file, const std::string& bytes, const Limits& limits) {
    if (bytes.empty()) fail({file}, "the file is empty");
    PlyBytes reader(file, bytes);
    std::vector<Element> elements = read_header(reader);

    // Know how many vertices there will be, since faces may come before them.
    const Element *vertex = nullptr, *face = nullptr;
    for (const Element& element : elements) {
        if (element.name == "tristrips" && element.count > 0) {
            fail(element.at, "triangle strips (tristrips) are not supported: " +
                                 std::string("write the mesh with an element \"face\""));
        }
        const Element** known = element.name == "vertex" ? &vertex : &face;
        if (element.name != "vertex" && element.name != "face") continue;
        if (*known) fail(element.at, "a second element " + quote(element.name));
        *known = &element;
    }
    if (!vertex || !face) {
        fail({file}, "no element " + quote(vertex ? "face" : "vertex"));
    }

    TriangleMesh mesh;
    for (const Element& element : elements) {
        check_count(reader, element, limits);
        if (&element == vertex) {
            read_vertices(reader, element, mesh);
        } else if (&element == face) {
            read_faces(reader, element, vertex->count, mesh);
        } else if (!element.properties.empty()) {
            for (uint64_t n = 0; n < element.count; n++) {
                for (const Property& property : element.properties) skip(reader, property);
            }
        }
    }
    if (mesh.indices.empty()) {
        std::string of_which = mesh.faces_left_out > 0 ? " of 3 or 4 corners" : "";
        fail(face->at, "the mesh has no faces" + of_which);
    }
    return mesh;
}
