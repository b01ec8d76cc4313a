// The photons of a pass, a hash grid that finds those near to a point, and the radius in which they
// count: as small as blur asks, as large as noise allows.
#pragma once
#include <bit>
#include <span>

#include "common/path/light_paths.h"

/// The flux that a path from a light has left at one point of a diffuse surface.
struct Photon {
    Vec3 p, ng;           // m; unit, on the side where the light arrived
    Rgb flux;             // W
    int depth = 0;        // scattering events on the path, the one at p included
    uint32_t vertex = 0;  // its place among the vertices of all light paths
    float cosines = 1;    // wi.n / wi.ng, where n is the smoothed normal

    /// Light arrives in proportion to wi.ng, but a path that meets x multiplies by wi.n. Where the
    /// smoothed normal looks away from the camera, x.n is ng.
    Rgb flux_at(const Hit& x) const { return x.n == x.ng ? flux : cosines * flux; }
};

/// A hash grid: the photons sorted by the cubic cell that they lie in.
///
/// Cells have sides of twice the radius, so a ball of that radius reaches into 8 of them at most.
/// A table holds where the photons of each cell begin. Cells far apart may share an entry: their
/// photons are farther away than the radius.
/// source  Teschner et al. 2003      tested by  "brute: photons near a point"
class PhotonMap {
public:
    PhotonMap() = default;
    PhotonMap(std::span<const Photon> photons, float radius)
        : radius_(radius), photons_(photons.size()) {
        // Counting sort: count each entry's photons, turn counts into ends, fill from the ends.
        begin_.resize(std::max(std::bit_ceil(photons.size()), size_t{32}) + 1);
        for (const Photon& photon : photons) begin_[entry_of(cell_of(photon.p))]++;
        for (size_t i = 1; i < begin_.size(); i++) begin_[i] += begin_[i - 1];
        for (size_t i = photons.size(); i-- > 0;) {
            photons_[--begin_[entry_of(cell_of(photons[i].p))]] = photons[i];
        }
    }

    size_t size() const { return photons_.size(); }
    float radius() const { return radius_; }
    std::span<const Photon> photons() const { return photons_; }

    /// Calls work(photon, v) for each photon nearer to p than the radius; v: from p to the photon.
    template <class Work>
    void for_each_near(Vec3 p, const Work& work) const {
        if (photons_.empty()) return;
        Cell low = cell_of(p - Vec3{radius_, radius_, radius_});
        for (uint64_t i = 0; i < 8; i++) {
            size_t entry = entry_of({low.x + (i & 1), low.y + (i >> 1 & 1), low.z + (i >> 2)});
            for (size_t j = begin_[entry]; j < begin_[entry + 1]; j++) {
                Vec3 v = photons_[j].p - p;
                if (dot(v, v) < radius_ * radius_) work(photons_[j], v);
            }
        }
    }

private:
    /// The integer coordinates of a cell, modulo 2^64.
    struct Cell {
        uint64_t x, y, z;
    };
    Cell cell_of(Vec3 p) const {
        // A little more than twice the radius, so that rounding loses no photon.
        double per_m = 1 / (2.001 * double{radius_});
        auto number = [&](float a) {
            double cell = std::clamp(std::floor(per_m * double{a}), -1e18, 1e18);
            return static_cast<uint64_t>(static_cast<int64_t>(cell));
        };
        return {number(p.x), number(p.y), number(p.z)};
    }
    /// The factors are 3 and 9 modulo 32. So 8 neighbours have 8 different entries, and no photon
    /// is found twice.
    size_t entry_of(Cell c) const {
        return (c.x + 73856099 * c.y + 83493257 * c.z) & (begin_.size() - 2);
    }

    float radius_ = 0;  // m
    std::vector<Photon> photons_;
    std::vector<uint32_t> begin_;  // of each entry, among the photons
};

/// The Epanechnikov kernel, the weight of a photon at distance d. Its average over the disk is 1.
inline float kernel(float d2_over_r2) { return 2 * (1 - d2_over_r2); }

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
        sampler.start(static_cast<uint32_t>(i), 0);
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
