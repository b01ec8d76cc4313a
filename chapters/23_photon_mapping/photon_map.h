// Chapter 23: the photons that light has left on surfaces, and those of them that are nearest to a
// point.
#pragma once
#include <algorithm>
#include <cstring>
#include <vector>

#include "common/base/parallel.h"
#include "common/geometry/geometry.h"

namespace ch23 {

/// Light that arrived at a diffuse surface.
struct Arrival {
    Rgb flux;         // W
    uint16_t normal;  // of the surface, on the side where light arrived; see to_bits()
    uint16_t depth;   // scattering events on its path, the one at p included
};
struct Photon {
    Vec3 p;  // m
    Arrival light;
    uint32_t vertex = 0;  // its number among the vertices of all paths
};
static_assert(sizeof(Photon) == 32);

/// A normal in 16 bits, off by less than a degree: the octahedron |x| + |y| + |z| = 1 unfolded to a
/// square of 256 x 256 cells. from_bits() gives a point of the octahedron, not of length 1.
///
/// source  Cigolle et al. 2014      tested by  "identity: a photon keeps its normal"
inline uint16_t to_bits(Vec3 n) {
    float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    float x = n.x / sum, y = n.y / sum;
    if (n.z < 0) {  // the lower half is folded outwards
        float folded = std::copysign(1 - std::abs(y), x);
        y = std::copysign(1 - std::abs(x), y), x = folded;
    }
    auto cell = [](float a) { return static_cast<int>(std::clamp(128 * (a + 1), 0.0f, 255.0f)); };
    return static_cast<uint16_t>(256 * cell(x) + cell(y));
}
inline Vec3 from_bits(uint16_t bits) {
    auto middle = [](int cell) { return (static_cast<float>(cell) + 0.5f) / 128 - 1; };
    float x = middle(bits / 256), y = middle(bits % 256), z = 1 - std::abs(x) - std::abs(y);
    if (z < 0) {
        float folded = std::copysign(1 - std::abs(y), x);
        y = std::copysign(1 - std::abs(x), y), x = folded;
    }
    return {x, y, z};
}

/// Photons as a k-d tree: a plane through the middle one, across the axis along which they vary
/// most, parts them in two halves, and those again, down to leaves of 16.
///
/// No pointers: leaves first .. last-1 have one plane, and that has the number of the leaf in their
/// middle. The places of a leaf's photons stand apart from the rest, so that all are tested at
/// once. source  Bentley 1975; Jensen 1996      tested by  "brute: photons near a point"
class PhotonMap {
public:
    PhotonMap() = default;
    PhotonMap(std::vector<Photon> photons, int threads)
        : size_(photons.size()), planes_((size_ + leaf - 1) / leaf), places_(planes_.size()) {
        build(photons, 0, planes_.size(), threads);
        arrivals_.reserve(size_), vertices_.reserve(size_);
        for (size_t i = 0; i < size_; i++) {
            Places& to = places_[i / leaf];
            Vec3 p = photons[i].p;
            to.x[i % leaf] = p.x, to.y[i % leaf] = p.y, to.z[i % leaf] = p.z;
            arrivals_.push_back(photons[i].light);
            vertices_.push_back(photons[i].vertex);
        }
    }

    size_t size() const { return size_; }
    size_t bytes() const {
        return planes_.size() * (sizeof(Plane) + sizeof(Places)) +
               size_ * (sizeof(Arrival) + sizeof(uint32_t));
    }

    /// The number of a photon of this map among the vertices of all paths.
    size_t vertex_of(const Arrival& photon) const {
        return vertices_[static_cast<size_t>(&photon - arrivals_.data())];
    }

    /// Calls work(arrival, v) for each photon nearer to p than r; v: from p to the photon.
    template <class Work>
    void for_each_near(Vec3 p, float r, const Work& work) const {
        if (size() > 0) visit(p, r * r, 0, planes_.size(), work);
    }

    /// Just less than the distance of the k-th nearest photon, if that is below r; else r. k > 0.
    float kth_distance(Vec3 p, size_t k, float r) const;

    /// kth_distance() for the middle of each leaf, and where to look it up for a point.
    std::vector<float> kth_distances(size_t k, float r, int threads) const;
    size_t leaf_at(Vec3 p) const;

private:
    static constexpr size_t leaf = 16;
    struct Plane {
        float at = 0;
        int axis = 0;
    };

    struct Places {
        float x[leaf], y[leaf], z[leaf];
        Places() { std::fill_n(x, leaf, infinity); }  // where the last leaf has no photon
    };

    /// The order of photons along an axis. Equal places are told apart by whatever else there is,
    /// so that the order, and that of sums, is the same with every library.
    struct Before {
        int axis;
        bool operator()(const Photon& a, const Photon& b) const {
            if (a.p[axis] != b.p[axis]) return a.p[axis] < b.p[axis];
            return std::memcmp(&a, &b, sizeof a) < 0;
        }
    };

    size_t end_of(size_t leaf_number) const { return std::min(leaf_number * leaf, size_); }
    Vec3 place(size_t i) const {
        const Places& of = places_[i / leaf];
        return {of.x[i % leaf], of.y[i % leaf], of.z[i % leaf]};
    }
    Box box_of_leaf(size_t number) const {
        Box box;
        for (size_t i = number * leaf; i < end_of(number + 1); i++) {
            box = {min(box.low, place(i)), max(box.high, place(i))};
        }
        return box;
    }

    /// The axis along which photons vary most. Not the longest side of the box around them: where
    /// that holds a floor and a few photons of a wall, the middle photon's height parts nothing.
    static int widest_axis(const Photon* photons, size_t n) {
        double sum[3] = {}, squares[3] = {}, variance[3];
        for (size_t i = 0; i < n; i++) {
            for (int k = 0; k < 3; k++) {
                double x = double{photons[i].p[k]};
                sum[k] += x, squares[k] += x * x;
            }
        }
        for (int k = 0; k < 3; k++)
            variance[k] = squares[k] - sum[k] * sum[k] / static_cast<double>(n);
        return static_cast<int>(std::max_element(variance, variance + 3) - variance);
    }

    void build(std::vector<Photon>& photons, size_t first, size_t last, int threads) {
        auto at = [&](size_t i) { return photons.begin() + static_cast<std::ptrdiff_t>(i); };
        if (last - first < 2) {
            std::sort(at(first * leaf), at(end_of(last)), Before{0});
            return;
        }
        int axis = widest_axis(&photons[first * leaf], end_of(last) - first * leaf);
        size_t middle = (first + last) / 2;
        std::nth_element(at(first * leaf), at(middle * leaf), at(end_of(last)), Before{axis});
        planes_[middle] = {photons[middle * leaf].p[axis], axis};
        parallel_for(2, threads, [&](int half) {
            if (half == 0) build(photons, first, middle, threads / 2);
            if (half == 1) build(photons, middle, last, threads / 2);
        });
    }

    template <class Work>
    void visit(Vec3 p, float r2, size_t first, size_t last, const Work& work) const {
        if (last - first > 1) {
            size_t middle = (first + last) / 2;
            float d = p[planes_[middle].axis] - planes_[middle].at;
            bool low = d < 0;
            if (low || d * d < r2) visit(p, r2, first, middle, work);
            if (!low || d * d < r2) visit(p, r2, middle, last, work);
            return;
        }
        const Places& at = places_[first];
        float d2[leaf];
        for (size_t i = 0; i < leaf; i++) {
            float x = at.x[i] - p.x, y = at.y[i] - p.y, z = at.z[i] - p.z;
            d2[i] = x * x + y * y + z * z;
        }
        size_t near[leaf], count = 0;
        for (size_t i = 0; i < leaf; i++) near[count] = i, count += d2[i] < r2;
        for (size_t j = 0; j < count; j++) {
            size_t i = first * leaf + near[j];
            work(arrivals_[i], place(i) - p);
        }
    }

    size_t size_ = 0;
    std::vector<Plane> planes_;
    std::vector<Places> places_;
    std::vector<Arrival> arrivals_;
    std::vector<uint32_t> vertices_;  // apart, as only those who ask for a photon's path need them
};

/// Searches a sphere that is to hold twice k photons, going by the half of the leaf around p that
/// is nearest to p; and a larger one where it holds less than k.
inline float PhotonMap::kth_distance(Vec3 p, size_t k, float r) const {
    if (size() < k) return r;
    auto kth_of = [](std::vector<float>& d2, size_t number) {
        auto at = d2.begin() + static_cast<std::ptrdiff_t>(number) - 1;
        std::nth_element(d2.begin(), at, d2.end());
        return *at;
    };
    static thread_local std::vector<float> found;  // squares of distances
    found.clear();
    size_t number = leaf_at(p);
    for (size_t i = number * leaf; i < end_of(number + 1); i++) {
        found.push_back(length_squared(place(i) - p));
    }
    float half = static_cast<float>(found.size() + 1) / 2;
    float guess = kth_of(found, static_cast<size_t>(half)) * 2 * static_cast<float>(k) / half;
    for (guess = std::sqrt(guess);; guess *= 1.5f) {
        float searched = guess > 0 ? std::min(guess, r) : r;
        found.clear();
        for_each_near(p, searched, [&](const Arrival&, Vec3 v) { found.push_back(dot(v, v)); });
        if (found.size() >= k) return std::nextafter(std::sqrt(kth_of(found, k)), 0.0f);
        if (searched == r) return r;
    }
}

inline std::vector<float> PhotonMap::kth_distances(size_t k, float r, int threads) const {
    constexpr int at_once = 256;  // leaves
    std::vector<float> distances(planes_.size());
    int leaves = static_cast<int>(distances.size());
    parallel_for((leaves + at_once - 1) / at_once, threads, [&](int part) {
        for (int i = part * at_once; i < std::min((part + 1) * at_once, leaves); i++) {
            size_t number = static_cast<size_t>(i);
            Box box = box_of_leaf(number);
            distances[number] = kth_distance(0.5f * (box.low + box.high), k, r);
        }
    });
    return distances;
}

inline size_t PhotonMap::leaf_at(Vec3 p) const {
    size_t first = 0, last = planes_.size();
    while (last - first > 1) {
        size_t middle = (first + last) / 2;
        (p[planes_[middle].axis] < planes_[middle].at ? last : first) = middle;
    }
    return first;
}

}  // namespace ch23
