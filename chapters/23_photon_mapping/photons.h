// Chapter 23, pass one: light is sent out, and left where it falls.
#pragma once
#include <functional>
#include <span>

#include "chapters/23_photon_mapping/photon_map.h"
#include "common/path/camera_sample.h"
#include "common/path/light_paths.h"
#include "common/path/roulette.h"

namespace ch23 {

/// Where photons are counted: nearest, direct: at the first diffuse point that the eye sees, up to
/// the k-th nearest, or up to a radius that shrinks from pass to pass; final: at the second one,
/// with that radius, while light and caustics at the first are found by themselves.
enum class Gather { nearest, direct, final };

/// How a photon counts by its distance; see kernel().
enum class Kernel { box, cone, epanechnikov };

/// What the user asks for.
struct Settings {
    SamplerType sampler = SamplerType::independent;
    uint32_t seed = 0;
    int photons = 100000;  // paths from lights that each map is made of
    size_t k = 50;         // photons that the first radius is to hold
    Gather gather = Gather::final;
    Kernel kernel = Kernel::epanechnikov;
    float r = 0;  // m, no radius is larger; 0: a twentieth of the scene's
};

/// Two maps: of all light, and of what mirrors and glass alone have sent (LS+D).
enum Maps { all, caustics, maps };

/// What is prepared for the scene: the lights, and how far to look around a point, from maps whose
/// photons are not counted.
struct Prepared {
    Settings settings;
    Ends ends;
    PhotonMap pilot[maps];
    std::vector<float> radii[maps];
};

/// A vertex of a path from a light. Where the surface is diffuse it is a photon.
struct LightVertex {
    Vec3 p;         // m
    Arrival light;  // without flux where it is no photon
    const Material* material;
};

/// The vertices of all paths from lights, path after path, and a map of the photons among them.
struct LightPaths {
    std::vector<LightVertex> vertices;
    PhotonMap photons;

    /// The path of a photon, from the first vertex behind the light to the photon itself.
    std::span<const LightVertex> path_of(const Arrival& photon) const {
        size_t events = photon.depth, end = photons.vertex_of(photon) + 1;
        return {vertices.data() + (end - events), events};
    }
};

/// What is prepared for one pass.
struct Pass {
    LightPaths paths[maps];
    float shrink = 1;  // radii are those of the first pass times this
};

inline bool is_diffuse(const Material& m) { return m.type == MaterialType::diffuse; }

/// Follows one path from a light, and leaves its flux, over the number of all paths, at each
/// diffuse surface that it meets; of caustics, only at the first one, behind mirrors and glass.
///
/// Flux arrives by the cosine of wi and ng; radiance asks for that of wi and the smoothed normal.
inline void send_photon(const Scene& scene, const Prepared& prepared, Maps which, Sampler& sampler,
                        std::vector<LightVertex>& vertices) {
    if (scene.lights.empty()) return;
    double u = join(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, prepared.ends, u, u_y, sampler.u2());
    float cos_y = e.type == LightType::point ? 1 : dot(e.d, e.y.n);
    float paths = static_cast<float>(prepared.settings.photons);
    Rgb flux = e.Le * (cos_y / (e.pmf * e.y.pdf * e.pdf_w * paths)), beta = {1, 1, 1};
    Ray ray = {e.y.p + e.y.eps * e.y.n, e.d};
    for (int depth = 1; depth <= scene.max_depth; depth++) {
        // Find the next point, and leave a photon there.
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) return;
        Vec3 wi = -ray.d;
        bool last = which == caustics && !is_specular(*x->material);
        if (last && depth == 1) return;
        Rgb arrives;
        if (is_diffuse(*x->material)) {
            float cosines = std::max(0.0f, dot(wi, smooth_normal(scene, *x))) / dot(wi, x->ng);
            arrives = flux * beta * cosines;
        }
        auto events = static_cast<uint16_t>(std::min(depth, 65535));
        vertices.push_back({x->p, {arrives, to_bits(x->ng), events}, x->material});
        if (last) return;

        // Go on as in chapter 20.
        float u1 = sampler.u1();
        BsdfSample s = sample_light_bsdf(scene, *x, wi, u1, sampler.u2());
        float u_q = sampler.u1();
        if (s.pdf_w == 0) return;
        beta *= s.f / s.pdf_w;
        float q = survival_probability(beta, depth - 1);
        if (is_black(beta) || u_q >= q) return;
        beta /= q;
        ray = spawn_ray(*x, s.wi);
    }
}

/// Whether the user wants the program to end.
using Stopped = std::function<bool()>;

/// The photons among these vertices.
inline std::vector<Photon> photons_of(const std::vector<LightVertex>& vertices) {
    std::vector<Photon> photons;
    photons.reserve(vertices.size());
    for (uint32_t i = 0; i < vertices.size(); i++) {
        const LightVertex& v = vertices[i];
        if (is_diffuse(*v.material)) photons.push_back({v.p, v.light, i});
    }
    return photons;
}

/// The light paths of one pass. The same for any number of threads: their order is that of numbers.
inline LightPaths send_photons(const Scene& scene, const Prepared& prepared, Maps which,
                               uint32_t pass, int threads, const Stopped& stopped) {
    constexpr int at_once = 1024;
    int paths = prepared.settings.photons, parts = (paths + at_once - 1) / at_once;
    std::vector<std::vector<LightVertex>> sent(static_cast<size_t>(parts));
    parallel_for(parts, threads, [&](int part) {
        if (stopped()) return;
        Sampler sampler(prepared.settings.sampler, prepared.settings.seed,
                        static_cast<uint32_t>(paths));
        for (int i = part * at_once; i < std::min((part + 1) * at_once, paths); i++) {
            start_sample(sampler, size_t{2} * pass + which, 1, static_cast<uint32_t>(i));
            send_photon(scene, prepared, which, sampler, sent[static_cast<size_t>(part)]);
        }
    });
    std::vector<LightVertex> all_sent;
    if (stopped()) return {};
    for (const auto& some : sent) all_sent.insert(all_sent.end(), some.begin(), some.end());
    PhotonMap photons(photons_of(all_sent), threads);
    return {std::move(all_sent), std::move(photons)};
}

}  // namespace ch23
