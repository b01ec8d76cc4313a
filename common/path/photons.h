// taught by chapter 23
// The first step of photon mapping: light paths, and maps of the flux at their vertices.
#pragma once
#include "common/base/parallel.h"
#include "common/path/light_paths.h"
#include "common/path/method.h"
#include "common/path/photon_map.h"
#include "common/path/roulette.h"

/// A vertex of a path from a light. Where the surface is diffuse it is a photon.
struct LightVertex {
    Vec3 p, ng;     // m; unit, on the side where the light arrived
    Rgb flux;       // W, of a photon
    float cosines;  // as in Photon
    int depth;      // scattering events on the path, this one included
    const Material* material;
};

/// The photons of one pass, and how they are gathered.
struct PhotonMaps {
    bool final_gathering;               // gather at the second diffuse vertex, not at the first
    std::vector<LightVertex> vertices;  // of all light paths, one path after the other
    PhotonMap global, caustic;          // all photons; only those of paths LS+D
};

/// Sorts the photons among these vertices into the two maps.
inline PhotonMaps build_maps(std::vector<LightVertex> vertices, float radius,
                             bool final_gathering) {
    std::vector<Photon> global, caustic;
    bool only_specular = true;  // so far, on this path
    for (uint32_t i = 0; i < vertices.size(); i++) {
        const LightVertex& v = vertices[i];
        if (v.depth == 1) only_specular = true;
        if (is_diffuse(*v.material)) {
            global.push_back({v.p, v.ng, v.flux, v.depth, i, v.cosines});
            if (only_specular && v.depth > 1) caustic.push_back(global.back());
        }
        only_specular = only_specular && is_specular(*v.material);
    }
    return {final_gathering, std::move(vertices), PhotonMap(global, radius),
            PhotonMap(caustic, radius)};
}

/// What the user asks for.
struct PhotonSettings {
    SamplerType sampler = SamplerType::independent;
    uint32_t seed = 0;
    int light_paths = 100000;  // in each pass
    bool final_gathering = true;
    float radius = 0;  // m, of the disk in which photons count; 0: by the photons
};

/// Traces one of `paths` light paths, and stores its vertices with the flux that arrives there.
///
///   flux = Le cos_y / (pmf pdf_A pdf_w paths) beta
///
/// source  Jensen 1996
/// tested by  "truth: flux onto a floor, from every light ...", within 5 standard errors + 1 %
inline void trace_light_path(const Scene& scene, const Endpoints& endpoints, int paths,
                             Sampler& sampler, std::vector<LightVertex>& vertices) {
    if (scene.lights.empty() && endpoints.p_image == 0) return;
    double u = to_unit_double(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, endpoints, u, u_y, sampler.u2());
    float cos_y = e.type == LightType::point ? 1 : dot(e.d, e.y.n);
    Rgb beta = {1, 1, 1};
    Rgb flux = e.Le * (cos_y / (e.pmf * e.y.pdf * e.pdf_w * static_cast<float>(paths)));
    Ray ray = {e.y.p + e.y.eps * e.y.n, e.d};
    for (int depth = 1; depth <= scene.max_depth; depth++) {
        // Find the next vertex, and store it.
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) return;
        Vec3 wi = -ray.d;
        float cosines = std::max(0.0f, dot(wi, smooth_normal(scene, *x))) / dot(wi, x->ng);
        vertices.push_back({x->p, x->ng, flux * beta, cosines, depth, x->material});

        // Sample the next direction as in chapter 20.
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

/// First step: traces the light paths. The order of the vertices does not depend on threads.
inline std::vector<LightVertex> trace_light_paths(const Scene& scene, const Endpoints& endpoints,
                                                  const PhotonSettings& settings, uint32_t pass,
                                                  int threads, const Stopped& stopped) {
    constexpr int at_once = 1024;
    int paths = settings.light_paths, parts = (paths + at_once - 1) / at_once;
    std::vector<std::vector<LightVertex>> of_part(static_cast<size_t>(parts));
    parallel_for(parts, threads, [&](int part) {
        if (stopped()) return;
        Sampler sampler(settings.sampler, settings.seed, static_cast<uint32_t>(paths));
        for (int i = part * at_once; i < std::min((part + 1) * at_once, paths); i++) {
            start_sample(sampler, pass, 1, static_cast<uint32_t>(i));
            trace_light_path(scene, endpoints, paths, sampler, of_part[static_cast<size_t>(part)]);
        }
    });
    std::vector<LightVertex> vertices;
    for (const auto& some : of_part) vertices.insert(vertices.end(), some.begin(), some.end());
    return vertices;
}

/// The first radius: what the user asks for, or one that suits the photons of a trial. The trial's
/// photons are independent of each other and of the seed.
inline float choose_radius(const Scene& scene, const Endpoints& endpoints,
                           const PhotonSettings& settings) {
    if (settings.radius > 0) return settings.radius;
    std::vector<SeenPoint> points = seen_points(scene);
    if (points.empty()) return scene.radius / 100;
    PhotonSettings trial = settings;
    trial.sampler = SamplerType::independent, trial.seed = 0;
    trial.light_paths = 4 * std::min(settings.light_paths, 1 << 15);
    auto vertices = trace_light_paths(scene, endpoints, trial, 0, 1, [] { return false; });
    double share = static_cast<double>(trial.light_paths) / settings.light_paths;
    PhotonMaps maps = build_maps(std::move(vertices), 4 * pixel_width(points), false);
    const PhotonMap& sharp = maps.caustic.size() > 0 ? maps.caustic : maps.global;
    return first_radius(points, maps.global, sharp.photons(), share);
}
