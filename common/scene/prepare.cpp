#include "common/scene/prepare.h"

#include "common/geometry/bvh.h"
#include "common/scene/mover.h"
#include "common/scene/sky_image.h"
#include "common/scene/texture.h"

namespace {

std::vector<Vec3> facet_normals(const Geometry& g) {
    std::vector<Vec3> normals;
    normals.reserve(g.triangles.size());
    for (const Triangle& t : g.triangles) {
        Vec3d p0(g.positions[t.v[0]]), p1(g.positions[t.v[1]]), p2(g.positions[t.v[2]]);
        Vec3d n = cross(p1 - p0, p2 - p0);
        normals.push_back(to_vec3(1 / std::sqrt(dot(n, n)) * n));
    }
    return normals;
}

void find_parallelogram(const Geometry& g, const Light& light, LightShape& shape) {
    const auto& v0 = g.triangles[light.first_prim].v;
    const auto& v1 = g.triangles[light.first_prim + 1].v;
    for (size_t i = 0; i < 3; i++) {
        for (size_t j = 0; j < 3; j++) {
            Vec3 r = g.positions[v0[i]], p = g.positions[v0[(i + 1) % 3]];
            Vec3 q = g.positions[v0[(i + 2) % 3]], s = g.positions[v1[j]];
            bool shared = g.positions[v1[(j + 1) % 3]] == q && g.positions[v1[(j + 2) % 3]] == p;
            if (!shared || length((p + q) - (r + s)) > 1e-5f * length(p - q)) continue;
            shape.parallelogram = true;
            shape.corners[0] = r, shape.corners[1] = p, shape.corners[2] = s, shape.corners[3] = q;
            shape.e1 = p - r, shape.e2 = q - r;
        }
    }
}

/// The areas and centres of all lights of the scene, and whether two triangles make one
/// parallelogram; empty for lights without area.
std::vector<LightShape> light_shapes_of(const Scene& scene) {
    std::vector<LightShape> shapes(scene.lights.size());
    for (size_t i = 0; i < scene.lights.size(); i++) {
        const Light& light = scene.lights[i];
        if (light.type != LightType::area) continue;
        LightShape& shape = shapes[i];
        shape.first = emitter_of(scene, light.first_prim);
        Box box;
        double area = 0;
        for (uint32_t k = 0; k < light.prims; k++) {
            uint32_t prim = light.first_prim + k;
            area += static_cast<double>(area_of(emitter_of(scene, prim)));
            if (light.prims > 1) shape.area_up_to.push_back(static_cast<float>(area));
            box.add(box_of(scene.geometry, prim));
        }
        shape.area = static_cast<float>(area);
        shape.centre = 0.5f * (box.low + box.high);
        shape.radius = length(box.high - box.low) / 2;
        bool triangles = light.first_prim + light.prims <= scene.geometry.triangles.size();
        if (light.prims == 2 && triangles && shape.area > 0)
            find_parallelogram(scene.geometry, light, shape);
        bool one = light.prims == 1 && shape.first.kind != Emitter::sphere;
        shape.flat = one || shape.parallelogram;
    }
    return shapes;
}

using Polygon = std::vector<Vec3d>;

/// The corners of a triangle, or of 16 points around a disk; a sphere has none.
Polygon corners_of(const Emitter& e) {
    if (e.kind == Emitter::triangle) return {Vec3d(e.p0), Vec3d(e.p1), Vec3d(e.p2)};
    Polygon corners;
    for (int i = 0; i < 16 && e.kind == Emitter::disk; i++) {
        Vec3 out = from_cylindrical(e.r, static_cast<float>(i) / 16, 0);
        corners.push_back(Vec3d(e.p0 + Frame(e.n).to_world(out)));
    }
    return corners;
}

Vec3d normal_of(const Polygon& p) { return normalize(cross(p[1] - p[0], p[2] - p[0])); }

/// Whether b lies beside one of the edges of a, but for a thousandth of that edge.
bool is_beside(const Polygon& a, const Polygon& b) {
    for (size_t k = 0; k < a.size(); k++) {
        Vec3d edge = a[(k + 1) % a.size()] - a[k], inward = cross(normal_of(a), edge);
        auto is_outside = [&](Vec3d p) { return dot(p - a[k], inward) <= 1e-3 * dot(edge, edge); };
        if (std::all_of(b.begin(), b.end(), is_outside)) return true;
    }
    return false;
}

/// Whether two flat primitives overlap and lie in one plane, up to rounding.
bool coincide(const Emitter& e, const Emitter& f, double rounding) {
    Polygon a = corners_of(e), b = corners_of(f);
    if (a.empty() || b.empty()) return false;
    auto lies_in = [&](const Polygon& p, const Polygon& plane) {
        Vec3d n = normal_of(plane);
        return std::all_of(p.begin(), p.end(), [&](Vec3d corner) {
            return std::abs(dot(corner - plane[0], n)) <= rounding;
        });
    };
    return (lies_in(a, b) || lies_in(b, a)) && !is_beside(a, b) && !is_beside(b, a);
}

}  // namespace

Emitter emitter_of(const Scene& scene, uint32_t prim) {
    const Geometry& g = scene.geometry;
    Emitter e;
    visit(
        g, prim,
        [&](const Triangle& t) {
            e.p0 = g.positions[t.v[0]], e.p1 = g.positions[t.v[1]], e.p2 = g.positions[t.v[2]];
            e.n = normalize(cross(e.p1 - e.p0, e.p2 - e.p0));
        },
        [&](const Sphere& s) {
            e.kind = Emitter::sphere, e.p0 = s.c, e.r = s.r;
            e.inward = scene.shapes[s.shape].reverse;
        },
        [&](const Disk& d) { e.kind = Emitter::disk, e.p0 = d.c, e.n = d.n, e.r = d.r; });
    Vec3 size = max(max(abs(e.p0), abs(e.p1)), abs(e.p2));  // of the numbers that make up a point
    for (int k = 0; k < 3; k++) size[k] += e.r * std::sqrt(std::max(0.0f, 1 - e.n[k] * e.n[k]));
    e.eps = rounding_error(max_component(size));
    e.off_plane = rounding_error(dot(abs(e.n), size));
    return e;
}

float area_of(const Emitter& e) {
    switch (e.kind) {
        case Emitter::triangle: return length(cross(e.p1 - e.p0, e.p2 - e.p0)) / 2;
        case Emitter::sphere: return 4 * pi * e.r * e.r;
        case Emitter::disk: return pi * e.r * e.r;
    }
    return 0;
}

std::shared_ptr<const Origin> no_origin() { return std::make_shared<Origin>(); }

Position Scene::place(const Position* at) const { return at ? *at : Position{origin->file}; }

void prepare(Scene& scene, int threads, const Report& report) {
    // Gather all skies in the first.
    scene.sky = {};
    for (size_t i = 0; i < scene.lights.size(); i++) {
        Light& light = scene.lights[i];
        if (light.type != LightType::infinite) continue;
        scene.sky += light.L;
        if (scene.sky_light < 0) scene.sky_light = static_cast<int>(i);
        light.L = {};
    }
    if (scene.sky_image) {
        // One sky: the image.
        SkyImage image = *scene.sky_image;
        for (Rgb& L : image.pixels) L += scene.sky;
        scene.sky_image = std::make_shared<SkyImage>(std::move(image));
        scene.sky = {};
    }
    if (scene.sky_light >= 0) scene.lights[static_cast<size_t>(scene.sky_light)].L = scene.sky;

    if (report) report("preparing lights and surfaces", 0);
    scene.moves = !scene.movers.empty();
    Box box = bounds_of(scene.geometry);
    uint32_t prims = scene.geometry.size();
    for (const auto& mover : scene.movers) {
        mover->first_prim = prims;
        prims += mover->geometry.size();
        mover->geometry.facet_normals = facet_normals(mover->geometry);
        mover->bvh = std::make_shared<Bvh>(build_bvh(mover->geometry, threads));
        mover->box = box_over_time(*mover);
        box.add(mover->box);
    }
    bool empty = scene.geometry.size() == 0 && scene.movers.empty();
    // Without shapes a sphere around the camera, so that skies and suns have a power.
    scene.radius = empty ? 1 : length(box.high - box.low) / 2;
    scene.centre = empty ? scene.camera.o : (box.low + box.high) / 2;
    scene.light_shapes = light_shapes_of(scene);
    scene.geometry.facet_normals = facet_normals(scene.geometry);
    if (report) report("building the hierarchy", 0);
    scene.bvh = std::make_shared<Bvh>(build_bvh(scene.geometry, threads));
}

const Shape& shape_of(const Scene& scene, uint32_t prim) {
    auto number = [](const auto& primitive) { return primitive.shape; };
    return scene.shapes[visit(scene.geometry, prim, number, number, number)];
}

std::vector<std::string> notes_of_coincident(const Scene& scene) {
    const Geometry& g = scene.geometry;
    std::vector<std::string> notes;
    constexpr uint64_t most = 30'000'000;
    uint64_t compared = 0;
    for (const Light& light : scene.lights) {
        uint32_t end = light.first_prim + light.prims;
        for (uint32_t a = light.first_prim; a < end && compared < most; a++, compared += g.size()) {
            Box here = box_of(g, a);
            float rounding = 2 * rounding_error(max_component(max(abs(here.low), abs(here.high))));
            for (uint32_t b = 0; b < g.size() && notes.size() < 20; b++) {
                Box there = box_of(g, b);
                Vec3 gap = max(here.low - there.high, there.low - here.high);
                const Shape& other = shape_of(scene, b);
                bool once = b < a || other.light < 0;  // each pair of lamps
                if (!once || max_component(gap) > rounding) continue;
                if (!coincide(emitter_of(scene, a), emitter_of(scene, b), double{rounding}))
                    continue;
                std::string note = message_at(
                    scene.place(light.at), "note",
                    "this lamp and the Shape at " + place_text(scene.place(other.at)) +
                        " lie in one place, where rounding decides which of them a ray meets");
                if (std::find(notes.begin(), notes.end(), note) == notes.end())
                    notes.push_back(note);
            }
        }
    }
    return notes;
}
