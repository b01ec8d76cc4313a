// How the walks of bidirectional.h are joined: strategies of t = 1, s = 1, s > 1, and what no join
// can do.
#pragma once
#include "common/path/bidirectional_weights.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/path/splats.h"
#include "common/recording/recorder.h"

namespace bidirectional {

/// t = 1: shows each vertex of the light's path to the camera. The lamp itself is left to s = 0.
inline void show(const Scene& scene, const Prepared& prepared, const std::vector<Vertex>& path,
                 Splats& splats, Recorder& recorder) {
    const Pinhole& camera = prepared.ends.camera;
    for (size_t i = 1; i < path.size(); i++) {
        const Vertex& y = path[i];
        Vec3 away = y.x.p - camera.view.o;
        std::optional<Sight> sight = sight_of(camera, away);
        int s = static_cast<int>(i) + 1;
        if (!sight || y.specular || !counts(prepared, s, 1)) continue;
        float d2 = dot(away, away), d = std::sqrt(d2);
        Vec3 wo = -1 / d * away;
        float mis = mis_shown(scene, prepared, path[i - 1], y, wo, sight->We_cos / d2);
        Rgb L = y.beta * carry(scene, y.x, y.back, wo) * (mis * sight->We_cos / d2);
        if (is_black(L) || occluded(scene, spawn_ray(y.x, wo, d))) continue;
        splats.push_back({sight->pixel, L});
        recorder.connected(L, s, 1, mis, sight->pixel);
    }
}

/// s = 1: a point of a light, drawn anew.
inline Rgb join_light(const Scene& scene, const Prepared& prepared, const Vertex& before,
                      const Vertex& z, const Emission& e, int t, Recorder& recorder) {
    LightEnd y = light_end(e, z.x);
    Rgb f = eval_bsdf(z.x, z.back, y.wi) * std::abs(dot(y.wi, z.x.n));
    if (is_black(f * y.Li)) return {};
    float mis = mis_lit(scene, prepared, y, before, z);
    Rgb L = z.beta * f * y.Li * mis;
    if (occluded(scene, spawn_ray(z.x, y.wi, y.dist))) return {};
    recorder.connected(L, 1, t, mis);
    return L;
}

/// s > 1: joins vertex y of the light's path with z of the eye's; `share`: the chance of this y.
///
///   L = beta_z f_z cos_z  V / d^2  carry_y beta_y / share
inline Rgb join(const Scene& scene, const Prepared& prepared, float share, const Vertex& y_before,
                const Vertex& y, const Vertex& before, const Vertex& z, int s, int t,
                Recorder& recorder) {
    Vec3 to_z = z.x.p - y.x.p;
    float d2 = dot(to_z, to_z), d = std::sqrt(d2);
    if (!(d2 > 0)) return {};
    Vec3 w = to_z / d;
    Rgb f = eval_bsdf(z.x, z.back, -w) * std::abs(dot(w, z.x.n));
    if (is_black(f)) return {};
    Rgb L = z.beta * f * y.beta * carry(scene, y.x, y.back, w) / (d2 * share);
    if (is_black(L)) return {};
    float mis = mis_joined(scene, prepared, y_before, y, before, z, w, d2);
    if (occluded(scene, spawn_ray(z.x, -w, d - (z.x.eps + y.x.eps) / std::abs(dot(w, y.x.ng)))))
        return {};
    L *= mis;
    recorder.connected(L, s, t, mis);
    return L;
}

/// What mirrors and glass alone bring from lights to z, where no join was possible on the way to
/// it: LS+DS+E, LS+DS+DS+E, ... are left to s = 0, by chance. So it is given more chances.
inline Rgb through_mirrors(const Scene& scene, const Prepared& prepared, const Vertex& z, int t,
                           Sampler& sampler, Recorder& recorder) {
    constexpr int chances = 16;
    sampler.jump(1 << 13);
    Rgb L;
    for (int i = 0; i < chances; i++) {
        Hit x = z.x;
        Vec3 wo = z.back;
        Rgb beta = {1, 1, 1};
        int left = 0;  // z and the mirrors behind it
        while (t + left <= scene.max_depth + 1) {
            float u1 = sampler.u1();
            BsdfSample s = sample_bsdf(x, wo, u1, sampler.u2());
            float u_q = sampler.u1();
            beta *= s.f * (s.pdf_w > 0 ? std::abs(dot(s.wi, x.n)) / s.pdf_w : 0);
            float q = left == 0 ? 1 : survival_probability(beta, t + left - 2);
            if (is_black(beta) || u_q >= q) break;
            beta /= q;
            left++;
            recorder.scatter(s, z.beta * beta);
            std::optional<Hit> y = intersect(scene, spawn_ray(x, s.wi));
            Rgb Le = y ? emission(scene, *y) : scene.sky;
            if (left > 1 && counts(prepared, 0, t + left)) {
                L += z.beta * beta * Le / chances;
                recorder.emitted(Le, 1.0f / chances);
            }
            if (!y || !is_specular(*y->material)) break;
            x = *y, wo = -s.wi;
        }
        for (; left > 0; left--) recorder.step_back();
    }
    return L;
}

}  // namespace bidirectional
