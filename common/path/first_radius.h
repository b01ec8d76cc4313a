// The radius in which photons count: as small as blur asks, as large as noise allows.
#pragma once
#include "common/path/camera_sample.h"
#include "common/path/light_paths.h"
#include "common/path/photon_map.h"

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
