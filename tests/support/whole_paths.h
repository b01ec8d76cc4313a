// Whole paths from a light to the eye, and the densities with which each strategy makes them.
#pragma once
#include "common/path/subpaths.h"
#include "tests/support/estimators.h"
#include "tests/support/ggx_truth.h"

/// All that is seen of a whole path, from the light x[0] on to the eye: x[k] is the last surface.
struct WholePath {
    Path from_light;            // as the walk from the light left them
    std::vector<Hit> from_eye;  // [i]: the vertex i + 1 steps from the eye
    size_t light = 0;
};

/// The same points as a path from the eye meets them; nothing where it does not.
inline bool add_eye_vertices(const Scene& scene, const Pinhole& camera, WholePath& path) {
    Vec3 o = camera.view.o;
    for (size_t i = path.from_light.size(); i-- > 0;) {
        Vec3 target = path.from_light[i].x.p, d = normalize(target - o);
        std::optional<Hit> x = intersect(
            scene, path.from_eye.empty() ? Ray{o, d} : spawn_ray(path.from_eye.back(), d));
        if (!x || length(x->p - target) > 2e-5f * scene.radius) return false;
        path.from_eye.push_back(*x);
        if (i == 0) break;
        Vec3 wi = normalize(path.from_light[i - 1].x.p - x->p);
        if (pdf_onwards(scene, false, *x, -d, wi) == 0) return false;
        if (pdf_onwards(scene, true, *x, wi, -d) == 0) return false;
        o = x->p;
    }
    return true;
}

inline double cosine(Vec3d a, Vec3d b) { return dot(a, b) / std::sqrt(dot(a, a) * dot(b, b)); }

/// The density, in sr^-1, with which a path goes on at x, where its normals are the surface's; the
/// same from both sides. In double, and by formulas of its own.
inline double density_onwards(const Hit& x, Vec3d from, Vec3d to) {
    if (is_specular(*x.material)) return 1;
    Vec3d n(x.ng);
    double cos_o = cosine(from, n), cos_i = cosine(to, n);
    if (cos_o * cos_i <= 0) return 0;
    if (x.material->type == MaterialType::diffuse) return std::abs(cos_i) / pi_exact;
    Vec3d half = from / std::sqrt(dot(from, from)) + to / std::sqrt(dot(to, to));
    double cos_h = cosine(half, n), alpha = double{x.material->alpha};
    double D = alpha * alpha / pi_exact / std::pow(1 + cos_h * cos_h * (alpha * alpha - 1), 2);
    return D / (1 + RoughMetal{alpha, 0, 0}.lambda(cos_o)) / (4 * std::abs(cos_o));
}

/// The balance heuristic as it is written: densities of the whole path by each strategy, in double
/// and without a line of the lesson. Connections by s; with an area, N pi r^2, then merges by the
/// number of their vertex.
inline std::vector<double> densities_of(const Scene& scene, const Endpoints& endpoints,
                                        const WholePath& path, double area_of_merges = 0) {
    const auto& y = path.from_light;
    size_t n = y.size();  // vertices but the eye
    auto p = [&](size_t i) { return Vec3d(i < n ? y[i].x.p : endpoints.camera.view.o); };
    auto hit = [&](size_t i) { return path.from_eye[n - 1 - i]; };
    auto specular = [&](size_t i) { return i > 0 && i < n && is_specular(*y[i].x.material); };
    auto to = [&](size_t a, size_t b) { return p(b) - p(a); };
    auto area = [&](size_t from, size_t at) {  // of one sr at `from`, in m^-2 at `at`
        Vec3d d = to(from, at);
        return std::abs(cosine(d, Vec3d(hit(at).ng))) / dot(d, d);
    };
    // Of each vertex, when it comes from the light, and from the eye.
    std::vector<double> light(n), eye(n);
    for (size_t i = 0; i < n; i++) {
        if (i == 0) {
            double sides = scene.lights[path.light].two_sided ? 2 : 1;
            light[i] = static_cast<double>(pmf_light(endpoints.lights, path.light) *
                                           pdf_area(scene, path.light)) /
                       sides;
        } else {
            double pdf_w = i == 1 ? std::abs(cosine(to(0, 1), Vec3d(hit(0).ng))) / pi_exact
                                  : density_onwards(hit(i - 1), to(i - 1, i - 2), to(i - 1, i));
            light[i] = pdf_w * area(i - 1, i);
        }
        double cos_c = cosine(to(n, i), Vec3d(endpoints.camera.axis));
        double pdf_w = i == n - 1 ? 1 / (double{endpoints.camera.area} * cos_c * cos_c * cos_c)
                                  : density_onwards(hit(i + 1), to(i + 1, i + 2), to(i + 1, i));
        eye[i] = pdf_w * area(i + 1, i);
    }
    std::vector<double> of_strategy(n + 1);  // by s; the eye alone comes from no light
    for (size_t s = 0; s <= n; s++) {
        bool joined = s == 0 || (!specular(s - 1) && !specular(s));
        bool left_out = s == n && n < 3;  // direct light, or the light, connected to the camera
        double density = joined && !left_out ? 1 : 0;
        for (size_t i = 0; i < n; i++) density *= i < s ? light[i] : eye[i];
        of_strategy[s] = density;
    }
    for (size_t at = 0; at < n && area_of_merges > 0; at++) {
        bool merges = at > 1 && specular(at - 1) && !specular(at) && y[at - 1].x.light < 0 &&
                      y[at].x.material->type == MaterialType::diffuse;
        double density = merges ? area_of_merges : 0;
        for (size_t i = 0; i < n; i++) {
            if (i <= at) density *= light[i];
            if (i >= at) density *= eye[i];
        }
        of_strategy.push_back(density);
    }
    return of_strategy;
}
