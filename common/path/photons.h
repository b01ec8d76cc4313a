// taught by chapter 23
// The first step of photon mapping: light paths, the flux that arrives at each vertex, and the
// radius in which photons count: as small as blur asks, as large as noise allows.
#pragma once
#include "common/base/parallel.h"
#include "common/path/camera_sample.h"
#include "common/path/light_paths.h"
#include "common/path/photon_map.h"
#include "common/path/roulette.h"

/// A diffuse surface that the camera sees, straight or behind mirrors and glass.
struct SeenPoint {
    Vec3 p, ng;    // m; unit
    float bsdf;    // mean of the colors, in 1/sr
    float pixel;   // width of a pixel there, in m
    double L = 0;  // radiance, by all photons
};

/// What the camera sees through a grid of film points. A picture of fewer than 128x128 pixels
/// counts as one of that size, since its light is no less sharp.
///
///   pixel = length of the path * sqrt(solid angle of the pixel)
///
/// tested by  "truth: the width of a pixel on a floor", to 3 %
inline std::vector<SeenPoint> seen_points(const Scene& scene) {
    constexpr int side = 48;  // of the grid
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    float pixels = static_cast<float>(scene.width) * static_cast<float>(scene.height);
    float part = std::min(pixels / (128 * 128), 1.0f);
    float pixel = std::sqrt(part * length(cross(view.dx, view.dy)));  // its width at distance 1
    float step_x = static_cast<float>(scene.width) / side;
    float step_y = static_cast<float>(scene.height) / side;
    std::vector<SeenPoint> points;
    Sampler sampler(SamplerType::independent, 0, 1);
    for (int i = 0; i < side * side; i++) {
        start_sample(sampler, static_cast<size_t>(i), 0, 0);
        float row = static_cast<float>(i / side), column = static_cast<float>(i % side);
        Ray ray = camera_ray(view, {(column + 0.5f) * step_x, (row + 0.5f) * step_y});
        float distance = 0;
        std::optional<Hit> x = intersect(scene, ray);
        for (int depth = 0; x && is_specular(*x->material) && depth < scene.max_depth; depth++) {
            distance += length(x->p - ray.o);
            float u1 = sampler.u1();
            ray = spawn_ray(*x, sample_bsdf(*x, -ray.d, u1, sampler.u2()).wi);
            x = intersect(scene, ray);
        }
        if (!x || !is_diffuse(*x->material)) continue;
        distance += length(x->p - ray.o);
        points.push_back({x->p, x->ng, average(x->material->reflectance) / pi, pixel * distance});
    }
    return points;
}

/// The width of a pixel where the camera sees surfaces, in m: the median over these points.
inline float pixel_width(const std::vector<SeenPoint>& points) {
    std::vector<float> widths;
    for (const SeenPoint& x : points) widths.push_back(x.pixel);
    auto median = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), median, widths.end());
    return *median;
}

/// What the photons of a map near x add to its radiance: calls work(e, d) for each.
///
///   e = bsdf K(d / r) flux / (pi r^2);    d = e, less the same with half the radius
template <class Work>
inline void for_each_near(const PhotonMap& map, const SeenPoint& x, const Work& work) {
    float r = map.radius();
    map.for_each_near(x.p, [&](const Photon& photon, Vec3 v) {
        bool same_surface = dot(photon.ng, x.ng) > std::numbers::sqrt2_v<float> / 2;
        if (!same_surface || std::abs(dot(v, x.ng)) > r / 8) return;
        Rgb flux = photon.cosines * photon.flux;
        float q = dot(v, v) / (r * r), scale = x.bsdf * average(flux) / (pi * r * r);
        float e = scale * kernel(q), half = q < 0.25f ? 4 * scale * kernel(4 * q) : 0;
        work(double{e}, double{e - half});
    });
}

/// The squared blur of the photons in the radius of a map, divided by their variance. Both are
/// relative to the radiance of each point, as in relMSE. No photons: 0.
///
///   blur^2 / variance = sum over points of ((sum_j d_j)^2 - sum_j d_j^2) / (L^2 + 0.01)
///                     / sum over points of  sum_j e_j^2                  / (L^2 + 0.01)
///
/// tested by  "truth: blur and variance of light that grows with the distance", to 0.1
inline double blur_to_noise(const std::vector<SeenPoint>& points, const PhotonMap& map) {
    double blur2 = 0, variance = 0;
    for (const SeenPoint& x : points) {
        double sum_d = 0, sum_d2 = 0, sum_e2 = 0;
        for_each_near(map, x, [&](double e, double d) {
            sum_d += d;
            sum_d2 += d * d;
            sum_e2 += e * e;
        });
        double weight = 1 / (x.L * x.L + 0.01);
        blur2 += weight * (sum_d * sum_d - sum_d2);
        variance += weight * sum_e2;
    }
    return variance > 0 ? blur2 / variance : 0;
}

/// The first radius: at most six pixels wide, and so small that the squared blur of the photons
/// `sharp` is 0.04 of the variance of a pass. `all`: the photons that are the light of all points.
/// `share`: how many times as many light paths as a pass has made the photons `sharp`.
///
///   blur^2 / variance ~ r^4, near to where it is 1
///
/// tested by  "truth: the first radius is where light of a known profile blurs that much", to 5 %
inline float first_radius(std::vector<SeenPoint> points, const PhotonMap& all,
                          std::span<const Photon> sharp, double share) {
    for (SeenPoint& x : points) for_each_near(all, x, [&](double e, double) { x.L += e; });

    // Go down to where the blur is no longer far above the noise, and from there to 0.04.
    float w = pixel_width(points), r = 6 * w;
    double ratio = blur_to_noise(points, PhotonMap(sharp, r)) / share;
    while (ratio > 1 && r > w / 8) {
        r /= std::numbers::sqrt2_v<float>;
        ratio = blur_to_noise(points, PhotonMap(sharp, r)) / share;
    }
    return r * static_cast<float>(std::pow(0.04 / std::max(ratio, 0.04), 0.25));
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
