// Shapes of a pbrt-v4 scene file.
#pragma once
#include <limits>

#include "common/scene/prepare.h"
#include "common/scene_file/ply.h"
#include "common/scene_file/settings.h"

/// What AttributeBegin saves and AttributeEnd restores.
struct State {
    Transform start, end;  // the current transform when the shutter opens and when it closes
    bool set_start = true, set_end = true;  // which of them a transform directive changes
    uint32_t material = 0;                  // into Scene::materials
    std::optional<AreaEmission> emission;
    bool reverse_orientation = false;
    std::map<std::string, ParamMap> defaults = {};  // of directives, from Attribute
};

inline std::vector<uint32_t> read_indices(const Params& params, size_t vertices, size_t corners) {
    std::vector<double> numbers = {0, 1, 2, 3};
    numbers.resize(corners);
    if (vertices != corners || params.find("indices")) numbers = params.required("indices").numbers;
    Position at = params.at("indices");
    if (numbers.size() % corners != 0) {
        fail(at, "the number of indices is not a multiple of " + std::to_string(corners));
    }
    std::vector<uint32_t> indices;
    for (double index : numbers) {
        if (index < 0 || index >= static_cast<double>(vertices)) {
            fail(at, "index " + format("%.10g", index) + " is out of range: there are " +
                         std::to_string(vertices) + " vertices");
        }
        indices.push_back(static_cast<uint32_t>(index));
    }
    return indices;
}

// The mesh in its own space. Of "bilinearmesh" each patch becomes two triangles.
inline TriangleMesh read_mesh(const Params& params) {
    size_t corners = params.type() == "bilinearmesh" ? 4 : 3;
    TriangleMesh mesh;
    params.required("P");
    mesh.positions = params.points("P");
    mesh.normals = params.points("N");
    const Param* uv = params.find("uv");
    for (size_t i = 0; uv && i < uv->numbers.size(); i += 2) {
        mesh.uvs.push_back(
            {static_cast<float>(uv->numbers[i]), static_cast<float>(uv->numbers[i + 1])});
    }
    for (auto [name, count] : {std::pair("N", mesh.normals.size()), {"uv", mesh.uvs.size()}}) {
        if (!params.find(name) || count == mesh.positions.size()) continue;
        fail(params.at(name), quote(name) + " is not given for each of the vertices");
    }
    std::vector<uint32_t> indices = read_indices(params, mesh.positions.size(), corners);
    for (size_t i = 0; i < indices.size(); i += corners) {
        const uint32_t* v = &indices[i];
        mesh.indices.insert(mesh.indices.end(), {v[0], v[1], v[corners - 1]});
        if (corners == 4) mesh.indices.insert(mesh.indices.end(), {v[0], v[3], v[2]});
    }
    if (corners == 3) return mesh;
    params.note("is read as two triangles for each patch");
    if (!uv && mesh.positions.size() == 4 && indices == std::vector<uint32_t>{0, 1, 2, 3}) {
        mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    }
    return mesh;
}

// Adds positions, uv, and normals in world space.
inline void add_vertices(const Params& params, const TriangleMesh& mesh, const State& state,
                         Geometry& g) {
    size_t first = g.positions.size();
    for (Vec3 p : mesh.positions) {
        Vec3 world = to_vec3(transform_point(state.start, {p.x, p.y, p.z}));
        check_extent(params, world);
        g.positions.push_back(world);
    }
    auto is_usable = [](Vec2 uv) { return std::abs(uv.x) <= 1e9f && std::abs(uv.y) <= 1e9f; };
    bool has_uvs = std::all_of(mesh.uvs.begin(), mesh.uvs.end(), is_usable) && !mesh.uvs.empty();
    if (has_uvs || !g.uvs.empty()) {
        g.uvs.resize(first, {NAN, NAN});
        if (has_uvs) g.uvs.insert(g.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
        g.uvs.resize(g.positions.size(), {NAN, NAN});
    }
    if (mesh.normals.empty() && g.normals.empty()) return;
    g.normals.resize(first);
    for (Vec3 n : mesh.normals) {
        Vec3d world = transform_normal(state.start, {n.x, n.y, n.z});
        // Keep lengths, by which pbrt weighs them, but not those whose square leaves float.
        double size = length(world);
        if (size > 0 && !(size > 1e-6 && size < 1e6)) world = normalize(world);
        g.normals.push_back(state.reverse_orientation ? -to_vec3(world) : to_vec3(world));
    }
    g.normals.resize(g.positions.size());
}

// Adds the mesh, and turns each triangle so that its corners run counter-clockwise on its outside.
// each: whether each triangle has a Shape of its own.
inline void add_mesh(const Params& params, const TriangleMesh& mesh, const State& state, bool each,
                     Scene& scene) {
    Geometry& g = scene.geometry;
    uint32_t first = static_cast<uint32_t>(g.positions.size());
    uint32_t shape = static_cast<uint32_t>(scene.shapes.size());
    add_vertices(params, mesh, state, g);
    bool mirrored = determinant(state.start) < 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        uint32_t a = first + mesh.indices[i], b = first + mesh.indices[i + 1],
                 c = first + mesh.indices[i + 2];
        Vec3 normal = cross(g.positions[b] - g.positions[a], g.positions[c] - g.positions[a]);
        if (!(length_squared(normal) >= std::numeric_limits<float>::min())) continue;
        bool turn = mirrored != state.reverse_orientation;
        if (!mesh.normals.empty()) {
            float side = dot(normal, g.normals[a] + g.normals[b] + g.normals[c]);
            if (side != 0) turn = side < 0;
        }
        if (turn) std::swap(b, c);
        g.triangles.push_back({{a, b, c}, shape});
        if (each) shape++;
    }
    if (mesh.faces_left_out == 0) return;
    params.note("is read without faces of fewer than 3 or more than 4 corners: " +
                std::to_string(mesh.faces_left_out));
}

// The mean factor by which the transform scales these axes; not supported where they differ.
inline double mean_scale(const Params& params, const std::vector<Vec3d>& axes) {
    constexpr double tolerance = 1e-3;  // for numbers written with few digits
    double scale = length(axes[0]), product = 1;
    bool is_uniform = true;
    for (size_t i = 0; i < axes.size(); i++) {
        Vec3d next = axes[(i + 1) % axes.size()];
        is_uniform &= std::abs(length(next) - scale) <= tolerance * scale;
        is_uniform &= std::abs(dot(axes[i], next)) <= tolerance * scale * scale;
        product *= length(next);
    }
    if (is_uniform) return scale;
    params.stand_in("a sphere or disk scaled differently along its axes");
    return std::pow(product, 1 / static_cast<double>(axes.size()));
}

// Adds a sphere or a disk, which is to be whole. pbrt clamps its limits to the whole.
inline void add_round(const Params& params, const State& state, Shape& shape, Scene& scene) {
    const Transform& t = state.start;
    bool is_disk = params.type() == "disk";
    float radius = params.number("radius");
    float z0 = params.number("zmin", -radius), z1 = params.number("zmax", radius);
    bool is_whole = std::min(z0, z1) <= -radius && std::max(z0, z1) >= radius;
    if (params.number("phimax") < 360 || params.number("innerradius") != 0 || !is_whole) {
        params.stand_in("a part of a sphere or disk");
    }
    double scale = mean_scale(params, is_disk ? std::vector{t.x, t.y} : std::vector{t.x, t.y, t.z});
    float r = static_cast<float>(radius * scale);
    if (!(r * r >= std::numeric_limits<float>::min())) {
        fail(params.at("radius"), params.owner() + " is smaller than 1e-18: choose a smaller unit");
    }
    Vec3 c = to_vec3(transform_point(t, {0, 0, params.number("height")}));
    check_extent(params, abs(c) + Vec3{r, r, r});
    shape.x = to_vec3(normalize(t.x));
    shape.y = to_vec3(normalize(t.y));
    shape.z = to_vec3(normalize(t.z));
    uint32_t number = static_cast<uint32_t>(scene.shapes.size());
    if (!is_disk) {
        shape.reverse = state.reverse_orientation;
        scene.geometry.spheres.push_back({c, r, number});
        return;
    }
    Vec3d up = {0, 0, state.reverse_orientation ? -1.0 : 1.0};
    scene.geometry.disks.push_back({c, to_vec3(normalize(transform_normal(t, up))), r, number});
}

/// Adds the primitives of one Shape directive, where they are at the start, and their lights, to
/// the scene; of a mesh those triangles that have an area.
///
/// The side of a surface, which decides where it shines:
///   triangle  (p1-p0) x (p2-p0), whatever the transform mirrors; where there are vertex normals,
///             theirs; the order of the corners in the scene says the same
///   sphere    outwards;   disk  object space's +z, carried along as a normal
/// and ReverseOrientation turns each to the other side.
inline void read_shape(const Params& params, const State& state, Scene& scene) {
    Geometry& g = scene.geometry;
    bool shines = state.emission && !is_black(state.emission->L);
    // With a power each primitive is a light of its own that sends all of it, as in pbrt.
    bool each = shines && state.emission->power > 0;
    size_t first = g.triangles.size(), before = g.size();
    Shape shape;
    shape.material = state.material;
    shape.at = kept(params.at());
    if (params.type() == "sphere" || params.type() == "disk") {
        add_round(params, state, shape, scene);
        first = params.type() == "disk" ? before : first + g.spheres.size() - 1;
    } else if (params.type() == "plymesh") {
        const Param& name = params.required("filename");
        Input& input = params.input();
        std::string path = input.find(name.at, name.strings[0]);
        TriangleMesh mesh;
        bool is_read = input.try_to_read(params.at(), "a mesh that cannot be read", [&] {
            if (input.report) input.report("reading " + path, 0);
            mesh = parse_ply(path, input.read(path, name.at), input.limits);
        });
        if (is_read) add_mesh(params, mesh, state, each, scene);
    } else {
        add_mesh(params, read_mesh(params), state, each, scene);
    }
    size_t added = g.size() - before;
    for (size_t i = first; i < first + (each ? added : std::min(added, size_t{1})); i++) {
        scene.shapes.push_back(shape);
        if (!shines) continue;
        Light light;
        light.L = state.emission->L;
        light.two_sided = state.emission->two_sided;
        light.at = shape.at;
        if (each) {
            // Half of a patch's power for each of its triangles.
            float area = area_of(emitter_of(scene, static_cast<uint32_t>(i)));
            float sides = light.two_sided ? 2 : 1;
            float power = state.emission->power / (params.type() == "bilinearmesh" ? 2 : 1);
            light.L *= power / (pi * area * sides);
        }
        scene.shapes.back().light = static_cast<int>(scene.lights.size());
        scene.lights.push_back(light);
    }
}
