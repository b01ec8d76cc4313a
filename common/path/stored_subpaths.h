// taught by chapters 22 and 24
// Subpaths whose vertices store what the weights of their connections need, and direct light; the
// radius in which photons count, from pass to pass.
#pragma once
#include "common/path/many_lights.h"
#include "common/path/subpaths.h"

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

/// The radius of a pass, the same for all points.
///
///   (r_i+1 / r_i)^2 = (i + alpha) / (i + 1),    alpha = 2/3:    r_i ~ i^(-1/6)
///
/// After N passes bias^2 ~ r^4 ~ N^(-2/3), and variance ~ 1 / (N r^2) ~ N^(-2/3).
/// source  Hachisuka et al. 2008; Knaus, Zwicker 2011
/// tested by  "truth: radii shrink", to 1e-5
inline float radius_of(float first, uint32_t pass) {
    constexpr double alpha = 2.0 / 3;
    double r2 = 1;  // divided by the square of the first radius
    for (double i = 1; i <= pass; i++) r2 *= (i + alpha) / (i + 1);
    return first * static_cast<float>(std::sqrt(r2));
}
