// The weights of chapter 21, at a constant price: what each vertex of a path remembers, so that the
// weight of a strategy costs the same however long its path is.
#pragma once
#include "common/path/light_paths.h"

namespace bidirectional {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;

/// A vertex of a path, from the eye or from a light.
struct Vertex {
    Hit x = {};
    Vec3 back;          // unit, to the vertex before
    Rgb beta;           // what the path carries to x: throughput, or flux
    float pdf = 1;      // m^-2: the density of x
    float to_area = 0;  // cos / d^2 at the vertex before: makes m^-2 there of sr^-1 here
    float before = 0;   // see mis_sum()
    bool specular = false;
};

/// What is prepared for a scene; the one strategy that counts (s < 0: all), and whether weighted.
struct Prepared {
    Ends ends;
    int s = -1, t = -1;
    bool weighted = true;
};
inline Prepared prepare(const Scene& scene) { return {ends_of(scene)}; }
inline Prepared prepare(const Scene& scene, int s, int t, bool weighted = false) {
    return {ends_of(scene), s, t, weighted || s < 0};
}

/// The density, in sr^-1, with which a path from the eye, or from the light, goes on at x from
/// `from` to `to`. Mirrors and glass: 1 for both, as they have the same chances in both directions.
inline float pdf_eye(const Scene& scene, const Hit& x, Vec3 from, Vec3 to) {
    if (is_specular(*x.material)) return 1;
    return pdf_bsdf(seen_from(scene, x, from), from, to);
}
inline float pdf_light(const Scene& scene, const Hit& x, Vec3 from, Vec3 to) {
    if (is_specular(*x.material)) return 1;
    Hit y = seen_from(scene, x, from);
    if (x.material->type == MaterialType::diffuse) y.n = y.ng;
    return pdf_bsdf(y, from, to);
}

/// Sum of p_i / p_s over the strategies in which this side has fewer vertices, down to none.
///
///   v_j, v_j-1, ...: vertices of this side, the last one first; r = pdf from the other side / pdf
///   sum = r_j (can_j + r_j-1 (can_j-1 + r_j-2 ( ... ))),  can: whether its ends can be joined
///   there
///
/// Each r moves one vertex to the other side. Only r_j and r_j-1 depend on the vertex that is
/// joined; the bracket behind them is v_j.before, worked out once, as the path went on.
/// source  Veach 1997, sec. 10.2; van Antwerpen 2011
/// tested by  "identity: weights are p_s / sum p_i over the densities of whole paths"
inline float mis_sum(const Vertex& v, const Vertex& before, bool can, float pdf, float pdf_before) {
    return pdf / v.pdf * ((can ? 1.0f : 0.0f) + pdf_before / before.pdf * v.before);
}

/// The vertex x that the path comes to from v along wi, drawn with pdf_w there; `back_w`: with
/// which density a path of the other side would go on from x by way of v to `before`.
inline Vertex next_vertex(const Vertex& before, const Vertex& v, const Hit& x, Vec3 wi, float pdf_w,
                          float back_w, Rgb beta) {
    float d2 = length_squared(x.p - v.x.p), cos_v = std::abs(dot(wi, v.x.ng));
    float can = before.specular || v.specular ? 0 : 1;
    return {x,
            -wi,
            beta,
            pdf_w * std::abs(dot(wi, x.ng)) / d2,
            cos_v / d2,
            can + back_w * v.to_area / before.pdf * v.before,
            is_specular(*x.material)};
}

/// What a light that was drawn gives to x.
struct LightEnd {
    Vec3 wi;           // unit, from x to the light
    float dist;        // m
    Rgb Li;            // W m^-2 sr^-1: without f, cosine and visibility, over the density
    float pdf, pdf_w;  // of the light's point; of the direction to x, times what makes it area
    float to_area;     // makes the density of the light's point of one at x
};
inline bool is_far(LightType type) {
    return type == LightType::distant || type == LightType::infinite;
}
inline bool can_be_met(LightType type) {
    return type == LightType::area || type == LightType::infinite;
}
inline LightEnd light_end(const Emission& e, const Hit& x) {
    bool far = is_far(e.type);
    Vec3 to_y = e.y.p - x.p;
    float d2 = far ? 1 : dot(to_y, to_y), d = std::sqrt(d2);
    Vec3 wi = far ? -e.d : to_y / d;
    float cos_y = e.type == LightType::area ? std::max(0.0f, -dot(wi, e.y.n)) : 1;
    float cos_x = std::abs(dot(wi, x.ng)), pdf = e.pmf * (far ? e.pdf_w : e.y.pdf);
    float pdf_w = far ? e.y.pdf : e.type == LightType::area ? cos_y / pi : e.pdf_w;
    float dist = far ? infinity : d - (cos_y > 0 ? (x.eps + e.y.eps) / cos_y : 0);
    return {wi,
            dist,
            e.Le * (cos_y / (pdf * d2)),
            pdf,
            pdf_w * cos_x / d2,
            can_be_met(e.type) ? cos_y / d2 : 0};
}

/// Whether strategy (s, t) counts; its weight, from the sums of both sides.
inline bool counts(const Prepared& p, int s, int t) { return p.s < 0 || (p.s == s && p.t == t); }
inline float mis_weight(const Prepared& p, float light_sum, float eye_sum) {
    return p.weighted ? 1 / (1 + light_sum + eye_sum) : 1;
}

/// t = 1: the weight of vertex y that is shown to the camera, in direction wo; `density` = We cos /
/// d^2.
inline float mis_shown(const Scene& scene, const Prepared& p, const Vertex& before, const Vertex& y,
                       Vec3 wo, float density) {
    float pdf = density * std::abs(dot(wo, y.x.ng));
    float back = pdf_eye(scene, y.x, wo, y.back) * y.to_area;
    return mis_weight(p, mis_sum(y, before, !before.specular, pdf, back), 0);
}
/// s = 1: of a point of a light that was drawn for z.
inline float mis_lit(const Scene& scene, const Prepared& p, const LightEnd& y, const Vertex& before,
                     const Vertex& z) {
    float light_sum = pdf_eye(scene, z.x, z.back, y.wi) * y.to_area / y.pdf;
    float back = pdf_light(scene, z.x, y.wi, z.back) * z.to_area;
    return mis_weight(p, light_sum, mis_sum(z, before, !before.specular, y.pdf_w, back));
}
/// s > 1, t > 1: of y joined with z, in direction w, d2 = d^2.
inline float mis_joined(const Scene& scene, const Prepared& p, const Vertex& y_before,
                        const Vertex& y, const Vertex& z_before, const Vertex& z, Vec3 w,
                        float d2) {
    float pdf_y = pdf_eye(scene, z.x, z.back, -w) * std::abs(dot(w, y.x.ng)) / d2;
    float pdf_z = pdf_light(scene, y.x, y.back, w) * std::abs(dot(w, z.x.ng)) / d2;
    float y_back = pdf_eye(scene, y.x, w, y.back) * y.to_area;
    float z_back = pdf_light(scene, z.x, -w, z.back) * z.to_area;
    return mis_weight(p, mis_sum(y, y_before, !y_before.specular, pdf_y, y_back),
                      mis_sum(z, z_before, !z_before.specular, pdf_z, z_back));
}
/// s = 0: the weight of light that the path from the eye has met in z, or in the sky beyond.
inline float mis_emission(const Scene& scene, const Prepared& prepared, const Vertex& before,
                          const Vertex& z, int t, size_t light, bool sky) {
    bool two = scene.lights[light].two_sided;
    float pmf = pmf_light(prepared.ends.lights, light), R = scene.radius;
    float pdf = sky ? pmf / (4 * pi) : pmf * pdf_area(scene, light) / (two ? 2 : 1);
    float pdf_w = sky ? 1 / (pi * R * R) : std::abs(dot(z.back, z.x.ng)) / pi;
    bool can = t > 2 && !before.specular;
    return mis_weight(prepared, 0, mis_sum(z, before, can, pdf, pdf_w * z.to_area));
}

}  // namespace bidirectional
