#include "common/scene/prepare.h"

#include "common/geometry/bvh_build.h"

namespace {

/// Half the diagonal of the box around all primitives.
float bounding_radius(const Geometry& g) {
    Vec3 low = {infinity, infinity, infinity}, high = -low;
    auto add = [&](Vec3 p, float r) {
        low = min(low, p - Vec3{r, r, r}), high = max(high, p + Vec3{r, r, r});
    };
    for (Vec3 p : g.positions) add(p, 0);
    for (const Sphere& s : g.spheres) add(s.c, s.r);
    for (const Disk& d : g.disks) add(d.c, d.r);
    return g.size() > 0 ? length(high - low) / 2 : 0;
}

std::vector<Vec3> facet_normals(const Geometry& g) {
    std::vector<Vec3> normals;
    normals.reserve(g.triangles.size());
    for (const Triangle& t : g.triangles) {
        Vec3 p0 = g.positions[t.v[0]];
        normals.push_back(normalize(cross(g.positions[t.v[1]] - p0, g.positions[t.v[2]] - p0)));
    }
    return normals;
}

}  // namespace

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
    if (scene.sky_light >= 0) scene.lights[static_cast<size_t>(scene.sky_light)].L = scene.sky;

    if (report) report("preparing lights and surfaces", 0);
    scene.radius = bounding_radius(scene.geometry);
    scene.light_shapes = light_shapes_of(scene);
    scene.geometry.facet_normals = facet_normals(scene.geometry);
    scene.bvh = build_bvh(scene.geometry, threads, report);
}
