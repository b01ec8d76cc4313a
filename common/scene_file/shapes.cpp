#include "common/scene_file/shapes.h"

#include <limits>

#include "common/scene_file/mesh.h"

namespace {

// Refuses a radius of which the square is no float, or that reaches too far.
void check_radius(const Params& params, Vec3 c, float r) {
    if (!(r * r >= std::numeric_limits<float>::min())) {
        fail(params.at("radius"), params.owner() + " is smaller than 1e-18: choose a smaller unit");
    }
    check_extent(params, abs(c) + Vec3{r, r, r});
}

// The one factor by which the transform scales these axes; not supported where there is none.
double uniform_scale(Params& params, const std::vector<Vec3d>& axes) {
    constexpr double tolerance = 1e-3;  // for numbers written with few digits
    double scale = length(axes[0]);
    for (size_t i = 0; i < axes.size(); i++) {
        Vec3d next = axes[(i + 1) % axes.size()];
        bool same = std::abs(length(next) - scale) <= tolerance * scale;
        bool right_angle = std::abs(dot(axes[i], next)) <= tolerance * scale * scale;
        if (same && right_angle) continue;
        params.stand_in(params.at(), "a sphere or disk scaled differently along its axes");
        double product = 1;
        for (Vec3d axis : axes) product *= length(axis);
        return std::pow(product, 1 / static_cast<double>(axes.size()));
    }
    return scale;
}

// Parts are not supported. pbrt clamps an angle above 360 degrees.
void require_whole(Params& params, const std::string& name, bool is_whole) {
    if (params.number("phimax", 360) >= 360 && is_whole) return;
    params.stand_in(params.at(is_whole ? "phimax" : name), "a part of a sphere or disk");
}

// The number of the axes of a sphere or disk; -1 where they are the world's.
int add_axes(const Transform& t, Scene& scene) {
    auto unit = [](Vec3d v) { return to_vec3(normalize(v)); };
    Axes axes = {unit(t.x), unit(t.y), unit(t.z)};
    if (axes == Axes{}) return -1;
    scene.axes.push_back(axes);
    return static_cast<int>(scene.axes.size()) - 1;
}

int add_sphere(Params& params, const ShapeState& state, Scene& scene) {
    float radius = params.number("radius", 1, least_radius);
    // In either order, and clamped to the sphere, as in pbrt.
    float z0 = params.number("zmin", -radius), z1 = params.number("zmax", radius);
    bool is_cut = std::min(z0, z1) > -radius || std::max(z0, z1) < radius;
    require_whole(params, z1 == radius ? "zmin" : "zmax", !is_cut);
    const Transform& t = state.world_from_object;
    double scale = uniform_scale(params, {t.x, t.y, t.z});
    Sphere sphere = {to_vec3(t.o), static_cast<float>(radius * scale),
                     static_cast<uint32_t>(scene.shapes.size())};
    check_radius(params, sphere.c, sphere.r);
    scene.geometry.spheres.push_back(sphere);
    return add_axes(t, scene);
}

int add_disk(Params& params, const ShapeState& state, Scene& scene) {
    float radius = params.number("radius", 1, least_radius);
    require_whole(params, "innerradius", params.number("innerradius", 0) == 0);
    const Transform& t = state.world_from_object;
    double scale = uniform_scale(params, {t.x, t.y});
    Vec3d normal = transform_normal(t, {0, 0, state.reverse_orientation ? -1.0 : 1.0});
    Disk disk = {to_vec3(transform_point(t, {0, 0, params.number("height", 0)})),
                 to_vec3(normalize(normal)), static_cast<float>(radius * scale),
                 static_cast<uint32_t>(scene.shapes.size())};
    check_radius(params, disk.c, disk.r);
    scene.geometry.disks.push_back(disk);
    return add_axes(t, scene);
}

// Stops before the scene grows beyond the limits.
void check_room(const Params& params, const ShapeState& state, const Geometry& g, size_t primitives,
                size_t vertices, const Limits& limits) {
    if (state.primitives_elsewhere + g.size() + primitives > limits.primitives) {
        stop_reading(params.at(), "the scene has more than " + std::to_string(limits.primitives) +
                                      " triangles, spheres and disks");
    }
    if (state.vertices_elsewhere + g.positions.size() + vertices > limits.vertices) {
        stop_reading(params.at(),
                     "the scene has more than " + std::to_string(limits.vertices) + " vertices");
    }
}

float area(const Geometry& g, const Triangle& tri) {
    Vec3 p0 = g.positions[tri.v[0]];
    return length(cross(g.positions[tri.v[1]] - p0, g.positions[tri.v[2]] - p0)) / 2;
}
float area(const Geometry&, const Sphere& sphere) { return 4 * pi * sphere.r * sphere.r; }
float area(const Geometry&, const Disk& disk) { return pi * disk.r * disk.r; }

// Adds a light and returns its number.
int add_light(const Params& params, Rgb L, bool two_sided, Scene& scene) {
    check_brightness(params, L);
    Light light;
    light.L = L;
    light.two_sided = two_sided;
    light.at = kept(params.at());
    scene.lights.push_back(light);
    return static_cast<int>(scene.lights.size()) - 1;
}

// Adds the Shape of the primitives from `first` on, and what light they send.
template <class Primitive>
void add_shape(const Params& params, const ShapeState& state, std::vector<Primitive>& primitives,
               size_t first, bool reverse, int axes, Scene& scene) {
    if (first == primitives.size()) return;
    Shape shape = {state.material, -1, reverse, axes, kept(params.at())};
    bool shines = state.emission && !is_black(state.emission->L);
    if (!shines || state.emission->power == 0) {
        if (shines) {
            shape.light = add_light(params, state.emission->L, state.emission->two_sided, scene);
        }
        scene.shapes.push_back(shape);
        return;
    }
    // Make each primitive a light of its own that sends the whole power, as pbrt does.
    float sides = state.emission->two_sided ? 2 : 1;
    for (size_t i = first; i < primitives.size(); i++) {
        float radiance = state.emission->power /
                         (pi * area(scene.geometry, primitives[i]) * sides);  // for L = 1
        shape.light =
            add_light(params, radiance * state.emission->L, state.emission->two_sided, scene);
        primitives[i].shape = static_cast<uint32_t>(scene.shapes.size());
        scene.shapes.push_back(shape);
    }
}

}  // namespace

void read_shape(Params& params, const ShapeState& state, const Limits& limits, NamedFiles& files,
                Scene& scene, SceneNotes& notes) {
    Geometry& g = scene.geometry;
    size_t triangles = g.triangles.size(), spheres = g.spheres.size(), disks = g.disks.size();
    check_room(params, state, g, 1, 0, limits);
    int axes = -1;
    auto add = [&](const TriangleMesh& mesh) {
        check_room(params, state, g, mesh.indices.size() / 3, mesh.positions.size(), limits);
        uint32_t shape = static_cast<uint32_t>(scene.shapes.size());
        add_mesh(params, mesh, state.world_from_object, state.reverse_orientation, shape, g, notes);
    };
    bool is_patches = params.type() == "bilinearmesh";
    bool is_control_mesh = params.type() == "loopsubdiv" && params.stands_in();
    if (params.type() == "trianglemesh" || is_patches || is_control_mesh) {
        TriangleMesh mesh = read_triangle_mesh(params, is_patches ? 4 : 3);
        if (is_patches && state.emission && state.emission->power > 0) {
            params.stand_in(params.at(), "the power of a patch");
            if (params.may_stand_in()) {
                ShapeState without = state;
                without.emission->power = 0;
                return read_shape(params, without, limits, files, scene, notes);
            }
        }
        if (is_control_mesh) params.ignore_rest();
        params.finish();
        if (is_patches) notes.add(params.at(), "a bilinear patch is read as two triangles");
        add(mesh);
    } else if (params.type() == "plymesh") {
        const Param* name = params.find_exactly("string", "filename", 1);
        const TriangleMesh* mesh = nullptr;
        if (name) {
            params.read(
                [&] { mesh = &files.mesh(files.find(name->at, name->strings[0]), name->at); },
                "a mesh that cannot be read");
        }
        params.finish();
        if (name && !mesh) return;
        if (!name) fail(params.at(), params.owner() + " needs \"string filename\"");
        add(*mesh);
    } else if (params.type() == "sphere") {
        axes = add_sphere(params, state, scene);
    } else if (params.type() == "disk") {
        axes = add_disk(params, state, scene);
    } else {
        params.fail_type({"bilinearmesh", "disk", "plymesh", "sphere", "trianglemesh"});
    }
    params.finish();
    add_shape(params, state, g.triangles, triangles, false, axes, scene);
    add_shape(params, state, g.spheres, spheres, state.reverse_orientation, axes, scene);
    add_shape(params, state, g.disks, disks, false, axes, scene);
}

void number_light_primitives(Scene& scene) {
    uint32_t prim = 0;
    auto number = [&](const auto& primitives) {
        for (const auto& primitive : primitives) {
            int index = scene.shapes[primitive.shape].light;
            if (index >= 0) {
                Light& light = scene.lights[static_cast<size_t>(index)];
                if (light.prims++ == 0) light.first_prim = prim;
            }
            prim++;
        }
    };
    number(scene.geometry.triangles);
    number(scene.geometry.spheres);
    number(scene.geometry.disks);
}
