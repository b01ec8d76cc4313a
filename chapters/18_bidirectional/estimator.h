// Chapter 18: bidirectional path tracing. One path from the eye, one from a light, and all ways to
// join them, each with its weight:
//
//   strategy (s, t): s vertices from the light, t from the eye;   mis_s = p_s / sum over i of p_i
#pragma once
#include "chapters/18_bidirectional/weights.h"
#include "common/path/path_log.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/path/splats.h"

namespace ch18 {

/// One path from a light, vertex by vertex; the first is the point on the light.
inline void walk_from_light(const Scene& scene, const Prepared& prepared, Sampler& sampler,
                            std::vector<Vertex>& path, PathLog& log) {
    path.clear();
    if (scene.lights.empty()) return;
    double u = ::join(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, prepared.ends, u, u_y, sampler.u2());
    log.start_at_light(e.y.p);
    float cos_y = e.type == LightType::point ? 1 : dot(e.d, e.y.n);
    Rgb flux = e.Le * (cos_y / (e.pmf * e.y.pdf * e.pdf_w)), beta = {1, 1, 1};
    Vertex light;
    light.x.p = e.y.p, light.x.ng = e.y.n;
    light.pdf = e.pmf * (is_far(e.type) ? e.pdf_w : e.y.pdf);
    path.push_back(light);
    Ray ray = {e.y.p + e.y.eps * e.y.n, e.d};
    float pdf_w = e.pdf_w, back_w = 0;
    for (int depth = 1; depth <= scene.max_depth; depth++) {
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) return;
        log.vertex(*x);
        const Vertex& v = path.back();
        const Vertex& before = path[path.size() - (path.size() > 1 ? 2 : 1)];
        Vertex next = next_vertex(before, v, *x, ray.d, pdf_w, back_w, flux * beta);
        if (depth == 1) {  // as the light is no surface
            LightEnd end = light_end(e, *x);
            next.pdf = end.pdf_w;
            next.to_area = end.to_area;
            next.before = can_be_met(e.type) ? 1 : 0;
        }
        path.push_back(next);
        if (depth == scene.max_depth) return;

        // Go on as in chapter 17.
        float u1 = sampler.u1();
        BsdfSample s = sample_light_bsdf(scene, *x, next.back, u1, sampler.u2());
        float u_q = sampler.u1();
        if (s.pdf_w == 0) return;
        beta *= s.f / s.pdf_w;
        if (is_black(beta)) return;
        log.scatter(s.wi, s.f, s.pdf_w, s.specular, beta);
        float q = survival_probability(beta, depth - 1);
        if (u_q >= q) return;
        beta /= q;
        log.roulette(q, beta);
        pdf_w = s.specular ? 1 : s.pdf_w, back_w = pdf_eye(scene, *x, s.wi, next.back);
        ray = spawn_ray(*x, s.wi);
    }
}

/// t = 1: shows each vertex of the light's path to the camera. The lamp itself is left to s = 0.
inline void show(const Scene& scene, const Prepared& prepared, const std::vector<Vertex>& path,
                 Splats& splats, PathLog& log) {
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
        splats.push_back({sight->pixel, log.joined(L, s, 1, mis, sight->pixel)});
    }
}

/// s = 1: a point of a light, drawn anew.
inline Rgb join_light(const Scene& scene, const Prepared& prepared, const Vertex& before,
                      const Vertex& z, const Emission& e, int t, PathLog& log) {
    LightEnd y = light_end(e, z.x);
    Rgb f = eval_bsdf(z.x, z.back, y.wi) * std::abs(dot(y.wi, z.x.n));
    if (is_black(f * y.Li)) return {};
    float mis = mis_lit(scene, prepared, y, before, z);
    Rgb L = z.beta * f * y.Li * mis;
    if (occluded(scene, spawn_ray(z.x, y.wi, y.dist))) return {};
    return log.joined(L, 1, t, mis);
}

/// s > 1: joins vertex y of the light's path with z of the eye's; `share`: the chance of this y.
///
///   L = beta_z f_z cos_z  V / d^2  carry_y beta_y / share
inline Rgb join(const Scene& scene, const Prepared& prepared, float share, const Vertex& y_before,
                const Vertex& y, const Vertex& before, const Vertex& z, int s, int t,
                PathLog& log) {
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
    return log.joined(L * mis, s, t, mis);
}

/// What mirrors and glass alone bring from lights to z, where no join was possible on the way to
/// it: LS+DS+E, LS+DS+DS+E, ... are left to s = 0, by chance. So it is given more chances.
inline Rgb through_mirrors(const Scene& scene, const Prepared& prepared, const Vertex& z, int t,
                           Sampler& sampler, PathLog& log) {
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
            log.scatter(s.wi, s.f, s.pdf_w, s.specular, beta);
            std::optional<Hit> y = intersect(scene, spawn_ray(x, s.wi));
            Rgb Le = y ? emission(scene, *y) : scene.sky;
            if (left > 1 && counts(prepared, 0, t + left)) {
                L += log.emitted(z.beta * beta * Le / chances);
            }
            if (!y || !is_specular(*y->material)) break;
            x = *y, wo = -s.wi;
        }
        for (; left > 0; left--) log.step_back();
    }
    return L;
}

/// Estimates Li along the ray from one path, and adds to the splats what light shows to other
/// pixels.
///
///   L = sum over s >= 0, t >= 1 of  mis_s,t  (path of s vertices from the light, t from the eye)
///
/// Unbiased up to scene.max_depth scattering events.
/// source  Lafortune, Willems 1993; Veach, Guibas 1994      tested by  "ch18 bidirectional"
inline Rgb trace(const Scene& scene, const Prepared& prepared, Ray ray, Splats& splats,
                 Sampler& sampler, PathLog& log) {
    // Walk from a light, with numbers that have their own dimensions, and show it to the camera.
    static thread_local std::vector<Vertex> path;
    sampler.jump(1 << 12);
    walk_from_light(scene, prepared, sampler, path, log);
    show(scene, prepared, path, splats, log);

    // Walk from the eye.
    sampler.jump(8);
    log.start_at_eye();
    Rgb L, beta = {1, 1, 1};
    Vertex before, z;
    z.x.p = ray.o, z.x.ng = ray.d;
    float pdf_w = importance_cos(prepared.ends.camera, ray.d), back_w = 0;
    bool only_chance = true;  // no join was possible so far
    bool split = false;       // the last vertex that is no mirror was given more chances
    for (int t = 2;; t++) {
        std::optional<Hit> x = intersect(scene, ray);
        if (x) log.vertex(*x);

        // s = 0: what shines there.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        Vertex next;
        if (x) {
            next = next_vertex(before, z, *x, ray.d, pdf_w, back_w, beta);
        } else {
            next.pdf = pdf_w, next.to_area = std::abs(dot(ray.d, z.x.ng));
            next.before = (before.specular || z.specular ? 0.0f : 1.0f) +
                          back_w * z.to_area / before.pdf * z.before;
        }
        if (t == 2) next.before = next.to_area = 0;
        before = z, z = next;
        if (!is_black(Le) && !(split && before.specular) && counts(prepared, 0, t)) {
            size_t light = static_cast<size_t>(x ? x->light : scene.sky_light);
            float mis = mis_emission(scene, prepared, before, z, t, light, !x);
            L += log.emitted(beta * Le * mis, mis);
        }
        if (!x) return L;
        if (t - 2 == scene.max_depth) {
            log.cut();
            return L;
        }

        // s = 1: aim at a light. s > 1: join one vertex of the light's path, any of them.
        sampler.jump(8 * static_cast<uint32_t>(t));
        double u = ::join(sampler.u2());
        Vec2 u_y = sampler.u2(), u_d = sampler.u2();
        float u_s = sampler.u1();
        if (!z.specular && !scene.lights.empty()) {
            if (counts(prepared, 1, t)) {
                Emission e = sample_emission(scene, prepared.ends, u, u_y, u_d);
                L += join_light(scene, prepared, before, z, e, t, log);
            }
            size_t last = std::min(path.size(), static_cast<size_t>(scene.max_depth - t + 2));
            float n = static_cast<float>(last) - 1;
            size_t i = 1 + static_cast<size_t>(u_s * n);
            int s = static_cast<int>(i) + 1;
            if (n >= 1 && !path[i].specular && counts(prepared, s, t)) {
                L += join(scene, prepared, 1 / n, path[i - 1], path[i], before, z, s, t, log);
            }
        }
        if (!z.specular) {
            only_chance &= before.specular;
            split = only_chance;
            if (split) L += through_mirrors(scene, prepared, z, t, sampler, log);
        }

        // Go on.
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, z.back, u1, sampler.u2());
        float u_q = sampler.u1();
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        log.scatter(s.wi, s.f, s.pdf_w, s.specular, beta);
        float q = survival_probability(beta, t - 2);
        if (u_q >= q) return L;
        beta /= q;
        log.roulette(q, beta);
        pdf_w = s.specular ? 1 : s.pdf_w, back_w = pdf_light(scene, *x, s.wi, z.back);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace ch18
