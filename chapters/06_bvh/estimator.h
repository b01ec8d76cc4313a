// Chapter 06: a hierarchy of boxes. A ray that misses a box misses everything inside it.
//
//   cost(node) = area(node) / area(root) * (inner: 1;  leaf: number of primitives)
//
// A ray that meets the root meets a box inside it with a probability proportional to the box's
// area. So the sum of cost over all nodes is the expected work of a ray: a good tree has a low sum.
#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/shapes.h"
#include "common/scene/scene.h"

namespace ch06 {

/// Where the ray enters the box, or infinity where it misses it.
///
///   in each axis the ray is between two planes for t in [near, far]; inside the box for all three
///
/// A ray in the plane of a side gives 0 * infinity = NaN. Comparisons with NaN are false, so the
/// side counts as touched. near and far are rounded, and so are hits of triangles. So near is made
/// a bit smaller and far a bit larger: no ray misses what lies on the side of a box.
/// source  Kay, Kajiya 1986      tested by  "brute: no step loses a ray", hits exactly
inline float enter(const Box& box, const Ray& ray, Vec3 inv_d) {
    float t0 = 0, t1 = ray.t_max;
    for (int axis = 0; axis < 3; axis++) {
        float near = (box.low[axis] - ray.o[axis]) * inv_d[axis];
        float far = (box.high[axis] - ray.o[axis]) * inv_d[axis];
        if (inv_d[axis] < 0) std::swap(near, far);
        near *= 0.9999f, far *= 1.0000004f;
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

/// How to split items [begin, end): orders them and returns where the right part begins; `begin`
/// for a leaf.
using Split = size_t (*)(std::vector<Item>& items, size_t begin, size_t end);

inline Box box_of_centres(const std::vector<Item>& items, size_t begin, size_t end) {
    Box box;
    for (size_t i = begin; i < end; i++) box.add(items[i].centre);
    return box;
}

/// Half of the items on each side, by the position of their centres on the longest axis.
inline size_t split_median(std::vector<Item>& items, size_t begin, size_t end) {
    if (end - begin <= 4) return begin;
    Box centres = box_of_centres(items, begin, end);
    Vec3 d = centres.high - centres.low;
    int axis = d.x > d.y ? (d.x > d.z ? 0 : 2) : (d.y > d.z ? 1 : 2);
    size_t middle = (begin + end) / 2;
    auto at = [&](size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    // Of centres at one place, the primitive with the lower number is on the left.
    std::nth_element(at(begin), at(middle), at(end), [&](const Item& a, const Item& b) {
        return std::pair(a.centre[axis], a.prim) < std::pair(b.centre[axis], b.prim);
    });
    return middle;
}

constexpr size_t bins = 16;

/// The bin along the axis into which the item's centre falls.
inline size_t bin_of(const Item& item, const Box& centres, int axis) {
    float size = centres.high[axis] - centres.low[axis];
    float place = (item.centre[axis] - centres.low[axis]) / size;
    return std::min(static_cast<size_t>(place * bins), bins - 1);
}

/// A way to split items: those in a bin up to `bin` go to the left. axis -1: no split.
struct Cut {
    float cost = infinity;
    int axis = -1;
    size_t bin = 0;
};

/// The cheapest cut between two bins of one axis.
///
///   cost = 1 + (area_left n_left + area_right n_right) / area      area: of the box around all
///
/// source  MacDonald, Booth 1990; bins: Wald 2007
inline Cut best_cut(const std::vector<Item>& items, size_t begin, size_t end, float area,
                    const Box& centres, int axis) {
    std::array<Box, bins> box;
    std::array<size_t, bins> n{};
    for (size_t i = begin; i < end; i++) {
        size_t b = bin_of(items[i], centres, axis);
        box[b].add(items[i].box);
        n[b]++;
    }

    // Sweep from the right: the cost of all bins from b on.
    std::array<float, bins> right_cost{};
    Box right;
    size_t n_right = 0;
    for (size_t b = bins - 1; b > 0; b--) {
        right.add(box[b]);
        n_right += n[b];
        right_cost[b] = right.area() * static_cast<float>(n_right);
    }

    // Sweep from the left, and keep the cheapest cut.
    Cut best;
    Box left;
    size_t n_left = 0;
    for (size_t b = 0; b + 1 < bins; b++) {
        left.add(box[b]);
        n_left += n[b];
        float cost = 1 + (left.area() * static_cast<float>(n_left) + right_cost[b + 1]) / area;
        bool parts = n_left > 0 && n_left < end - begin;
        if (parts && cost < best.cost) best = {cost, axis, b};
    }
    return best;
}

/// The cheapest cut by the surface area heuristic, between 16 bins on each axis. A leaf costs one
/// test for each of its items.
inline size_t split_sah(std::vector<Item>& items, size_t begin, size_t end) {
    constexpr size_t largest_leaf = 16;
    bool may_be_leaf = end - begin <= largest_leaf;
    Box all, centres = box_of_centres(items, begin, end);
    for (size_t i = begin; i < end; i++) all.add(items[i].box);

    Cut best;
    if (may_be_leaf) best.cost = static_cast<float>(end - begin);
    for (int axis = 0; axis < 3; axis++) {
        if (!(centres.high[axis] > centres.low[axis])) continue;
        Cut cut = best_cut(items, begin, end, all.area(), centres, axis);
        if (cut.cost < best.cost) best = cut;
    }
    if (best.axis < 0) return may_be_leaf ? begin : (begin + end) / 2;

    auto at = [&](size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    auto goes_left = [&](const Item& item) { return bin_of(item, centres, best.axis) <= best.bin; };
    auto middle = std::partition(at(begin), at(end), goes_left);
    return static_cast<size_t>(middle - items.begin());
}

/// Builds the nodes over items [begin, end), depth first.
inline void build_node(Hierarchy& h, std::vector<Item>& items, size_t begin, size_t end,
                       Split split) {
    size_t node = h.nodes.size();
    h.nodes.emplace_back();
    for (size_t i = begin; i < end; i++) h.nodes[node].box.add(items[i].box);
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

/// Expected number of nodes and primitives that a ray through the root is tested against.
inline double sah_cost(const Hierarchy& h) {
    double cost = 0;
    for (const Node& node : h.nodes) {
        double area = static_cast<double>(node.box.area() / h.nodes[0].box.area());
        cost += area * (node.count > 0 ? node.count : 1);
    }
    return cost;
}

/// How many nodes rays opened, and how many boxes and primitives they were tested against.
struct Work {
    uint64_t nodes = 0, boxes = 0, prims = 0;
};

/// A ray on its way through a hierarchy, with what it has found so far.
struct Walk {
    const Geometry& geometry;
    Ray ray;
    Vec3 inv_d;
    Shear shear;
    PrimHit best;
    Work& work;

    Walk(const Geometry& g, const Ray& r, Work& w)
        : geometry(g),
          ray(r),
          inv_d{1 / r.d.x, 1 / r.d.y, 1 / r.d.z},
          shear(shear_to_ray(r.d)),
          best{PrimHit::none, r.t_max},
          work(w) {}

    /// Where the ray enters the box; infinity: nowhere.
    float ask(const Box& box) {
        work.boxes++;
        return enter(box, ray, inv_d);
    }
    /// Tests one primitive, and keeps it if it is nearer, or as near with a lower number.
    void test(uint32_t prim) {
        work.prims++;
        const Geometry& g = geometry;
        Ray up_to = ray;
        up_to.t_max = std::nextafter(best.t, infinity);  // so that an equal t is found, too
        PrimHit hit{prim, infinity};
        visit(
            g, prim,
            [&](const Triangle& triangle) {
                auto [v0, v1, v2] = triangle.v;
                auto found = intersect_triangle(up_to, shear, g.positions[v0], g.positions[v1],
                                                g.positions[v2]);
                if (found) hit = {prim, found->t, found->b1, found->b2};
            },
            [&](const Sphere& sphere) {
                hit.t = intersect_sphere(up_to, sphere.c, sphere.r).value_or(infinity);
            },
            [&](const Disk& disk) {
                hit.t = intersect_disk(up_to, disk.c, disk.n, disk.r).value_or(infinity);
            });
        bool tie = hit.t == best.t && best.prim != PrimHit::none;
        if (hit.t < best.t || (tie && prim < best.prim)) best = hit;
    }
    /// Tests the primitives of a leaf.
    void test_all(const std::vector<uint32_t>& prims, const Node& leaf) {
        for (uint32_t i = 0; i < leaf.count; i++) test(prims[leaf.first + i]);
    }
    PrimHit found() const { return best.prim == PrimHit::none ? PrimHit{} : best; }
};

/// Finds the nearest hit. in_order: the nearer child comes first, and a box that begins behind the
/// nearest hit so far is not opened. Otherwise all boxes that the ray meets are opened.
inline PrimHit traverse(const Hierarchy& h, const Geometry& g, const Ray& ray, bool in_order,
                        Work& work) {
    struct Waiting {
        uint32_t node;
        float t;  // where the ray enters it
    };
    Walk walk(g, ray, work);
    std::vector<Waiting> stack;
    if (!h.nodes.empty()) stack.push_back({0, walk.ask(h.nodes[0].box)});
    while (!stack.empty()) {
        auto [index, t] = stack.back();
        stack.pop_back();
        if (t == infinity || (in_order && t > walk.best.t)) continue;
        const Node& node = h.nodes[index];
        if (node.count > 0) {
            walk.test_all(h.prims, node);
            continue;
        }
        // Put both children on the stack, the nearer one on top.
        work.nodes++;
        Waiting left{index + 1, walk.ask(h.nodes[index + 1].box)};
        Waiting right{node.first, walk.ask(h.nodes[node.first].box)};
        if (in_order && left.t < right.t) std::swap(left, right);
        stack.push_back(left);
        stack.push_back(right);
    }
    return walk.found();
}

/// A node of up to four children, each stored as a Node. `first` of an inner child is its index in
/// FourHierarchy::nodes.
struct FourNode {
    std::array<Node, 4> child;
    size_t size = 0;
};
struct FourHierarchy {
    std::vector<FourNode> nodes;
    std::vector<uint32_t> prims;
};

/// Makes a node of four from a node of two: while there is room, the largest inner child is
/// replaced by its own two children. Returns the number of the new node.
///
/// source  Dammertz, Hanika, Keller 2008; Wald, Benthin, Boulos 2008
inline uint32_t collapse(const Hierarchy& h, uint32_t root, FourHierarchy& four) {
    std::vector<uint32_t> below = {root};
    while (below.size() < 4) {
        // Open the inner node that a ray meets with the highest probability: the largest one.
        auto worth = [&](uint32_t i) { return h.nodes[i].count > 0 ? -1 : h.nodes[i].box.area(); };
        auto largest = std::max_element(below.begin(), below.end(), [&](uint32_t a, uint32_t b) {
            return worth(a) < worth(b);
        });
        uint32_t opened = *largest;
        if (h.nodes[opened].count > 0) break;  // only leaves are left
        *largest = opened + 1;
        below.push_back(h.nodes[opened].first);
    }
    auto place = static_cast<uint32_t>(four.nodes.size());
    four.nodes.emplace_back();
    four.nodes[place].size = below.size();
    for (size_t i = 0; i < below.size(); i++) {
        Node child = h.nodes[below[i]];
        if (child.count == 0) child.first = collapse(h, below[i], four);
        four.nodes[place].child[i] = child;
    }
    return place;
}

inline FourHierarchy collapse(const Hierarchy& h) {
    FourHierarchy four{{}, h.prims};
    if (!h.nodes.empty()) collapse(h, 0, four);
    return four;
}

/// Finds the nearest hit: tests the boxes of four children, and continues with the nearest child.
inline PrimHit traverse_four(const FourHierarchy& h, const Geometry& g, const Ray& ray,
                             Work& work) {
    struct Waiting {
        const Node* node;
        float t;
    };
    Walk walk(g, ray, work);
    std::vector<Waiting> stack;
    Node root;
    if (!h.nodes.empty()) stack.push_back({&root, 0});
    while (!stack.empty()) {
        auto [node, t] = stack.back();
        stack.pop_back();
        if (t > walk.best.t) continue;
        if (node->count > 0) {
            walk.test_all(h.prims, *node);
            continue;
        }
        // Put the children that the ray meets on the stack, from far to near.
        work.nodes++;
        size_t bottom = stack.size();
        const FourNode& four = h.nodes[node->first];
        for (size_t i = 0; i < four.size; i++) {
            Waiting child{&four.child[i], walk.ask(four.child[i].box)};
            if (child.t > walk.best.t || child.t == infinity) continue;
            stack.push_back(child);
            for (size_t k = stack.size() - 1; k > bottom && stack[k - 1].t < stack[k].t; k--) {
                std::swap(stack[k - 1], stack[k]);
            }
        }
    }
    return walk.found();
}

/// The steps of the chapter, each faster than the one before.
enum class Step : uint8_t { linear, median, sah, ordered, four };
inline const std::vector<const char*> step_names = {"linear", "median", "sah", "ordered", "four"};

/// What each step needs: a hierarchy (linear: none), or one of nodes of four.
struct Finder {
    Step step = Step::linear;
    Hierarchy hierarchy;
    FourHierarchy four;
};

inline Finder make_finder(const Scene& scene, Step step) {
    const Geometry& g = scene.geometry;
    switch (step) {
        case Step::linear: return {step, {}, {}};
        case Step::median: return {step, build(g, split_median), {}};
        case Step::sah:
        case Step::ordered: return {step, build(g, split_sah), {}};
        case Step::four: return {step, {}, collapse(build(g, split_sah))};
    }
    return {};
}

/// The first primitive that the ray hits, as the step finds it. All steps find the same hit, bit
/// for bit.
inline PrimHit find(const Finder& f, const Geometry& g, const Ray& ray, Work& work) {
    switch (f.step) {
        case Step::linear: work.prims += g.size(); return linear_scan(g, ray);
        case Step::median:
        case Step::sah: return traverse(f.hierarchy, g, ray, false, work);
        case Step::ordered: return traverse(f.hierarchy, g, ray, true, work);
        case Step::four: return traverse_four(f.four, g, ray, work);
    }
    return {};
}

}  // namespace ch06
