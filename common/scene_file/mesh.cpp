#include "common/scene_file/mesh.h"

#include <limits>

namespace {

std::vector<Vec3> group_by_three(const std::vector<double>& numbers) {
    std::vector<Vec3> groups(numbers.size() / 3);
    for (size_t i = 0; i < numbers.size(); i++) {
        groups[i / 3][static_cast<int>(i % 3)] = static_cast<float>(numbers[i]);
    }
    return groups;
}

std::vector<uint32_t> read_indices(Params& params, size_t vertices, size_t corners) {
    const Param* param = params.find("integer", "indices");
    if (!param) {
        if (vertices == 3 && corners == 3) return {0, 1, 2};
        if (vertices == 4 && corners == 4) return {0, 1, 2, 3};
        fail(params.at(), params.owner() + " needs \"integer indices\"");
    }
    if (param->numbers.size() % corners != 0) {
        fail(param->at, "\"indices\" has " + std::to_string(param->numbers.size()) +
                            " numbers, not a multiple of " + std::to_string(corners));
    }
    std::vector<uint32_t> indices;
    for (double index : param->numbers) {
        if (index < 0 || index >= static_cast<double>(vertices)) {
            fail(param->at, "index " + std::to_string(static_cast<int>(index)) +
                                " is out of range: there are " + std::to_string(vertices) +
                                " vertices");
        }
        indices.push_back(static_cast<uint32_t>(index));
    }
    return indices;
}

// Adds positions, uv, and normals in world space; returns the number of the first.
uint32_t add_vertices(const Params& params, const TriangleMesh& mesh,
                      const Transform& world_from_object, bool reverse, Geometry& geometry) {
    size_t first = geometry.positions.size();
    for (Vec3 p : mesh.positions) {
        Vec3 world = to_vec3(transform_point(world_from_object, {p.x, p.y, p.z}));
        check_extent(params, world);
        geometry.positions.push_back(world);
    }
    if (!mesh.uvs.empty() || !geometry.uvs.empty()) {
        geometry.uvs.resize(first, {NAN, NAN});
        geometry.uvs.insert(geometry.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
        geometry.uvs.resize(geometry.positions.size(), {NAN, NAN});
    }
    if (mesh.normals.empty() && geometry.normals.empty()) return static_cast<uint32_t>(first);

    geometry.normals.resize(first);
    for (Vec3 n : mesh.normals) {
        Vec3d world = transform_normal(world_from_object, {n.x, n.y, n.z});
        // Keep lengths, by which pbrt weighs them, but not those whose square leaves float.
        double size = length(world);
        if (size > 0 && !(size > 1e-6 && size < 1e6)) world = normalize(world);
        geometry.normals.push_back(reverse ? -to_vec3(world) : to_vec3(world));
    }
    geometry.normals.resize(geometry.positions.size());
    return static_cast<uint32_t>(first);
}

}  // namespace

void check_extent(const Params& params, Vec3 p) {
    constexpr float farthest = 1e9f;
    if (is_finite(p) && max_component(abs(p)) <= farthest) return;
    fail(params.at(), params.owner() + " reaches farther than 1e9: choose a larger unit");
}

TriangleMesh read_triangle_mesh(Params& params, size_t corners) {
    TriangleMesh mesh;
    const Param* P = params.find("point3", "P");
    if (!P) fail(params.at(), params.owner() + " needs \"point3 P\"");
    mesh.positions = group_by_three(P->numbers);

    // Check that what belongs to vertices is given for each.
    const Param *N = params.find("normal", "N"), *S = params.find("vector3", "S");
    const Param* uv = params.find("point2", "uv");
    for (const Param* param : {N, S, uv}) {
        if (!param) continue;
        size_t count = param->numbers.size() / (param == uv ? 2 : 3);
        if (count == mesh.positions.size()) continue;
        fail(param->at, quote(param->name) + " is given for " + std::to_string(count) + " of " +
                            std::to_string(mesh.positions.size()) + " vertices");
    }
    if (N) mesh.normals = group_by_three(N->numbers);
    for (size_t i = 0; uv && i < uv->numbers.size(); i += 2) {
        mesh.uvs.push_back(
            {static_cast<float>(uv->numbers[i]), static_cast<float>(uv->numbers[i + 1])});
    }
    if (!are_usable(mesh.uvs)) mesh.uvs.clear();
    std::vector<uint32_t> indices = read_indices(params, mesh.positions.size(), corners);
    params.ignore("integer", {"faceIndices"});
    if (corners == 3) {
        mesh.indices = std::move(indices);
        return mesh;
    }
    // The corners of a patch are at (u, v) = (0, 0), (1, 0), (0, 1), (1, 1).
    for (size_t i = 0; i < indices.size(); i += 4) {
        uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2], d = indices[i + 3];
        mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    }
    if (!uv && mesh.positions.size() == 4 && indices == std::vector<uint32_t>{0, 1, 2, 3}) {
        mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    }
    return mesh;
}

void add_mesh(const Params& params, const TriangleMesh& mesh, const Transform& world_from_object,
              bool reverse, uint32_t shape, Geometry& g, Messages& notes) {
    uint32_t first = add_vertices(params, mesh, world_from_object, reverse, g);
    bool mirrored = determinant(world_from_object) < 0;
    size_t left_out = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        uint32_t a = first + mesh.indices[i], b = first + mesh.indices[i + 1],
                 c = first + mesh.indices[i + 2];
        Vec3 normal = cross(g.positions[b] - g.positions[a], g.positions[c] - g.positions[a]);
        if (!(length_squared(normal) >= std::numeric_limits<float>::min())) {
            left_out++;
            continue;
        }
        bool turn = mirrored != reverse;
        if (!mesh.normals.empty()) {
            float side = dot(normal, g.normals[a] + g.normals[b] + g.normals[c]);
            if (side != 0) turn = side < 0;
        }
        if (turn) std::swap(b, c);
        g.triangles.push_back({{a, b, c}, shape});
    }
    if (left_out > 0) {
        std::string all = left_out == mesh.indices.size() / 3 ? ", which is all of them" : "";
        notes.add(params.at(),
                  "left out triangles without area: " + std::to_string(left_out) + all);
    }
    if (mesh.faces_left_out > 0) {
        notes.add(params.at(), "left out faces that do not have 3 or 4 corners: " +
                                   std::to_string(mesh.faces_left_out));
    }
}
