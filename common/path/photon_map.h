// The photons of a pass, and a hash grid that finds those near to a point.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "common/material/hit.h"

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
