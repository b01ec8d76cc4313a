// Chapter 05: a hierarchy of boxes. Ask a box before asking what is in it.
//
//   cost(node) = area(node) / area(root) * (inner: 1;  leaf: number of primitives)
//
// A ray that meets the root meets a box inside it with a chance in proportion to its area: the sum
// of cost over all nodes is the expected work of a ray, and what a good build keeps small.
#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "common/geometry/shapes.h"
#include "common/scene/scene.h"

namespace ch05 {

/// A box with sides along the axes; empty until something is added.
struct Box {
    Vec3 low = {infinity, infinity, infinity}, high = {-infinity, -infinity, -infinity};

    void add(Vec3 p) { low = min(low, p), high = max(high, p); }
    void add(const Box& b) { low = min(low, b.low), high = max(high, b.high); }
    Vec3 centre() const { return 0.5f * (low + high); }
    float area() const {
        Vec3 d = high - low;
        return d.x < 0 ? 0 : 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
    }
};

/// The box around one primitive.
inline Box box_of(const Geometry& g, uint32_t prim) {
    Box box;
    size_t i = prim;
    if (i < g.triangles.size()) {
        for (uint32_t v : g.triangles[i].v) box.add(g.positions[v]);
    } else if ((i -= g.triangles.size()) < g.spheres.size()) {
        const Sphere& s = g.spheres[i];
        box.add(s.c - Vec3{s.r, s.r, s.r}), box.add(s.c + Vec3{s.r, s.r, s.r});
    } else {
        const Disk& d = g.disks[i - g.spheres.size()];
        box.add(d.c - Vec3{d.r, d.r, d.r}), box.add(d.c + Vec3{d.r, d.r, d.r});
    }
    return box;
}

/// Where the ray enters the box, or infinity where it misses it.
///
///   in each axis the ray is between two planes for t in [near, far]; inside the box for all three
///
/// A ray in the plane of a side gives 0 * infinity = NaN: no comparison with it holds, so that the
/// side counts as touched. far is padded by its rounding error.      source  Kay, Kajiya 1986
inline float enter(const Box& box, const Ray& ray, Vec3 inv_d) {
    float t0 = 0, t1 = ray.t_max;
    for (int axis = 0; axis < 3; axis++) {
        bool down = std::signbit(inv_d[axis]);
        float near = ((down ? box.high : box.low)[axis] - ray.o[axis]) * inv_d[axis];
        float far = ((down ? box.low : box.high)[axis] - ray.o[axis]) * inv_d[axis] * 1.0000004f;
        if (near > t0) t0 = near;
        if (far < t1) t1 = far;
    }
    return t0 <= t1 ? t0 : infinity;
}

/// A node: the box around all below it. A leaf holds `count` primitives from `first` on; an inner
/// node (count 0) has its left child right behind it, and its right child at `first`.
struct Node {
    Box box;
    uint32_t first = 0, count = 0;
};
struct Hierarchy {
    std::vector<Node> nodes;
    std::vector<uint32_t> prims;
};

/// A primitive while the hierarchy is built.
struct Item {
    Box box;
    Vec3 centre;
    uint32_t prim;
};

/// How to part items [begin, end): orders them and returns where the right half begins; `begin`
/// for a leaf.
using Split = size_t (*)(std::vector<Item>& items, size_t begin, size_t end);

inline Box box_of_centres(const std::vector<Item>& items, size_t begin, size_t end) {
    Box box;
    for (size_t i = begin; i < end; i++) box.add(items[i].centre);
    return box;
}

/// Half of them to each side, by their place along the longest axis.
inline size_t split_median(std::vector<Item>& items, size_t begin, size_t end) {
    if (end - begin <= 4) return begin;
    Box centres = box_of_centres(items, begin, end);
    Vec3 d = centres.high - centres.low;
    int axis = d.x > d.y ? (d.x > d.z ? 0 : 2) : (d.y > d.z ? 1 : 2);
    size_t middle = (begin + end) / 2;
    auto at = [&](size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
                     [&](const Item& a, const Item& b) { return a.centre[axis] < b.centre[axis]; });
    return middle;
}

/// Where the surface area heuristic costs least, tried between 16 bins in each axis.
///
///   cost = 1 + (area_left n_left + area_right n_right) / area      leaf: n
///
/// source  MacDonald, Booth 1990; bins: Wald 2007
inline size_t split_sah(std::vector<Item>& items, size_t begin, size_t end) {
    constexpr size_t bins = 16;
    Box all, centres = box_of_centres(items, begin, end);
    for (size_t i = begin; i < end; i++) all.add(items[i].box);
    float best = static_cast<float>(end - begin);  // a leaf
    if (end - begin > 16) best = infinity;         // too many for one
    int best_axis = -1;
    size_t best_bin = 0;
    auto bin_of = [&](const Item& item, int axis) {
        float size = centres.high[axis] - centres.low[axis];
        float place = (item.centre[axis] - centres.low[axis]) / size;
        return std::min(static_cast<size_t>(place * bins), bins - 1);
    };
    for (int axis = 0; axis < 3; axis++) {
        if (!(centres.high[axis] > centres.low[axis])) continue;
        std::array<Box, bins> box;
        std::array<size_t, bins> n{};
        for (size_t i = begin; i < end; i++) {
            size_t b = bin_of(items[i], axis);
            box[b].add(items[i].box), n[b]++;
        }
        // Sweep from the right, then from the left.
        std::array<float, bins> right_cost{};
        Box side;
        size_t count = 0;
        for (size_t b = bins - 1; b > 0; b--) {
            side.add(box[b]), count += n[b];
            right_cost[b] = side.area() * static_cast<float>(count);
        }
        side = {}, count = 0;
        for (size_t b = 0; b + 1 < bins; b++) {
            side.add(box[b]), count += n[b];
            float cost = side.area() * static_cast<float>(count) + right_cost[b + 1];
            cost = 1 + cost / all.area();
            if (count > 0 && count < end - begin && cost < best) {
                best = cost, best_axis = axis, best_bin = b;
            }
        }
    }
    if (best_axis < 0) return end - begin > 16 ? (begin + end) / 2 : begin;
    auto at = [&](size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    auto middle = std::partition(
        at(begin), at(end), [&](const Item& item) { return bin_of(item, best_axis) <= best_bin; });
    return static_cast<size_t>(middle - items.begin());
}

/// Builds the nodes over items [begin, end), depth first.
inline void build_node(Hierarchy& h, std::vector<Item>& items, size_t begin, size_t end,
                       Split split) {
    size_t node = h.nodes.size();
    h.nodes.emplace_back();
    Box box;
    for (size_t i = begin; i < end; i++) box.add(items[i].box);
    h.nodes[node].box = box;
    size_t middle = split(items, begin, end);
    if (middle == begin) {
        h.nodes[node].first = static_cast<uint32_t>(begin);
        h.nodes[node].count = static_cast<uint32_t>(end - begin);
        return;
    }
    build_node(h, items, begin, middle, split);
    h.nodes[node].first = static_cast<uint32_t>(h.nodes.size());
    build_node(h, items, middle, end, split);
}

inline Hierarchy build(const Geometry& g, Split split) {
    std::vector<Item> items;
    for (uint32_t prim = 0; prim < g.size(); prim++) {
        Box box = box_of(g, prim);
        if (is_finite(box.low) && is_finite(box.high)) items.push_back({box, box.centre(), prim});
    }
    Hierarchy h;
    if (!items.empty()) build_node(h, items, 0, items.size(), split);
    for (const Item& item : items) h.prims.push_back(item.prim);
    return h;
}

/// Expected nodes and primitives that a ray through the root looks at.
inline double sah_cost(const Hierarchy& h) {
    double cost = 0;
    for (const Node& node : h.nodes) {
        double area = static_cast<double>(node.box.area() / h.nodes[0].box.area());
        cost += area * (node.count > 0 ? node.count : 1);
    }
    return cost;
}

/// How many boxes and primitives rays were tested against.
struct Work {
    uint64_t boxes = 0, prims = 0;
};

/// Tests one primitive, and keeps it if it is nearer, or as near with a lower number.
inline void test_prim(const Geometry& g, uint32_t prim, Ray ray, const Shear& shear,
                      PrimHit& best) {
    ray.t_max = std::nextafter(best.t, infinity);
    PrimHit hit{prim, infinity, 0, 0};
    size_t i = prim;
    if (i < g.triangles.size()) {
        const auto& v = g.triangles[i].v;
        auto found =
            intersect_triangle(ray, shear, g.positions[v[0]], g.positions[v[1]], g.positions[v[2]]);
        if (found) hit = {prim, found->t, found->b1, found->b2};
    } else if ((i -= g.triangles.size()) < g.spheres.size()) {
        hit.t = intersect_sphere(ray, g.spheres[i].c, g.spheres[i].r).value_or(infinity);
    } else {
        const Disk& d = g.disks[i - g.spheres.size()];
        hit.t = intersect_disk(ray, d.c, d.n, d.r).value_or(infinity);
    }
    bool tie = hit.t == best.t && best.prim != PrimHit::none;
    if (hit.t < best.t || (tie && prim < best.prim)) best = hit;
}

/// Finds the nearest hit. In order, the nearer child comes first, and a box that begins behind the
/// hit found so far is not opened; else all boxes that the ray meets are.
inline PrimHit traverse(const Hierarchy& h, const Geometry& g, Ray ray, bool in_order, Work& work) {
    PrimHit best;
    best.t = ray.t_max;
    Vec3 inv_d = {1 / ray.d.x, 1 / ray.d.y, 1 / ray.d.z};
    Shear shear = shear_to_ray(ray.d);
    std::vector<std::pair<uint32_t, float>> stack;
    if (!h.nodes.empty()) stack.emplace_back(0, enter(h.nodes[0].box, ray, inv_d));
    work.boxes++;
    while (!stack.empty()) {
        auto [index, t] = stack.back();
        stack.pop_back();
        if (t == infinity || (in_order && t > best.t)) continue;
        const Node& node = h.nodes[index];
        work.prims += node.count;
        for (uint32_t i = 0; i < node.count; i++) {
            test_prim(g, h.prims[node.first + i], ray, shear, best);
        }
        if (node.count > 0) continue;
        std::pair<uint32_t, float> left{index + 1, enter(h.nodes[index + 1].box, ray, inv_d)};
        std::pair<uint32_t, float> right{node.first, enter(h.nodes[node.first].box, ray, inv_d)};
        work.boxes += 2;
        if (in_order && left.second < right.second) std::swap(left, right);
        stack.push_back(left), stack.push_back(right);
    }
    return best.prim == PrimHit::none ? PrimHit{} : best;
}

/// The steps of the chapter, each faster than the one before.
enum class Step : uint8_t { linear, median, sah, ordered, wide };

/// What each step needs: a hierarchy (linear: none), or that of common/, whose nodes have as many
/// children as one instruction tests.
struct Finder {
    Step step;
    Hierarchy hierarchy;
    Bvh wide;
};

inline Finder make_finder(const Scene& scene, Step step) {
    Finder f{step, {}, {}};
    if (step == Step::median) f.hierarchy = build(scene.geometry, split_median);
    if (step == Step::sah || step == Step::ordered) f.hierarchy = build(scene.geometry, split_sah);
    if (step == Step::wide) f.wide = build_bvh(scene.geometry, 1);
    return f;
}

/// The same hit for every step, bit for bit.
inline PrimHit find(const Finder& f, const Geometry& g, const Ray& ray, Work& work) {
    switch (f.step) {
        case Step::linear: work.prims += g.size(); return linear_scan(g, ray);
        case Step::wide: {
            BvhCount count;
            PrimHit hit = closest_hit(f.wide, g, ray, count);
            work.boxes += count.nodes, work.prims += count.blocks;
            return hit;
        }
        default: return traverse(f.hierarchy, g, ray, f.step == Step::ordered, work);
    }
}

inline const std::vector<std::string> step_names = {"linear", "median", "sah", "ordered", "wide"};

inline size_t nodes_of(const Finder& f) { return f.hierarchy.nodes.size() + f.wide.nodes.size(); }

/// Boxes and primitives that one ray is tested against.
inline float work_of(const Finder& f, const Geometry& g, const Ray& ray) {
    Work work;
    find(f, g, ray, work);
    return static_cast<float>(work.boxes + work.prims);
}

}  // namespace ch05
