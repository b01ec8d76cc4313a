#include <algorithm>
#include <cmath>
#include <set>

#include "common/base/files.h"
#include "common/material/basic_bsdf.h"
#include "common/scene/mover.h"
#include "common/scene/origin.h"
#include "common/scene/prepare.h"

namespace {

using Polygon = std::vector<Vec3d>;

/// The corners of a triangle, or of 16 points around a disk; a sphere has none.
Polygon corners_of(const Geometry& g, uint32_t prim) {
    return visit(
        g, prim,
        [&](const Triangle& t) {
            return Polygon{Vec3d(g.positions[t.v[0]]), Vec3d(g.positions[t.v[1]]),
                           Vec3d(g.positions[t.v[2]])};
        },
        [](const Sphere&) { return Polygon{}; },
        [](const Disk& disk) {
            Polygon corners;
            for (int i = 0; i < 16; i++) {
                Vec3 out = from_cylindrical(disk.r, static_cast<float>(i) / 16, 0);
                corners.push_back(Vec3d(disk.c + Frame(disk.n).to_world(out)));
            }
            return corners;
        });
}

/// Twice the area of a flat polygon, along its normal.
Vec3d area_of(const Polygon& p) {
    Vec3d sum;
    for (size_t i = 2; i < p.size(); i++) sum = sum + cross(p[i - 1] - p[0], p[i] - p[0]);
    return sum;
}

/// The part of polygon a that lies straight above or below b; n: the normal of b.
/// source  Sutherland, Hodgman 1974
Polygon clip(Polygon a, const Polygon& b, Vec3d n) {
    for (size_t k = 0; k < b.size(); k++) {
        Vec3d inward = cross(n, b[(k + 1) % b.size()] - b[k]);
        Polygon kept;
        for (size_t i = 0; i < a.size(); i++) {
            Vec3d p = a[i], q = a[(i + 1) % a.size()];
            double at_p = dot(p - b[k], inward), at_q = dot(q - b[k], inward);
            if (at_p >= 0) kept.push_back(p);
            if ((at_p >= 0) != (at_q >= 0)) kept.push_back(p + at_p / (at_p - at_q) * (q - p));
        }
        a = kept;
    }
    return a;
}

/// Whether two faces lie in one plane, up to rounding, and overlap by a thousandth of the smaller.
bool overlap(const Polygon& a, const Polygon& b, double rounding) {
    Vec3d area = area_of(b), n = normalize(area);
    auto side = [&](Vec3d p) {
        double off = dot(p - b[0], n);
        return (off > rounding) - (off < -rounding);
    };
    auto is_in_plane = [&](Vec3d p) { return side(p) == 0; };
    if (std::abs(side(a[0]) + side(a[1]) + side(a[2])) == 3) return false;
    Polygon both = clip(a, b, n);
    return std::all_of(both.begin(), both.end(), is_in_plane) &&
           length(area_of(both)) > 1e-3 * std::min(length(area), length(area_of(a)));
}

/// How far two surfaces in this box may be apart by rounding alone.
float rounding_of(const Box& box) {
    return 2 * rounding_error(max_component(max(abs(box.low), abs(box.high))));
}

/// Whether two primitives lie in one place, in part or as a whole.
bool coincide(const Geometry& g, uint32_t a, uint32_t b) {
    Box box = box_of(g, a);
    double rounding = double{rounding_of(box)};
    Polygon p = corners_of(g, a), q = corners_of(g, b);
    if (!p.empty() && !q.empty()) return overlap(p, q, rounding);
    Box other = box_of(g, b);
    return p.empty() && q.empty() && length(Vec3d(box.low) - Vec3d(other.low)) < rounding &&
           length(Vec3d(box.high) - Vec3d(other.high)) < rounding;
}

}  // namespace

std::vector<std::string> notes_of_coincident(const Scene& scene) {
    const Geometry& g = scene.geometry;
    auto shape_of = [&](uint32_t prim) {
        auto number = [](const auto& primitive) { return primitive.shape; };
        return visit(g, prim, number, number, number);
    };
    // Pairs of shapes: first a lamp, if there is one, else what comes later.
    std::set<std::pair<uint32_t, uint32_t>> pairs;
    auto compare = [&](uint32_t a, uint32_t b) {
        uint32_t one = shape_of(a), other = shape_of(b);
        auto worth = [&](uint32_t i) { return std::pair(scene.shapes[i].light >= 0, i); };
        if (worth(one) < worth(other)) std::swap(one, other);
        if (!pairs.contains({one, other}) && coincide(g, a, b)) pairs.emplace(one, other);
    };

    // Faces that shine, and all whose boxes touch theirs.
    std::vector<Box> boxes;
    for (uint32_t i = 0; i < g.size(); i++) boxes.push_back(box_of(g, i));
    constexpr uint64_t most = 30'000'000;
    uint64_t compared = 0;
    for (const Light& light : scene.lights) {
        uint32_t end = light.first_prim + light.prims;
        for (uint32_t a = light.first_prim; a < end && compared < most; a++, compared += g.size()) {
            float rounding = rounding_of(boxes[a]);
            for (uint32_t b = 0; b < g.size(); b++) {
                bool later = b > a || scene.shapes[shape_of(b)].light < 0;  // each pair once
                Vec3 gap = max(boxes[a].low - boxes[b].high, boxes[b].low - boxes[a].high);
                if (max_component(gap) <= rounding && later && b != a) compare(a, b);
            }
        }
    }

    // Faces that are given twice: they have one box. So have the two triangles of a rectangle.
    std::vector<std::pair<uint64_t, uint32_t>> sums;
    for (uint32_t i = 0; i < g.size() && scene.shapes.size() > 1; i++) {
        Vec3 ends[] = {boxes[i].low + Vec3{}, boxes[i].high + Vec3{}};  // 0 in place of -0
        Checksum sum;
        sum.add({reinterpret_cast<const char*>(ends), sizeof ends});
        sums.emplace_back(sum.value(), i);
    }
    std::sort(sums.begin(), sums.end());
    for (size_t i = 0; i < sums.size(); i++) {
        for (size_t k = i + 1; k < std::min(i + 9, sums.size()); k++) {
            uint32_t a = sums[i].second, b = sums[k].second;
            if (sums[i].first != sums[k].first) break;
            if (shape_of(a) != shape_of(b)) compare(a, b);
        }
    }

    std::vector<std::string> notes;
    for (auto [one, other] : pairs) {
        auto name = [&](uint32_t i) {
            return std::string(scene.shapes[i].light >= 0 ? "lamp" : "Shape");
        };
        Position at = scene.place(scene.shapes[one].at);
        std::string there = place_text(scene.place(scene.shapes[other].at));
        std::string faces = "this " + name(one) + " and the " + name(other) + " at " + there;
        if (there == place_text(at)) faces = "faces of this " + name(one);
        std::string note = message_at(
            at, "note",
            faces + " lie in one place, where rounding decides which of them a ray meets");
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
        if (notes.size() == 20) break;
    }
    return notes;
}
