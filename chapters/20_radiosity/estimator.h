// Chapter 20: radiosity. No rays for the light at all: the surfaces are cut into patches, and what
// each sends to each is worked out once. The solution belongs to the room; the camera comes last.
//
//   B_i = E_i + rho_i sum over j of F_ij B_j          patches.h, form_factors.h, solvers.h
#pragma once
#include <map>
#include <memory>

#include "chapters/20_radiosity/solvers.h"
#include "common/base/position.h"
#include "common/light/light_table.h"
#include "common/material/basic_bsdf.h"
#include "common/path/path_log.h"

namespace ch20 {

/// Throws InputError for all that has no radiosity: paths are LD*E, and lamps have a surface.
inline void refuse(const Scene& scene) {
    for (const Light& light : scene.lights) {
        if (light.type == LightType::area) continue;
        const char* name = light.type == LightType::point     ? "a point light"
                           : light.type == LightType::distant ? "a distant light"
                                                              : "a sky";
        fail({scene.file, light.line, light.column},
             std::string("radiosity knows lamps with a surface alone: ") + name +
                 " has no patches; chapters from 08 on render it");
    }
    auto refuse_material = [&](uint32_t shape) {
        const Material& m = scene.materials[scene.shapes[shape].material];
        if (m.type == MaterialType::diffuse) return;
        fail({scene.file, m.line, m.column},
             std::string("radiosity knows diffuse surfaces alone (LD*E): ") +
                 (m.type == MaterialType::dielectric ? "glass"
                  : m.alpha > 0                      ? "rough metal"
                                                     : "a mirror") +
                 " sends light on by direction");
    };
    const Geometry& g = scene.geometry;
    for (const Triangle& t : g.triangles) refuse_material(t.shape);
    for (const Sphere& s : g.spheres) refuse_material(s.shape);
    for (const Disk& d : g.disks) refuse_material(d.shape);
}

/// Throws InputError for a closed room that absorbs nothing: its light grows for ever.
inline void refuse_no_loss(const Scene& scene, const Patches& patches) {
    if (!patches.closed) return;
    Rgb least = {1, 1, 1};
    for (const Patch& p : patches.patch) {
        least = {std::min(least.r, p.rho.r), std::min(least.g, p.rho.g),
                 std::min(least.b, p.rho.b)};
    }
    if (max_component(least) < 1) return;
    fail({scene.file},
         "a closed room whose surfaces reflect all light has no solution: it would "
         "grow with each bounce");
}

enum class Show : uint8_t { constant, smooth, gather };

/// What is shown: radiosity at the corners of the patches, or one for each.
struct Shown {
    std::shared_ptr<const Patches> patches;
    std::vector<std::array<Rgb, 3>> B;  // of the corners, W m^-2
    Show show = Show::smooth;
    LightTable lights;  // for the final gather
};

/// The patches around each corner, found by where it is.
using Corner = std::array<int64_t, 3>;
inline Corner corner_at(Vec3 p, float size) {
    return {std::llround(p.x / size), std::llround(p.y / size), std::llround(p.z / size)};
}
inline std::map<Corner, std::vector<uint32_t>> find_corners(const std::vector<Patch>& patch,
                                                            float size) {
    std::map<Corner, std::vector<uint32_t>> corners;
    for (uint32_t i = 0; i < patch.size(); i++)
        for (Vec3 p : patch[i].p) corners[corner_at(p, size)].push_back(i);
    return corners;
}

/// Whether one surface goes on from p to q: alike, about in one plane, and no wall in between.
inline bool goes_on(const Scene& scene, const Patch& p, const Patch& q) {
    if (!(p.rho == q.rho && p.E == q.E) || dot(p.n, q.n) < 0.9f) return false;
    return sees(scene, p.centre + 0.1f * std::sqrt(p.area) * p.n,
                q.centre + 0.1f * std::sqrt(q.area) * q.n);
}

/// Of each corner of each patch: the patches around it that its surface goes on to, and itself.
using Around = std::vector<std::array<std::vector<uint32_t>, 3>>;
inline Around find_around(const Scene& scene, const std::vector<Patch>& patch, int threads) {
    float size = 4e-5f * scene.radius;
    auto corners = find_corners(patch, size);
    Around around(patch.size());
    parallel_for(static_cast<int>(patch.size()), threads, [&](int index) {
        uint32_t i = static_cast<uint32_t>(index);
        for (size_t c = 0; c < 3; c++) {
            for (uint32_t j : corners.find(corner_at(patch[i].p[c], size))->second)
                if (j == i || goes_on(scene, patch[i], patch[j])) around[i][c].push_back(j);
        }
    });
    return around;
}

/// Radiosity at the corners: the mean of the patches around, by area. That alone would flatten what
/// rises and falls; so what a patch's corners miss of its own radiosity is spread among them too.
inline void make_smooth(const Scene& scene, Shown& shown, int threads) {
    constexpr int rounds = 4;
    const std::vector<Patch>& patch = shown.patches->patch;
    Around around = find_around(scene, patch, threads);
    std::vector<Rgb> missing;
    for (const auto& B : shown.B) missing.push_back(B[0]);
    for (auto& B : shown.B) B = {};
    for (int round = 0; round < rounds; round++) {
        std::vector<Rgb> left = missing;
        for (size_t i = 0; i < patch.size(); i++) {
            for (size_t c = 0; c < 3; c++) {
                float area = 0;
                Rgb sum;
                for (uint32_t j : around[i][c]) {
                    area += patch[j].area;
                    sum += patch[j].area * missing[j];
                }
                shown.B[i][c] += sum / area;
                left[i] = left[i] - sum / (3 * area);
            }
        }
        missing = left;
    }
    for (auto& B : shown.B)
        for (Rgb& b : B) b = {std::max(0.0f, b.r), std::max(0.0f, b.g), std::max(0.0f, b.b)};
}

inline Shown show(const Scene& scene, std::shared_ptr<const Patches> patches, const Solution& s,
                  Show how, int threads) {
    Shown shown{patches, {}, how, {}};
    Radiosity more = ambient(patches->patch, s);
    for (size_t i = 0; i < patches->patch.size(); i++) {
        Radiosity B = radiosity_of(patches->patch[i], s.H[i] + more);
        Rgb x = {static_cast<float>(B.r), static_cast<float>(B.g), static_cast<float>(B.b)};
        shown.B.push_back({x, x, x});
    }
    if (how != Show::constant) make_smooth(scene, shown, threads);
    if (how == Show::gather) shown.lights = build_light_table(light_pmf(scene, 0));
    return shown;
}

/// B at a point of a surface.
inline Rgb radiosity_at(const Shown& shown, const Hit& x) {
    Place at = place_of(*shown.patches, x);
    if (at.patch == Piece::none) return {};
    const auto& B = shown.B[at.patch];
    return at.b[0] * B[0] + at.b[1] * B[1] + at.b[2] * B[2];
}

/// Final gather: one more bounce, for this point and not for its patch. Lamps are aimed at, and
/// left out where the direction by chance meets them.
inline Rgb gather_at(const Scene& scene, const Shown& shown, const Hit& x, Vec3 wo,
                     Sampler& sampler) {
    double u = join(sampler.u2());
    LightSample y = sample_light(scene, shown.lights, x, u, sampler.u2());
    BsdfSample s = basic_bsdf::sample_bsdf(x, wo, 0, sampler.u2());
    Rgb L;
    if (y.pdf_w > 0 && !occluded(scene, spawn_ray(x, y.wi, y.dist)))
        L += basic_bsdf::eval_bsdf(x, wo, y.wi) * y.Le * (dot(y.wi, x.n) / y.pdf_w);
    if (s.pdf_w == 0) return L;
    if (auto z = intersect(scene, spawn_ray(x, s.wi))) {
        Rgb reflected = radiosity_at(shown, *z) / pi - emission(scene, *z);
        L += s.f * reflected * (dot(s.wi, x.n) / s.pdf_w);
    }
    return L;
}

/// The radiance that arrives along the ray: that of the patch it meets.      L = B / pi
///
/// Biased: as if each patch had one radiosity, or those between its corners were in between.
/// source  Goral, Torrance, Greenberg, Battaile 1984      tested by  "ch20 radiosity"
inline Rgb trace(const Scene& scene, const Shown& shown, Ray ray, Sampler& sampler, PathLog&) {
    std::optional<Hit> x = intersect(scene, ray);
    if (!x) return {};
    if (shown.show != Show::gather) return radiosity_at(shown, *x) / pi;
    x->n = x->ng;
    return emission(scene, *x) + gather_at(scene, shown, *x, -ray.d, sampler);
}

}  // namespace ch20
