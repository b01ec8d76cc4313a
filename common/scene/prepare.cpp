#include "common/scene/prepare.h"

#include "common/geometry/bvh_build.h"
#include "common/scene/light_shape.h"
#include "common/scene/mover.h"
#include "common/scene/origin.h"
#include "common/scene/sky_image.h"
#include "common/scene/texture.h"

namespace {

std::vector<Vec3> facet_normals(const Geometry& g) {
    std::vector<Vec3> normals;
    normals.reserve(g.triangles.size());
    for (const Triangle& t : g.triangles) {
        Vec3d p0(g.positions[t.v[0]]), p1(g.positions[t.v[1]]), p2(g.positions[t.v[2]]);
        Vec3d n = cross(p1 - p0, p2 - p0);
        double inverse = 1 / std::sqrt(dot(n, n));
        auto along = [&](double x) { return static_cast<float>(x * inverse); };
        normals.push_back({along(n.x), along(n.y), along(n.z)});
    }
    return normals;
}

}  // namespace

Scene::Scene() : origin(std::make_shared<Origin>()) {}
Scene::Scene(const Scene&) = default;
Scene::Scene(Scene&&) = default;
Scene& Scene::operator=(const Scene&) = default;
Scene& Scene::operator=(Scene&&) = default;
Scene::~Scene() = default;

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
    scene.moves_or_varies = scene.moves || scene.textures;
    scene.has_normals = !scene.geometry.normals.empty();
    Box box = bounds_of(scene.geometry);
    uint32_t prims = scene.geometry.size();
    for (Mover& mover : scene.movers) {
        mover.first_prim = prims;
        scene.has_normals = scene.has_normals || !mover.geometry.normals.empty();
        prims += mover.geometry.size();
        mover.geometry.facet_normals = facet_normals(mover.geometry);
        mover.bvh = std::make_shared<Bvh>(build_bvh(mover.geometry, threads));
        mover.box = box_over_time(mover);
        box.low = min(box.low, mover.box.low), box.high = max(box.high, mover.box.high);
    }
    bool empty = scene.geometry.size() == 0 && scene.movers.empty();
    // Without shapes a sphere around the camera, so that skies and suns have a power.
    scene.radius = empty ? 1 : length(box.high - box.low) / 2;
    scene.centre = empty ? scene.camera.o : (box.low + box.high) / 2;
    scene.light_shapes = light_shapes_of(scene);
    scene.geometry.facet_normals = facet_normals(scene.geometry);
    scene.bvh = std::make_shared<Bvh>(build_bvh(scene.geometry, threads, report));
}
