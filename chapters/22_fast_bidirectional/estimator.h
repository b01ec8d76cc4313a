// Chapter 22: fast bidirectional path tracing. The weights of chapter 21 in constant time, by a sum
// that each vertex keeps; then more samples of the paths that only chance can find.
//
//   sum over i < s of p_i / p_s  =  r_s-1 (c_s-1 + r_s-2 (c_s-2 + r_s-3 (c_s-3 + ...)))
#pragma once
#include "common/path/subpaths.h"

namespace ch22 {

/// What is prepared for a scene, and how many samples replace one that only chance can find.
struct Bidirectional {
    Endpoints endpoints;
    int chances;  // 0: none, as in chapter 21
};
inline Bidirectional prepare(const Scene& scene, int chances = 16) {
    return {endpoints_of(scene), chances};
}

/// A path from the eye or from a light, and for each of its vertices what the weights need.
struct Subpath {
    bool from_light;
    Path path;
    std::vector<double> pdf = {};  // m^-2, of this vertex in this walk
    std::vector<double> sum = {};  // see add_sums()
};

/// Adds the sums of the ratios of densities to a subpath, once for all of its connections.
///
///   r_j    density of vertex j in a walk from the other end / its density in this walk
///   c_j    1 if vertices j - 1 and j can be connected, else 0; c_0: if the light can be hit
///   sum_j = c_j-1 + r_j-2 sum_j-1,    sum_0 = sum_1 = c_0
///
/// r_j-2 depends on vertices j - 2, j - 1 and j alone: it is the same in every path that has them.
/// source  van Antwerpen 2011; Georgiev 2012
inline void add_sums(const Scene& scene, const Endpoints& endpoints, Subpath& walk) {
    const Path& path = walk.path;
    bool light = walk.from_light;
    walk.pdf.resize(path.size());
    walk.sum.resize(path.size(), !path.empty() && light && can_be_hit(path[0].type) ? 1 : 0);
    for (size_t j = 0; j < path.size(); j++) {
        const Vertex &x = path[j], *v = j > 0 ? &x - 1 : nullptr, *u = j > 1 ? v - 1 : nullptr;
        if (!v) walk.pdf[j] = light ? static_cast<double>(x.pdf) : 1;
        if (v) walk.pdf[j] = pdf_next(scene, endpoints, light, u, *v, x);
        if (!u) continue;
        double c = u->connectible && v->connectible ? 1 : 0;
        double r = pdf_next(scene, endpoints, !light, &x, *v, *u) / walk.pdf[j - 2];
        walk.sum[j] = c + r * walk.sum[j - 1];
    }
}

/// Sum of p_i / p_s over the strategies that have fewer than n vertices of this walk, and at least
/// `fewest`.
///
///   r_n-1 (c_n-1 + r_n-2 sum_n-1)
///
/// A connection changes two ratios alone. x: the vertex of the other walk that the last one of this
/// walk is connected to; behind_x: the one before x. Null where the other walk has none.
/// tested by  "identity: without chances, each path brings what it brings in chapter 21"
inline double sum_of_fewer(const Scene& scene, const Endpoints& endpoints, const Subpath& walk,
                           size_t n, size_t fewest, const Vertex* x, const Vertex* behind_x) {
    if (n <= fewest) return 0;
    bool other = !walk.from_light;
    const Vertex& y = walk.path[n - 1];
    double pdf =
        x ? pdf_next(scene, endpoints, other, behind_x, *x, y) : static_cast<double>(y.pdf);
    double r = pdf / walk.pdf[n - 1];
    if (n == 1) return r;
    const Vertex& before = walk.path[n - 2];
    double c = before.connectible ? 1 : 0;
    if (n - 1 <= fewest) return r * c;
    double r_before = pdf_next(scene, endpoints, other, x, y, before) / walk.pdf[n - 2];
    return r * (c + r_before * walk.sum[n - 1]);
}

/// The weight of strategy (s, t): the balance heuristic, in the same time for every path.
///
///   mis_s = p_s / sum over i of p_i = 1 / (1 + sum over i < s and i > s of p_i / p_s)
///
/// 0 where vertices touch (0 / 0). What chapter 21 leaves out has no share: the light itself and
/// direct light, connected to the camera.
inline float mis_weight(const Scene& scene, const Endpoints& endpoints, const Subpath& light,
                        size_t s, const Subpath& eye, size_t t) {
    const Vertex *y = s > 0 ? &light.path[s - 1] : nullptr, *behind_y = s > 1 ? y - 1 : nullptr;
    const Vertex *z = &eye.path[t - 1], *behind_z = t > 1 ? z - 1 : nullptr;
    size_t fewest_s = !y || can_be_hit(light.path[0].type) ? 0 : 1, fewest_t = s + t < 4 ? 2 : 1;
    double sum = 1 + sum_of_fewer(scene, endpoints, light, s, fewest_s, z, behind_z) +
                 sum_of_fewer(scene, endpoints, eye, t, fewest_t, y, behind_y);
    return sum > 0 ? static_cast<float>(1 / sum) : 0;
}

/// What strategy (s, t) brings, without its weight, and in which pixel. As in chapter 21.
inline Splat unweighted(const Scene& scene, const Endpoints& endpoints, const Path& light, size_t s,
                        const Path& eye, size_t t) {
    const Vertex& z = eye[t - 1];
    if (s == 0) return {Contribution::own_pixel, z.beta * z.Le};
    const Vertex& y = light[s - 1];
    bool can_be_made = (s == 1 || y.connectible) && z.connectible;
    if (!can_be_made) return {Contribution::own_pixel, {}};
    if (t == 1) return connect_to_camera(scene, endpoints.camera, y);
    return {Contribution::own_pixel, connect(scene, y, z, static_cast<int>(s))};
}

/// Whether light that mirrors or glass bring to the t-th vertex from the eye is found only by
/// chance: no two vertices of such a path can be connected.
inline bool only_chance(const Subpath& eye, size_t t) {
    const Path& path = eye.path;
    return t > 2 && path[t - 1].connectible && !path[t - 2].connectible && eye.sum[t - 1] == 0;
}

/// Whether the t-th vertex from the eye, a light, is one of those that through_mirrors() finds.
inline bool has_chances(const Subpath& eye, size_t t) {
    size_t z = t - 1;  // number of the last vertex before the mirrors
    while (z > 1 && !eye.path[z - 1].connectible) z--;
    return z < t - 1 && only_chance(eye, z);
}

/// Light that comes to z, the t-th vertex from the eye, from a light by mirrors or glass alone: the
/// mean of more samples than one.
///
/// Unbiased: it replaces what the walk itself finds of these paths, which has the same mean.
/// tested by  "agreement: with and without chances through mirrors, by length and class"
inline Rgb through_mirrors(const Scene& scene, const Vertex& z, int t, int chances,
                           Sampler& sampler, Recorder& recorder) {
    sampler.jump((1u << 13) + 512 * static_cast<uint32_t>(t));
    Rgb sum;
    for (int i = 0; i < chances; i++) {
        recorder.back_to(t);
        Hit x = z.x;
        Vec3 wo = z.back;
        Rgb beta = z.beta;
        for (int n = t + 1; n <= scene.max_depth + 2; n++) {
            // Sample the next direction; play roulette behind the first one.
            float u1 = sampler.u1();
            BsdfSample s = sample_bsdf(x, wo, u1, sampler.u2());
            float u_q = sampler.u1();
            if (s.pdf_w == 0) break;
            beta *= s.f * (std::abs(dot(s.wi, x.n)) / s.pdf_w);
            float q = n == t + 1 ? 1 : survival_probability(beta, n - 3);
            if (is_black(beta) || u_q >= q) break;
            beta /= q;
            recorder.scatter(s, beta);

            // Count the light behind a mirror, the n-th vertex.
            std::optional<Hit> y = intersect(scene, spawn_ray(x, s.wi));
            recorder.vertex(y);
            Rgb Le = y ? emission(scene, *y) : scene.sky;
            Rgb L = beta * Le / static_cast<float>(chances);
            if (n > t + 1) sum += L;
            if (n > t + 1) recorder.connected(L, 0, n, 1.0f / static_cast<float>(chances));
            if (!y || !is_specular(*y->material)) break;
            x = *y, wo = -s.wi;
        }
    }
    return sum;
}

/// Estimates Li along the ray; adds to the splats what light brings to other pixels.
///
///   L = sum over s >= 0, t >= 1 of  mis_s,t  (path of s vertices from the light, t from the eye)
///
/// Unbiased up to scene.max_depth scattering events. Without chances: that of chapter 21.
/// tested by  "ch22 fast bidirectional"
inline Rgb trace(const Scene& scene, const Bidirectional& settings, Ray ray, Splats& splats,
                 Sampler& sampler, Recorder& recorder) {
    // Walk from a light and from the eye as in chapter 21; add the sums to both walks.
    const Endpoints& endpoints = settings.endpoints;
    sampler.jump(1 << 12);
    Subpath light = {true, light_subpath(scene, endpoints, sampler, recorder)};
    sampler.jump(8);
    recorder.start_at_eye();
    Subpath eye = {false, random_walk(scene, endpoints, false, ray, sampler, recorder)};
    eye.path[0].x.p = ray.o;
    place_light(scene, eye.path.back(), *(eye.path.end() - 2));
    if (light.path.size() > 1) place_light(scene, light.path[0], light.path[1]);
    add_sums(scene, endpoints, light);
    add_sums(scene, endpoints, eye);

    // Connect each number of vertices of one path with each number of the other.
    Rgb sum;
    size_t longest = static_cast<size_t>(scene.max_depth) + 2;
    for (size_t t = 1; t <= eye.path.size(); t++) {
        for (size_t s = t == 1 ? 3 : 0; s <= light.path.size() && s + t <= longest; s++) {
            if (s == 0 && settings.chances > 0 && has_chances(eye, t)) continue;
            if (s == 1) place_light(scene, light.path[0], eye.path[t - 1]);
            if (s == 2) place_light(scene, light.path[0], light.path[1]);
            Splat splat = unweighted(scene, endpoints, light.path, s, eye.path, t);
            if (is_black(splat.L)) continue;
            float mis = mis_weight(scene, endpoints, light, s, eye, t);
            splat.L *= mis;
            recorder.connected(splat.L, static_cast<int>(s), static_cast<int>(t), mis, splat.pixel);
            if (t == 1) splats.push_back(splat);
            if (t > 1) sum += splat.L;
        }
    }

    // Take more samples of what only chance can find.
    for (size_t t = eye.path.size(); t > 2 && settings.chances > 0; t--) {
        if (!only_chance(eye, t)) continue;
        int number = static_cast<int>(t);
        sum += through_mirrors(scene, eye.path[t - 1], number, settings.chances, sampler, recorder);
    }
    return sum;
}

}  // namespace ch22
