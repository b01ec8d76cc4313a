// Chapter 20, the form factors: which share of what leaves one patch arrives at another.
//
//   F_pq = 1 / A_p  integral over p, q of  V cos_p cos_q / (pi r^2)
//
// Kept is  G_pq = A_p F_pq = A_q F_qp,  m^2, which is the same from both ends.
#pragma once
#include <span>

#include "chapters/20_radiosity/patches.h"

namespace ch20 {

enum class FormFactors : uint8_t { point, chance, contour };

struct Double3 {
    double x, y, z;
};
inline Double3 between(Vec3 a, Vec3 b) {
    return {double{b.x} - double{a.x}, double{b.y} - double{a.y}, double{b.z} - double{a.z}};
}
inline double dot(Double3 a, Double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Double3 cross(Double3 a, Double3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The form factor from a point x with normal n to a polygon that nothing hides.
///
///   F = 1 / (2 pi)  sum over edges of  gamma n . (b x a) / |b x a|,   a, b: x to the edge's ends,
///   gamma: the angle between them
///
/// What lies below the horizon of x is cut off; 0 for a polygon seen from behind. In double: the
/// terms of a far polygon nearly cancel.
/// source  Lambert 1760; Hottel, Sarofim 1967      tested by  "truth: form factors by contour ..."
inline double point_to_polygon(Vec3 x, Vec3 n, std::span<const Vec3> polygon) {
    Double3 normal = between({}, n), above[8];
    size_t count = 0;
    for (size_t i = 0; i < polygon.size(); i++) {
        Double3 a = between(x, polygon[i]), b = between(x, polygon[(i + 1) % polygon.size()]);
        double da = dot(a, normal), db = dot(b, normal), s = da / (da - db);
        if (da >= 0) above[count++] = a;
        if ((da > 0 && db < 0) || (da < 0 && db > 0))
            above[count++] = {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z)};
    }
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        Double3 a = above[i], b = above[(i + 1) % count], c = cross(b, a);
        double size = std::sqrt(dot(c, c));
        if (size > 0) sum += std::atan2(size, dot(a, b)) * dot(normal, c) / size;
    }
    return std::max(0.0, sum / (2 * std::numbers::pi));
}

/// (a) As often shown: the whole integral by its value between the centres. Wrong where patches are
/// near each other for their size: of unit squares at distance 1 by 59 %.
inline double by_centres(const Patch& p, const Patch& q, Vec3 x, Vec3 y) {
    Vec3 d = y - x;
    double r2 = double{dot(d, d)}, cos = double{dot(d, p.n)} * double{-dot(d, q.n)};
    return double{p.area} * double{q.area} * cos / (std::numbers::pi * r2 * r2);
}

/// Each half as long as the one it came from.
inline std::array<std::array<Vec3, 3>, 4> quarters(const std::array<Vec3, 3>& t) {
    Vec3 a = (t[1] + t[2]) / 2, b = (t[2] + t[0]) / 2, c = (t[0] + t[1]) / 2;
    return {{{t[0], c, b}, {c, t[1], a}, {b, a, t[2]}, {a, b, c}}};
}

/// (c) The mean over triangle t, with normal n, of the form factor from its points to q.
///
/// Far for both sizes: from the centre. Nearer: from three points, which makes the mean of any
/// square polynomial right. Nearer still: from its quarters, and so on.
inline float longest_edge2(const std::array<Vec3, 3>& t) {
    return std::max(
        {length_squared(t[1] - t[0]), length_squared(t[2] - t[1]), length_squared(t[0] - t[2])});
}
inline double mean_to_polygon(const std::array<Vec3, 3>& t, Vec3 n, const Patch& q, int depth) {
    Vec3 centre = (t[0] + t[1] + t[2]) / 3;
    float size2 = longest_edge2(t) + longest_edge2(q.p), d2 = length_squared(centre - q.centre);
    if (d2 > 36 * size2) return point_to_polygon(centre, n, q.p);
    double sum = 0;
    if (depth == 0 || d2 > 2 * size2) {
        for (Vec3 p : t) sum += point_to_polygon((centre + p) / 2, n, q.p);
        return sum / 3;
    }
    for (const auto& part : quarters(t)) sum += mean_to_polygon(part, n, q, depth - 1);
    return sum / 4;
}

/// A point of each quarter of the patch, chosen by chance, just off the surface.
inline std::array<Vec3, 4> points_on(const Patch& p, uint32_t key) {
    std::array<Vec3, 4> points;
    auto parts = quarters(p.p);
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t bits = hash32(key + i);
        float s = std::sqrt(to_unit_float(bits)), v = to_unit_float(hash32(bits));
        const auto& t = parts[i];
        points[i] = (1 - s) * t[0] + s * (1 - v) * t[1] + s * v * t[2] + p.eps * p.n;
    }
    return points;
}
inline bool sees(const Scene& scene, Vec3 x, Vec3 y) { return !occluded(scene, {x, y - x, 1}); }

/// Whether some of q lies before p.
inline bool faces(const Patch& p, const Patch& q) {
    for (Vec3 y : q.p)
        if (dot(y - p.centre, p.n) > 2 * (p.eps + q.eps)) return true;
    return false;
}

/// G_pq as found from p, and from q. Nearly the same: the repair takes their mean.
struct Exchange {
    double from_p = 0, from_q = 0;
};

/// How much two patches exchange. key: of the random numbers, the same for (p, q) and (q, p).
inline Exchange exchange(const Scene& scene, const Patch& p, const Patch& q, FormFactors way,
                         uint32_t key) {
    if (!faces(p, q) || !faces(q, p)) return {};
    if (way == FormFactors::point) {
        double G = std::max(0.0, by_centres(p, q, p.centre, q.centre));
        if (!sees(scene, p.centre + p.eps * p.n, q.centre + q.eps * q.n)) return {};
        return {G, G};
    }
    auto x = points_on(p, key), y = points_on(q, hash32(key) + 4);
    size_t shift = hash32(key + 9) % 4;  // each quarter of p with any of q
    if (way == FormFactors::chance) {
        double sum = 0;
        for (size_t i = 0; i < 4; i++) {
            Vec3 z = y[(i + shift) % 4];
            double G = by_centres(p, q, x[i], z);
            if (G > 0 && sees(scene, x[i], z)) sum += G / 4;
        }
        return {sum, sum};
    }
    double visible = 0;
    for (size_t i = 0; i < 4; i++) {
        if (sees(scene, x[i], y[(i + shift) % 4])) visible += 0.25;
    }
    if (visible == 0) return {};
    constexpr int deepest = 4;
    return {visible * double{p.area} * mean_to_polygon(p.p, p.n, q, deepest),
            visible * double{q.area} * mean_to_polygon(q.p, q.n, p, deepest)};
}

/// What is wrong with the form factors before they are repaired.
struct Faults {
    double lowest = 1e300, highest = 0;  // of the sums of rows
    double apart = 0, all = 0;           // sums of |from_p - from_q|, and of their means
};

/// Rows of G, worked out when they are asked for, and kept if there is room for all.
class Rows {
public:
    static constexpr size_t most_kept = size_t{1} << 30;  // bytes

    Rows(const Scene& scene, const Patches& patches, FormFactors way, uint32_t seed, int threads)
        : scene_(scene), patch_(patches.patch), way_(way), seed_(seed), threads_(threads) {
        if (bytes() <= most_kept) kept_.resize(patch_.size());
    }
    size_t bytes() const { return patch_.size() * patch_.size() * sizeof(float); }
    bool keeps() const { return !kept_.empty(); }
    const Faults& faults() const { return faults_; }
    std::vector<std::vector<float>> take_all() { return std::move(kept_); }

    /// What patch p exchanges with each patch; valid until the next call.
    std::span<const float> row(size_t p) {
        if (!keeps()) return last_ = work_out(p);
        if (kept_[p].empty()) kept_[p] = work_out(p);
        return kept_[p];
    }

private:
    std::vector<float> work_out(size_t p) {
        constexpr size_t block = 256;
        size_t n = patch_.size(), blocks = (n + block - 1) / block;
        std::vector<float> row(n);
        std::vector<Faults> parts(blocks);
        parallel_for(static_cast<int>(blocks), threads_, [&](int b) {
            size_t first = static_cast<size_t>(b) * block;
            for (size_t q = first; q < std::min(n, first + block); q++) {
                if (keeps() && !kept_[q].empty()) {
                    row[q] = kept_[q][p];
                } else if (q != p) {
                    row[q] = work_out(std::min(p, q), std::max(p, q), parts[first / block]);
                }
            }
        });
        double sum = 0;
        for (const Faults& part : parts) faults_.apart += part.apart, faults_.all += part.all;
        for (float G : row) sum += double{G} / double{patch_[p].area};
        faults_.lowest = std::min(faults_.lowest, sum);
        faults_.highest = std::max(faults_.highest, sum);
        return row;
    }
    float work_out(size_t p, size_t q, Faults& faults) const {
        uint32_t key = hash32(static_cast<uint32_t>(p), hash32(static_cast<uint32_t>(q), seed_));
        Exchange G = exchange(scene_, patch_[p], patch_[q], way_, key);
        faults.apart += std::abs(G.from_p - G.from_q);
        faults.all += (G.from_p + G.from_q) / 2;
        return static_cast<float>((G.from_p + G.from_q) / 2);
    }

    const Scene& scene_;
    const std::vector<Patch>& patch_;
    FormFactors way_;
    uint32_t seed_;
    int threads_;
    std::vector<std::vector<float>> kept_;
    std::vector<float> last_;
    Faults faults_;
};

}  // namespace ch20
