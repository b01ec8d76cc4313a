// Chapter 23, pass one: light is sent out, and left where it falls.
#pragma once
#include <functional>

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

/// What is prepared for one pass.
struct Pass {
    PhotonMap map[maps];
    float shrink = 1;  // radii are those of the first pass times this
};

inline bool is_diffuse(const Hit& x) { return x.material->type == MaterialType::diffuse; }

/// Follows one path from a light, and leaves its flux, over the number of all paths, at each
/// diffuse surface that it meets; of caustics, only at the first one, behind mirrors and glass.
///
/// Flux arrives by the cosine of wi and ng; radiance asks for that of wi and the smoothed normal.
inline void send_photon(const Scene& scene, const Prepared& prepared, Maps which, Sampler& sampler,
                        std::vector<Photon>& photons) {
    if (scene.lights.empty()) return;
    double u = join(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, prepared.ends, u, u_y, sampler.u2());
    float cos_y = e.type == LightType::point ? 1 : dot(e.d, e.y.n);
    float paths = static_cast<float>(prepared.settings.photons);
    Rgb flux = e.Le * (cos_y / (e.pmf * e.y.pdf * e.pdf_w * paths)), beta = {1, 1, 1};
    Ray ray = {e.y.p + e.y.eps * e.y.n, e.d};
    uint8_t mirrors = 0;
    for (int depth = 1; depth <= scene.max_depth; depth++) {
        // Find the next point, and leave a photon there.
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) return;
        Vec3 wi = -ray.d;
        if (is_diffuse(*x) && (which == all || depth > 1)) {
            float cosines = std::max(0.0f, dot(wi, smooth_normal(scene, *x))) / dot(wi, x->ng);
            Rgb arrives = flux * beta * cosines;
            auto events = static_cast<uint8_t>(std::min(depth, 255));
            photons.push_back({x->p, {arrives, to_bits(x->ng), events, mirrors}});
        }
        if (which == caustics && !is_specular(*x->material)) return;

        // Go on as in chapter 20.
        float u1 = sampler.u1();
        BsdfSample s = sample_light_bsdf(scene, *x, wi, u1, sampler.u2());
        float u_q = sampler.u1();
        if (s.pdf_w == 0) return;
        beta *= s.f / s.pdf_w;
        float q = survival_probability(beta, depth - 1);
        if (is_black(beta) || u_q >= q) return;
        beta /= q;
        if (s.specular && depth <= 8) mirrors |= static_cast<uint8_t>(1 << (depth - 1));
        ray = spawn_ray(*x, s.wi);
    }
}

/// Whether the user wants the program to end.
using Stopped = std::function<bool()>;

/// The photons of one pass. The same for any number of threads: their order is that of the paths.
inline PhotonMap send_photons(const Scene& scene, const Prepared& prepared, Maps which,
                              uint32_t pass, int threads, const Stopped& stopped) {
    constexpr int at_once = 1024;
    int paths = prepared.settings.photons, parts = (paths + at_once - 1) / at_once;
    std::vector<std::vector<Photon>> sent(static_cast<size_t>(parts));
    parallel_for(parts, threads, [&](int part) {
        if (stopped()) return;
        Sampler sampler(prepared.settings.sampler, prepared.settings.seed,
                        static_cast<uint32_t>(paths));
        for (int i = part * at_once; i < std::min((part + 1) * at_once, paths); i++) {
            start_sample(sampler, size_t{2} * pass + which, 1, static_cast<uint32_t>(i));
            send_photon(scene, prepared, which, sampler, sent[static_cast<size_t>(part)]);
        }
    });
    std::vector<Photon> photons;
    if (stopped()) return {};
    for (const auto& some : sent) photons.insert(photons.end(), some.begin(), some.end());
    return {std::move(photons), threads};
}

}  // namespace ch23
