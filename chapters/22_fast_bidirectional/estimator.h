// Chapter 22: fast bidirectional path tracing. The weights of chapter 21 in constant time, from a
// sum stored at each vertex; direct light as in chapter 15; more samples of light in mirrors.
//
//   sum over i < s of p_i / p_s  =  r_s-1 (c_s-1 + r_s-2 (c_s-2 + r_s-3 (c_s-3 + ...)))
#pragma once
#include "common/path/subpaths.h"

namespace ch22 {

/// What is prepared for a scene, and the number of samples that through_mirrors() takes.
struct Bidirectional {
    Endpoints endpoints;
    many_lights::Lights lights;
    int samples;          // 0: none, as in chapter 21
    bool light_sampling;  // direct light as in chapter 15; false: as in chapter 21
};
inline Bidirectional prepare(const Scene& scene, int samples = 16, bool light_sampling = true) {
    return {endpoints_of(scene), many_lights::prepare(scene), samples, light_sampling};
}

/// The terms of MIS weights that a vertex stores, for all its connections.
struct MisTerms {
    float pdf = 1;      // m^-2, of this vertex in this walk
    double sum = 0;     // see add_sums()
    float to_area = 0;  // cos / d^2 at the vertex before: turns sr^-1 here into m^-2 there
    Vec3 back = {};     // unit, to the vertex before, from their positions
};

/// A path from the eye or from a light, and what its vertices store.
struct Subpath {
    bool from_light;
    Path path;
    std::vector<MisTerms> terms = {};
};

/// The density, in sr^-1, with which this walk leaves its n-th vertex along w.
inline float pdf_forward(const Scene& scene, const Endpoints& endpoints, const Subpath& walk,
                         size_t n, Vec3 w) {
    const Vertex& v = walk.path[n - 1];
    if (n > 1) return pdf_onwards(scene, walk.from_light, v.x, walk.terms[n - 1].back, w);
    return walk.from_light ? pdf_emission(v, w) : importance_cos(endpoints.camera, w);
}

/// Computes what the vertices of a walk store, once for all its connections.
///
///   r_j    density of vertex j in a walk from the other end / its density in this walk
///   c_j    1 if vertices j - 1 and j can be connected, else 0; c_0: if the light can be hit
///   sum_j = c_j-1 + r_j-2 sum_j-1,    sum_0 = sum_1 = c_0
///
/// r_j-2 depends on no vertex after j: it is the same in every path that begins like this walk.
/// source  van Antwerpen 2011; Georgiev 2012
inline void add_sums(const Scene& scene, const Endpoints& endpoints, Subpath& walk) {
    const Path& path = walk.path;
    walk.terms.resize(path.size());
    if (walk.from_light && !path.empty())
        walk.terms[0] = {.pdf = path[0].pdf, .sum = can_be_hit(path[0].type) ? 1.0 : 0.0};
    for (size_t j = 1; j < path.size(); j++) {
        const Vertex &v = path[j - 1], &x = path[j];
        Vec3 w = direction(v, x);
        float d2 = length_squared(x.x.p - v.x.p);
        float pdf = pdf_forward(scene, endpoints, walk, j, w) * std::abs(dot(w, x.x.ng)) / d2;
        walk.terms[j] = {pdf, walk.terms[j - 1].sum, std::abs(dot(w, v.x.ng)) / d2, -w};
        if (j == 1) continue;
        double c = path[j - 2].connectible && v.connectible ? 1 : 0;
        float pdf_w = pdf_onwards(scene, !walk.from_light, v.x, w, walk.terms[j - 1].back);
        float r = pdf_w * walk.terms[j - 1].to_area / walk.terms[j - 2].pdf;
        walk.terms[j].sum = c + static_cast<double>(r) * walk.terms[j - 1].sum;
    }
}

/// Sum of p_i / p_s over strategies with fewer than n vertices of this walk, but at least `fewest`.
///
///   r_n-1 (c_n-1 + r_n-2 sum_n-1)
///
/// A connection changes only two ratios. pdf, in m^-2: of the n-th vertex in a walk from the other
/// end; pdf_w, in sr^-1: with which that walk continues to the vertex before.
/// tested by  "identity: by the weights alone, chapter 22 brings what ...", to 1e-4
inline double sum_of_fewer(const Subpath& walk, size_t n, size_t fewest, float pdf, float pdf_w) {
    if (n <= fewest) return 0;
    const MisTerms& last = walk.terms[n - 1];
    double r = static_cast<double>(pdf / last.pdf);
    double c = n == 1 || walk.path[n - 2].connectible ? 1 : 0;
    if (n == fewest + 1) return r * c;
    float r_before = pdf_w * last.to_area / walk.terms[n - 2].pdf;
    return r * (c + static_cast<double>(r_before) * last.sum);
}

/// The weight of strategy (s, t): the balance heuristic, in constant time.
///
///   mis_s = p_s / sum over i of p_i = 1 / (1 + sum over i < s and i > s of p_i / p_s)
inline float mis_weight(const Scene& scene, const Endpoints& endpoints, const Subpath& light,
                        size_t s, const Subpath& eye, size_t t) {
    const Vertex& z = eye.path[t - 1];
    size_t fewest_t = s + t < 4 ? 2 : 1;  // 2: as in chapter 21, no splats of direct light
    if (s == 0) {
        float pdf_w = pdf_emission(z, eye.terms[t - 1].back);
        return static_cast<float>(1 / (1 + sum_of_fewer(eye, t, fewest_t, z.pdf, pdf_w)));
    }
    const Vertex& y = light.path[s - 1];
    size_t fewest_s = can_be_hit(light.path[0].type) ? 0 : 1;
    Vec3 w = direction(y, z);
    float d2 = length_squared(z.x.p - y.x.p);
    float pdf_y = pdf_forward(scene, endpoints, eye, t, -w) * std::abs(dot(w, y.x.ng)) / d2;
    float pdf_z = pdf_forward(scene, endpoints, light, s, w) * std::abs(dot(w, z.x.ng)) / d2;
    float back_y = s > 1 ? pdf_onwards(scene, false, y.x, w, light.terms[s - 1].back) : 0;
    float back_z = t > 1 ? pdf_onwards(scene, true, z.x, -w, eye.terms[t - 1].back) : 0;
    double sum = 1 + sum_of_fewer(light, s, fewest_s, pdf_y, back_y) +
                 sum_of_fewer(eye, t, fewest_t, pdf_z, back_z);
    return sum > 0 ? static_cast<float>(1 / sum) : 0;  // 0 if vertices coincide (0 / 0)
}

/// The contribution of strategy (s, t) without its weight, and its pixel, as in chapter 21.
inline Splat unweighted(const Scene& scene, const Endpoints& endpoints, const Path& light, size_t s,
                        const Path& eye, size_t t) {
    const Vertex& z = eye[t - 1];
    if (s == 0) return {Contribution::own_pixel, z.beta * z.Le};
    const Vertex& y = light[s - 1];
    if ((s > 1 && !y.connectible) || !z.connectible) return {Contribution::own_pixel, {}};
    if (t > 1) return {Contribution::own_pixel, connect(scene, y, z, static_cast<int>(s))};
    return connect_to_camera(scene, endpoints.camera, y.x, y.back, y.beta);
}

/// Direct light at the first vertex from the eye (neither mirror nor glass), as in chapter 15: from
/// two sampled lights and from the emission that the next ray hits.
/// tested by  "variance: direct light has the error of chapter 15", variance below 1.3 times that
inline Rgb direct_light(const Scene& scene, const many_lights::Lights& lights, const Path& eye,
                        Sampler& sampler, Recorder& recorder) {
    sampler.jump(1 << 11);
    TwoLightNumbers u = two_light_numbers(sampler, scene.lights.size(), lights.M);
    const Vertex& x = eye[1];
    many_lights::Candidates c;
    many_lights::choose_candidates(lights, x.x, x.back, u.candidates, c);
    many_lights::compute_inclusions(scene, lights, c);
    Rgb L;
    if (eye.size() > 2 && !is_black(eye[2].Le)) {
        const Vertex& y = eye[2];
        std::optional<Hit> hit = y.type == LightType::area ? std::optional(y.x) : std::nullopt;
        float pdf_b = pdf_onwards(scene, false, x.x, x.back, -y.back);
        float mis_b = many_lights::mis_emission(scene, lights, c, pdf_b, hit);
        L = y.beta * y.Le * mis_b;
        recorder.connected(L, 0, 3, mis_b);
    }
    recorder.back_to(2);
    return L + many_lights::direct_light(scene, lights, c, u, recorder);
}

/// Whether random hits alone find the light that mirrors and glass send to the t-th eye vertex.
inline bool only_random_hits(const Subpath& eye, size_t t) {
    const Path& path = eye.path;
    return t > 2 && path[t - 1].connectible && !path[t - 2].connectible &&
           eye.terms[t - 1].sum == 0;
}

/// Whether the t-th vertex from the eye, a light, is one of those that through_mirrors() finds.
inline bool is_sampled_again(const Subpath& eye, size_t t) {
    size_t z = t - 1;  // number of the last vertex before the mirrors
    while (z > 1 && !eye.path[z - 1].connectible) z--;
    return z < t - 1 && only_random_hits(eye, z);
}

/// Light that reaches z, the t-th vertex from the eye, via mirrors or glass only: mean of samples.
///
/// Unbiased: it replaces the eye path's own estimate of this light, which has the same mean.
/// tested by  "agreement: all methods, by length and class of path", within 5 standard errors
inline Rgb through_mirrors(const Scene& scene, const Vertex& z, int t, int samples,
                           Sampler& sampler, Recorder& recorder) {
    sampler.jump((1u << 13) + 512 * static_cast<uint32_t>(t));
    Rgb sum;
    for (int i = 0; i < samples; i++) {
        recorder.back_to(t);
        Vertex v = z;
        for (int n = t + 1; n <= scene.max_depth + 2; n++) {
            // Sample the next direction; play roulette behind the first one.
            float u1 = sampler.u1();
            BsdfSample s = sample_bsdf(v.x, v.back, u1, sampler.u2());
            float u_q = sampler.u1();
            if (s.pdf_w == 0) break;
            v.beta *= s.f * (std::abs(dot(s.wi, v.x.n)) / s.pdf_w);
            float q = n == t + 1 ? 1 : survival_probability(2.5f * v.beta, n - 3);
            if (is_black(v.beta) || u_q >= q) break;
            v.beta /= q;
            recorder.scatter(s, v.beta);

            // Add the light of vertex n, if the ray to it left a mirror or glass.
            std::optional<Hit> y = intersect(scene, spawn_ray(v.x, s.wi));
            recorder.vertex(y);
            if (n > t + 1) {
                Rgb Le = y ? emission(scene, *y) : sky_towards(scene, s.wi);
                Rgb L = v.beta * Le / static_cast<float>(samples);
                sum += L;
                recorder.connected(L, 0, n, 1.0f / static_cast<float>(samples));
            }
            if (!y || !is_specular(*y->material)) break;
            v.x = *y, v.back = -s.wi;
        }
    }
    return sum;
}

/// Estimates Li along the ray; splats the light path's contributions to other pixels.
///
///   L = sum over s >= 0, t >= 1 of  mis_s,t  (path of s vertices from the light, t from the eye)
///
/// Unbiased up to max_depth.      tested by  "ch22 fast bidirectional", within 5 standard errors
inline Rgb trace(const Scene& scene, const Bidirectional& settings, Ray ray, Splats& splats,
                 Sampler& sampler, Recorder& recorder) {
    // Walk from a light and from the eye as in chapter 21; add the sums to both walks.
    const Endpoints& endpoints = settings.endpoints;
    if (scene.camera.lens_radius > 0) ray = through_lens(scene.camera, ray, sampler.u2());
    if (scene.moves) ray.time = sample_time(scene.camera, sampler.u1());
    sampler.jump(1 << 12);
    Subpath light = {true, light_subpath(scene, endpoints, sampler, recorder, ray.time)};
    sampler.jump(8);
    recorder.start_at_eye();
    Subpath eye = {false, random_walk(scene, endpoints, false, ray, sampler, recorder)};
    eye.path[0].x.p = ray.o, eye.path[0].connectible = scene.camera.lens_radius == 0;
    place_light(scene, eye.path.back(), *(eye.path.end() - 2));
    if (light.path.size() > 1) place_light(scene, light.path[0], light.path[1]);
    add_sums(scene, endpoints, light);
    add_sums(scene, endpoints, eye);

    // Connect every vertex of one path to every vertex of the other.
    Rgb sum;
    bool direct = settings.light_sampling && !scene.sky_image && scene.max_depth > 0 &&
                  eye.path[1].connectible;
    size_t longest = static_cast<size_t>(scene.max_depth) + 2;
    for (size_t t = 1; t <= eye.path.size(); t++) {
        for (size_t s = t == 1 ? 3 : 0; s <= light.path.size() && s + t <= longest; s++) {
            if (s == 0 && settings.samples > 0 && is_sampled_again(eye, t)) continue;
            if (direct && s + t == 3) continue;
            if (s == 1) place_light(scene, light.path[0], eye.path[t - 1]);
            Splat splat = unweighted(scene, endpoints, light.path, s, eye.path, t);
            if (is_black(splat.L)) continue;
            float mis = mis_weight(scene, endpoints, light, s, eye, t);
            splat.L *= mis;
            recorder.connected(splat.L, static_cast<int>(s), static_cast<int>(t), mis, splat.pixel);
            if (t == 1) splats.push_back(splat);
            if (t > 1) sum += splat.L;
        }
    }

    // Take more samples of light that only random hits find.
    for (size_t t = eye.path.size(); t > 2 && settings.samples > 0; t--)
        if (only_random_hits(eye, t))
            sum += through_mirrors(scene, eye.path[t - 1], static_cast<int>(t), settings.samples,
                                   sampler, recorder);
    return direct ? sum + direct_light(scene, settings.lights, eye.path, sampler, recorder) : sum;
}

}  // namespace ch22
