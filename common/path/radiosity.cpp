#include "common/path/radiosity.h"

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/material/basic_bsdf.h"
#include "common/path/sampler.h"
#include "common/scene/intersect.h"
#include "common/scene/prepare.h"

/// The sides that rays from this side meet: 2 i is the front of triangle i, 2 i + 1 its back; a
/// number above all of them where a ray leaves the scene.
static std::vector<uint32_t> sides_seen(const Scene& scene, uint32_t side) {
    constexpr uint32_t rays = 256;
    auto [a, b, c] = corners(scene, side / 2);
    Vec3 n = scene.geometry.facet_normals[side / 2];
    if (side % 2 == 1) n = -n;
    Frame frame(n);
    Sampler sampler(SamplerType::sobol, 0, rays);
    std::vector<uint32_t> seen;
    for (uint32_t i = 0; i < rays; i++) {
        sampler.start(side, i);
        Vec2 u = sampler.u2();
        float s = std::sqrt(u.x);
        Vec3 x = (1 - s) * a + s * (1 - u.y) * b + s * u.y * c;
        x += rounding_error(max_component(abs(x))) * n;
        auto y = intersect(scene, {x, frame.to_world(sample_cosine_hemisphere(sampler.u2()))});
        seen.push_back(y ? 2 * y->prim + (y->front ? 0 : 1) : 2 * scene.geometry.size());
    }
    return seen;
}

void refuse(const Scene& scene) {
    for (const Light& light : scene.lights) {
        if (light.type == LightType::area) continue;
        fail(scene.place(light.at),
             "radiosity knows lamps with a surface alone; chapters from 09 on render other lights");
    }
    Rgb least = {1, 1, 1};
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (m.texture != 0 || m.type != MaterialType::diffuse) {
            fail(scene.place(m.at),
                 "radiosity knows diffuse surfaces of one reflectance alone (LD*E); chapters "
                 "13 to 25 render others");
        }
        Rgb rho = m.reflectance;
        least = {std::min(least.r, rho.r), std::min(least.g, rho.g), std::min(least.b, rho.b)};
    }
    uint32_t triangles = static_cast<uint32_t>(scene.geometry.triangles.size());
    if (scene.geometry.size() > triangles)
        fail(scene.place(shape_of(scene, triangles).at),
             "radiosity knows triangles alone; chapters from 05 on render spheres and disks");
    if (max_component(least) < 1) return;
    fail({scene.origin->file},
         "radiosity needs a surface that absorbs: in a closed room whose surfaces reflect all "
         "light, it grows with each bounce");
}

std::vector<char> find_lit_sides(const Scene& scene, bool& closed, int threads) {
    size_t outside = 2 * scene.geometry.triangles.size();  // counts as one more side
    std::vector<std::vector<uint32_t>> seen(outside);
    parallel_for(static_cast<int>(outside), threads, [&](int side) {
        seen[static_cast<size_t>(side)] = sides_seen(scene, static_cast<uint32_t>(side));
    });
    std::vector<char> lit(outside + 1), sends(outside + 1);  // sends: what reaches it goes on
    for (uint32_t side = 0; side < outside; side++) {
        lit[side] = !is_black(emitted(scene, side / 2, side % 2 == 0));
        sends[side] = lit[side] || !is_black(reflectance(scene, side / 2));
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t a = 0; a < outside; a++) {
            for (size_t b : seen[a]) {
                // Also back from b, whose rays may miss a small side.
                bool arrives = (lit[a] && sends[a]) || (lit[b] && sends[b]);
                changed |= arrives && !(lit[a] && lit[b]);
                if (arrives) lit[a] = lit[b] = true;
            }
        }
    }
    closed = !lit[outside];
    return lit;
}
