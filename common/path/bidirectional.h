// The fast form of chapter 21: weights at a constant price, one join for each vertex from the eye,
// and more chances for what mirrors and glass alone bring. The same means as the lesson's.
#pragma once
#include "common/path/bidirectional_joins.h"

namespace bidirectional {

/// One path from a light, vertex by vertex; the first is the point on the light.
inline void walk_from_light(const Scene& scene, const Prepared& prepared, Sampler& sampler,
                            std::vector<Vertex>& path, Recorder& recorder) {
    path.clear();
    if (scene.lights.empty()) return;
    double u = ::join(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, prepared.ends, u, u_y, sampler.u2());
    recorder.start_at_light(e.y.p);
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
        recorder.vertex(x);
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

        // Go on as in chapter 20.
        float u1 = sampler.u1();
        BsdfSample s = sample_light_bsdf(scene, *x, next.back, u1, sampler.u2());
        float u_q = sampler.u1();
        if (s.pdf_w == 0) return;
        beta *= s.f / s.pdf_w;
        if (is_black(beta)) return;
        recorder.scatter(s, beta);
        float q = survival_probability(beta, depth - 1);
        if (u_q >= q) return;
        beta /= q;
        recorder.roulette(q, beta);
        pdf_w = s.specular ? 1 : s.pdf_w, back_w = pdf_eye(scene, *x, s.wi, next.back);
        ray = spawn_ray(*x, s.wi);
    }
}

/// s = 0: the vertex that the path from the eye comes to behind z, or in the sky; z is then before.
inline Vertex next_from_eye(const Vertex& before, const Vertex& z, const std::optional<Hit>& x,
                            Vec3 wi, float pdf_w, float back_w, Rgb beta) {
    if (x) return next_vertex(before, z, *x, wi, pdf_w, back_w, beta);
    Vertex sky;
    sky.pdf = pdf_w, sky.to_area = std::abs(dot(wi, z.x.ng));
    sky.before =
        (before.specular || z.specular ? 0.0f : 1.0f) + back_w * z.to_area / before.pdf * z.before;
    return sky;
}

/// s = 1: aims at a light.
inline Rgb aim(const Scene& scene, const Prepared& prepared, const Vertex& before, const Vertex& z,
               int t, Sampler& sampler, Recorder& recorder) {
    double u = ::join(sampler.u2());
    Vec2 u_y = sampler.u2(), u_d = sampler.u2();
    if (z.specular || scene.lights.empty() || !counts(prepared, 1, t)) return {};
    Emission e = sample_emission(scene, prepared.ends, u, u_y, u_d);
    return join_light(scene, prepared, before, z, e, t, recorder);
}

/// s > 1: joins one vertex of the light's path, any of them.
inline Rgb join_any(const Scene& scene, const Prepared& prepared, const std::vector<Vertex>& path,
                    const Vertex& before, const Vertex& z, int t, Sampler& sampler,
                    Recorder& recorder) {
    float u_s = sampler.u1();
    if (z.specular || path.empty()) return {};
    size_t last = std::min(path.size(), static_cast<size_t>(scene.max_depth - t + 2));
    float n = static_cast<float>(last) - 1;
    size_t i = 1 + static_cast<size_t>(u_s * n);
    int s = static_cast<int>(i) + 1;
    if (n < 1 || path[i].specular || !counts(prepared, s, t)) return {};
    return join(scene, prepared, 1 / n, path[i - 1], path[i], before, z, s, t, recorder);
}

/// Estimates Li along the ray from one path, and adds to the splats what light shows to other
/// pixels.
///
///   L = sum over s >= 0, t >= 1 of  mis_s,t  (path of s vertices from the light, t from the eye)
///
/// Unbiased up to scene.max_depth scattering events.
/// source  Lafortune, Willems 1993; Veach, Guibas 1994      tested by  "ch21 bidirectional"
inline Rgb trace(const Scene& scene, const Prepared& prepared, Ray ray, Splats& splats,
                 Sampler& sampler, Recorder& recorder) {
    // Walk from a light, with numbers that have their own dimensions, and show it to the camera.
    static thread_local std::vector<Vertex> path;
    sampler.jump(1 << 12);
    walk_from_light(scene, prepared, sampler, path, recorder);
    show(scene, prepared, path, splats, recorder);

    // Walk from the eye.
    sampler.jump(8);
    recorder.start_at_eye();
    Rgb L, beta = {1, 1, 1};
    Vertex before, z;
    z.x.p = ray.o, z.x.ng = ray.d;
    float pdf_w = importance_cos(prepared.ends.camera, ray.d), back_w = 0;
    bool only_chance = true;  // no join was possible so far
    bool split = false;       // the last vertex that is no mirror was given more chances
    for (int t = 2;; t++) {
        // Find the next point, and what shines there.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);
        Vertex next = next_from_eye(before, z, x, ray.d, pdf_w, back_w, beta);
        if (t == 2) next.before = next.to_area = 0;
        before = z, z = next;
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le) && !(split && before.specular) && counts(prepared, 0, t)) {
            size_t light = static_cast<size_t>(x ? x->light : scene.sky_light);
            float mis = mis_emission(scene, prepared, before, z, t, light, !x);
            L += beta * Le * mis;
            recorder.emitted(Le, mis);
        }
        if (x && t - 2 == scene.max_depth) recorder.cut();
        if (!x || t - 2 == scene.max_depth) return L;

        // Join it with the light's path, or give what mirrors bring more chances.
        sampler.jump(8 * static_cast<uint32_t>(t));
        L += aim(scene, prepared, before, z, t, sampler, recorder);
        L += join_any(scene, prepared, path, before, z, t, sampler, recorder);
        if (!z.specular) {
            only_chance &= before.specular;
            split = only_chance;
            if (split) L += through_mirrors(scene, prepared, z, t, sampler, recorder);
        }

        // Go on.
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, z.back, u1, sampler.u2());
        float u_q = sampler.u1();
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s, beta);
        float q = survival_probability(beta, t - 2);
        if (u_q >= q) return L;
        beta /= q;
        recorder.roulette(q, beta);
        pdf_w = s.specular ? 1 : s.pdf_w, back_w = pdf_light(scene, *x, s.wi, z.back);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace bidirectional
