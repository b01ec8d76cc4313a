// Shapes of a pbrt-v4 scene file.
#pragma once
#include <limits>

#include "common/scene/prepare.h"
#include "common/scene_file/lights.h"
#include "common/scene_file/materials.h"

/// What AttributeBegin saves and AttributeEnd restores.
struct State {
    std::string begin;  // what began the block, and where
    Position at;
    Transform start, end;  // the current transform when the shutter opens and when it closes
    std::string unusable;  // why nothing can stand there, as a message
    bool set_start = true, set_end = true;  // which of them a transform directive changes
    uint32_t material = 0;                  // into Scene::materials
    std::optional<AreaEmission> emission;
    bool reverse_orientation = false;
    std::map<std::string, std::vector<Param>> defaults = {
        {"light", {}}, {"material", {}}, {"medium", {}}, {"shape", {}}, {"texture", {}}};
};

// Throws for a point so far out that squares of areas would overflow a float.
inline void check_extent(const Params& params, Vec3 p) {
    if (is_finite(p) && max_component(abs(p)) <= 1e9f) return;
    fail(params.at(), params.owner() + " reaches farther than 1e9: choose a larger unit");
}

inline std::vector<uint32_t> read_indices(const Params& params, size_t vertices, size_t corners) {
    std::vector<double> numbers = {0, 1, 2, 3};
    numbers.resize(corners);
    if (vertices != corners || params.find("indices")) numbers = params.required("indices").numbers;
    Position at = params.at("indices");
    if (numbers.size() % corners != 0) {
        fail(at, std::to_string(numbers.size()) + " indices, not a multiple of " +
                     std::to_string(corners));
    }
    std::vector<uint32_t> indices;
    for (double index : numbers) {
        if (index < 0 || index >= static_cast<double>(vertices)) {
            fail(at, "index " + std::to_string(static_cast<int>(index)) +
                         " is out of range: there are " + std::to_string(vertices) + " vertices");
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
    for (auto [name, count] : {std::pair("N", mesh.normals.size()),
                               {"S", params.points("S").size()},
                               {"uv", mesh.uvs.size()}}) {
        if (!params.find(name) || count == mesh.positions.size()) continue;
        fail(params.at(name), quote(name) + " is not given for each of the vertices");
    }
    if (!are_usable(mesh.uvs)) mesh.uvs.clear();
    mesh.indices = read_indices(params, mesh.positions.size(), corners);
    if (corners == 3) return mesh;

    // The corners of a patch are at (u, v) = (0, 0), (1, 0), (0, 1), (1, 1).
    params.note("a bilinear patch is read as two triangles");
    std::vector<uint32_t> patches = std::move(mesh.indices);
    mesh.indices.clear();
    for (size_t i = 0; i < patches.size(); i += 4) {
        uint32_t a = patches[i], b = patches[i + 1], c = patches[i + 2], d = patches[i + 3];
        mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    }
    if (!uv && mesh.positions.size() == 4 && patches == std::vector<uint32_t>{0, 1, 2, 3}) {
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
    if (!mesh.uvs.empty() || !g.uvs.empty()) {
        g.uvs.resize(first, {NAN, NAN});
        g.uvs.insert(g.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
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

// The number of the Shape that is read.
inline uint32_t next_shape(const Scene& scene) {
    return static_cast<uint32_t>(scene.shapes.size());
}

// Adds the mesh, and turns each triangle so that its corners run counter-clockwise on its outside.
// each: whether each triangle has a Shape of its own.
inline void add_mesh(const Params& params, const TriangleMesh& mesh, const State& state, bool each,
                     Scene& scene) {
    Geometry& g = scene.geometry;
    uint32_t first = static_cast<uint32_t>(g.positions.size()), shape = next_shape(scene);
    add_vertices(params, mesh, state, g);
    bool mirrored = determinant(state.start) < 0;
    uint64_t left_out = mesh.faces_left_out;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        uint32_t a = first + mesh.indices[i], b = first + mesh.indices[i + 1],
                 c = first + mesh.indices[i + 2];
        Vec3 normal = cross(g.positions[b] - g.positions[a], g.positions[c] - g.positions[a]);
        if (!(length_squared(normal) >= std::numeric_limits<float>::min())) {
            left_out++;
            continue;
        }
        bool turn = mirrored != state.reverse_orientation;
        if (!mesh.normals.empty()) {
            float side = dot(normal, g.normals[a] + g.normals[b] + g.normals[c]);
            if (side != 0) turn = side < 0;
        }
        if (turn) std::swap(b, c);
        g.triangles.push_back({{a, b, c}, shape});
        if (each) shape++;
    }
    if (left_out > 0) {
        params.note("left out triangles without area, and faces that do not have 3 or 4 corners: " +
                    std::to_string(left_out));
    }
}

// The one factor by which the transform scales these axes; not supported where there is none.
inline double uniform_scale(const Params& params, const std::vector<Vec3d>& axes) {
    constexpr double tolerance = 1e-3;  // for numbers written with few digits
    double scale = length(axes[0]);
    for (size_t i = 0; i < axes.size(); i++) {
        Vec3d next = axes[(i + 1) % axes.size()];
        bool same = std::abs(length(next) - scale) <= tolerance * scale;
        bool right_angle = std::abs(dot(axes[i], next)) <= tolerance * scale * scale;
        if (same && right_angle) continue;
        params.stand_in("a sphere or disk scaled differently along its axes");
        double product = 1;
        for (Vec3d axis : axes) product *= length(axis);
        return std::pow(product, 1 / static_cast<double>(axes.size()));
    }
    return scale;
}

// The radius in the world.
inline float read_radius(const Params& params, Vec3 centre, const std::vector<Vec3d>& axes) {
    float r = static_cast<float>(params.number("radius") * uniform_scale(params, axes));
    if (!(r * r >= std::numeric_limits<float>::min())) {
        fail(params.at("radius"), params.owner() + " is smaller than 1e-18: choose a smaller unit");
    }
    check_extent(params, abs(centre) + Vec3{r, r, r});
    return r;
}

// Parts are not supported. pbrt clamps an angle above 360 degrees.
inline void require_whole(const Params& params, bool is_whole) {
    if (params.number("phimax") >= 360 && is_whole) return;
    params.stand_in("a part of a sphere or disk");
}

// The number of the axes of a sphere or disk; -1 where they are the world's.
inline int add_axes(const Transform& t, Scene& scene) {
    auto unit = [](Vec3d v) { return to_vec3(normalize(v)); };
    Axes axes = {unit(t.x), unit(t.y), unit(t.z)};
    if (axes == Axes{}) return -1;
    scene.axes.push_back(axes);
    return static_cast<int>(scene.axes.size()) - 1;
}

inline void add_sphere(const Params& params, const Transform& t, Scene& scene) {
    float radius = params.number("radius");
    // In either order, and clamped to the sphere, as in pbrt.
    float z0 = params.number("zmin", -radius), z1 = params.number("zmax", radius);
    require_whole(params, std::min(z0, z1) <= -radius && std::max(z0, z1) >= radius);
    Vec3 centre = to_vec3(t.o);
    scene.geometry.spheres.push_back(
        {centre, read_radius(params, centre, {t.x, t.y, t.z}), next_shape(scene)});
}

inline void add_disk(const Params& params, const Transform& t, bool reverse, Scene& scene) {
    require_whole(params, params.number("innerradius") == 0);
    Vec3 centre = to_vec3(transform_point(t, {0, 0, params.number("height")}));
    Vec3 normal = to_vec3(normalize(transform_normal(t, {0, 0, reverse ? -1.0 : 1.0})));
    scene.geometry.disks.push_back(
        {centre, normal, read_radius(params, centre, {t.x, t.y}), next_shape(scene)});
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
    Shape shape = {state.material, -1, false, -1, kept(params.at())};
    if (params.type() == "sphere") {
        add_sphere(params, state.start, scene);
        first += g.spheres.size() - 1;
        shape.reverse = state.reverse_orientation;
        shape.axes = add_axes(state.start, scene);
    } else if (params.type() == "disk") {
        add_disk(params, state.start, state.reverse_orientation, scene);
        first = before;
        shape.axes = add_axes(state.start, scene);
    } else if (params.type() == "plymesh") {
        const Param& name = params.required("filename");
        Input& input = params.input();
        const TriangleMesh* mesh = nullptr;
        input.try_to_read(params.at(), "a mesh that cannot be read", [&] {
            mesh = &input.mesh(input.find(name.at, name.strings[0]), name.at);
        });
        if (mesh) add_mesh(params, *mesh, state, each, scene);
    } else {
        add_mesh(params, read_mesh(params), state, each, scene);
    }
    size_t added = g.size() - before;
    for (size_t i = first; i < first + (each ? added : std::min(added, size_t{1})); i++) {
        scene.shapes.push_back(shape);
        if (!shines) continue;
        float area = area_of(emitter_of(scene, static_cast<uint32_t>(i)));
        scene.shapes.back().light = add_light(params, *state.emission, area, scene);
    }
}
