// Builds the hierarchy of bounding boxes (chapter 06): a tree of two children per node where the
// surface area heuristic splits it, then put together into wide nodes as cheaply as can be.
#include <atomic>
#include <bit>
#include <memory>
#include <queue>

#include "common/base/parallel.h"
#include "common/geometry/bvh.h"

namespace {

constexpr int bins = 16;
constexpr uint32_t small = lanes / 2;      // references of a block that is not parted
constexpr float worth_parting = 0.67f;     // of a block's surface, that its parts have together
constexpr uint32_t few = 48;               // references for which boxes cost more than they save
constexpr uint32_t worth_a_thread = 512;   // references of a subtree
constexpr float worth_cutting = 1e-2f;     // of all surface, that one box wastes
constexpr uint32_t whole_for_a_part = 10;  // so many references for one more by cutting
constexpr int cost_levels = 64;            // below that, halve by number: the depth stays bounded

Float4 max(Float4 a, Float4 b) { return a > b ? a : b; }

/// A box as four floats at a time: its lower ends are negated, so that both ends grow by a maximum.
struct NegatedBox {
    Float4 neg_lo = {-infinity, -infinity, -infinity};
    Float4 hi = {-infinity, -infinity, -infinity};

    void grow(const NegatedBox& b) {
        neg_lo = max(neg_lo, b.neg_lo);
        hi = max(hi, b.hi);
    }
    /// Half of its surface; 0 when it is empty.
    float area() const {
        Float4 e = neg_lo + hi;
        return e[0] < 0 ? 0 : e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
    }
    /// Twice its centre.
    Float4 center() const { return hi - neg_lo; }
};

/// The box of a primitive or of a part of one, with its number in the place of neg_lo[3].
struct Ref {
    NegatedBox box;

    Ref() = default;
    Ref(const Box& b, float pad, uint32_t prim)
        : box{{pad - b.low.x, pad - b.low.y, pad - b.low.z, std::bit_cast<float>(prim)},
              {pad + b.high.x, pad + b.high.y, pad + b.high.z}} {}
    uint32_t prim() const { return std::bit_cast<uint32_t>(box.neg_lo[3]); }
};
using Refs = std::vector<Ref, PageAllocator<Ref>>;

/// References begin .. end-1, the box around them, and the box around twice their centres.
struct Range {
    uint32_t begin = 0, end = 0;
    NegatedBox box = {}, centers = {};

    uint32_t size() const { return end - begin; }
    void grow(const NegatedBox& b) {
        box.grow(b);
        centers.grow({-b.center(), b.center()});
    }
    void grow(const Range& other) {
        box.grow(other.box);
        centers.grow(other.centers);
        end += other.size();
    }
};

/// How far a rounded hit may lie outside of the exact box of a primitive, relative to the centre.
float pad_of(const Box& b) { return 0x1p-20f * max_component(max(abs(b.low), abs(b.high))); }

/// The box around a disk: that of the ball around it would be met by many rays that miss it.
Box box_of_disk(const Disk& disk, Vec3 centre) {
    Vec3 n = disk.n / length(disk.n);
    Vec3 r = disk.r * Vec3{std::hypot(n.y, n.z), std::hypot(n.z, n.x), std::hypot(n.x, n.y)};
    return {disk.c - centre - r, disk.c - centre + r};
}

/// Cuts the box around the centres into slices, on each axis.
struct Binning {
    Float4 neg_first, per_length;

    explicit Binning(const NegatedBox& centers)
        : neg_first(centers.neg_lo),
          per_length(bins * (1 - 0x1p-20f) / (centers.neg_lo + centers.hi)) {}

    /// The slice on each axis. Where all centres are the same, 0 * infinity is NaN: slice 0.
    Int4 operator()(const NegatedBox& box) const {
        Float4 x = max((box.center() + neg_first) * per_length, Float4{});
        constexpr float last = bins - 1;
        return __builtin_convertvector(x < last ? x : Float4{} + last, Int4);
    }
};

struct Split {
    float cost = infinity;
    int axis = 0, bin = 0;  // what is in a lower bin goes to the left
};

/// The split between two bins that is cheapest by the surface area heuristic:
///
///   cost = area(left) n(left) + area(right) n(right)
///
/// A ray that meets the whole box meets a part with probability area(part) / area(whole). n counts
/// blocks, as each takes one test, however full.
/// source  MacDonald, Booth 1990; in bins: Wald 2007
Split find_split(const Refs& refs, const Range& range, const Binning& bin_of) {
    // What is in the bins: the box around it, and how much it is.
    NegatedBox box[3][bins];
    uint32_t count[3][bins] = {};
    for (uint32_t i = range.begin; i < range.end; i++) {
        Int4 bin = bin_of(refs[i].box);
        for (int axis = 0; axis < 3; axis++) {
            box[axis][bin[axis]].grow(refs[i].box);
            count[axis][bin[axis]]++;
        }
    }

    // Sweep from the right, then from the left.
    auto blocks = [](uint32_t n) { return static_cast<float>((n + lanes - 1) / lanes); };
    Split best;
    for (int axis = 0; axis < 3; axis++) {
        float right_cost[bins];
        NegatedBox part;
        uint32_t n = 0;
        for (int bin = bins - 1; bin > 0; bin--) {
            part.grow(box[axis][bin]);
            n += count[axis][bin];
            right_cost[bin] = part.area() * blocks(n);
        }
        part = {};
        n = 0;
        for (int bin = 1; bin < bins; bin++) {
            part.grow(box[axis][bin - 1]);
            n += count[axis][bin - 1];
            float cost = part.area() * blocks(n) + right_cost[bin];
            if (cost < best.cost && n > 0 && n < range.size()) best = {cost, axis, bin};
        }
    }
    return best;
}

/// A node with two children, or none. A wide node is made of some of those below it: given a
/// number of its places, `share` says how to fill them.
struct Node {
    NegatedBox box;
    std::unique_ptr<Node[]> children;  // two
    uint32_t begin, end;               // its references
    uint8_t axis = 0;                  // of the split: the left child is on the lower side
    uint8_t lane = 0;                  // its place in the wide node
    uint32_t number = 0;               // its BvhNode::child there
    // [k - 2]: of k places, so many go to the left child; 0: k - 1 places do as well.
    uint8_t share[lanes - 1] = {};

    bool fits_a_block() const { return end - begin <= lanes; }
};

/// [k]: the cost of all below a node that may take up to k places of the wide node above.
using Costs = std::array<float, lanes + 1>;

/// The cheapest way to make wide nodes of a binary tree.
///
///   cost(node, 1) = area + (0 if it fits a block, else split(node, lanes))
///   cost(node, k) = min(cost(node, k - 1), split(node, k))
///   split(node, k) = min over j of cost(left, j) + cost(right, k - j)
///
/// Areas are probabilities, as above; to visit a node costs as much as to test a block.
/// source  Ylitie, Karras, Laine 2017, section 3.1
Costs share_places(Node& node, const Costs& left, const Costs& right) {
    Costs split, cost;
    uint8_t share[lanes + 1];
    for (size_t k = 2; k <= lanes; k++) {
        split[k] = infinity;
        share[k] = 1;
        for (size_t j = 1; j < k; j++) {
            if (left[j] + right[k - j] < split[k]) {
                split[k] = left[j] + right[k - j];
                share[k] = static_cast<uint8_t>(j);
            }
        }
    }
    bool one_block = node.fits_a_block();
    cost[1] = node.box.area() + (one_block ? 0 : split[lanes]);
    for (size_t k = 2; k <= lanes; k++) {
        bool better = split[k] < cost[k - 1];
        cost[k] = better ? split[k] : cost[k - 1];
        node.share[k - 2] = better || (k == lanes && !one_block) ? share[k] : 0;
    }
    return cost;
}

/// The nodes that fill `places` of a wide node, those far along the octant's directions first.
struct Gathered {
    std::array<Node*, lanes> node;
    uint32_t size = 0;

    Gathered(Node& root, uint32_t octant) { add(root, lanes, octant); }
    void add(Node& root, size_t places, uint32_t octant) {
        while (places > 1 && root.share[places - 2] == 0) places--;
        if (places == 1) {
            node[size++] = &root;
            return;
        }
        size_t left = root.share[places - 2];
        bool negative = octant >> root.axis & 1;
        if (negative) add(root.children[0], left, octant);
        add(root.children[1], places - left, octant);
        if (!negative) add(root.children[0], left, octant);
    }
};

class Builder {
public:
    Builder(const Geometry& geometry, int threads)
        : g_(geometry), threads_(threads), idle_threads_(threads - 1) {}

    Bvh build() {
        Range all = make_refs();
        Node root;
        if (all.size() <= few) {
            add_few(all.size());
        } else {
            build(root, all, 0);
            number(root);
        }
        bvh_.nodes.resize(wide_.size());
        bvh_.blocks.resize(leaves_.size());
        in_chunks(wide_.size(), [&](size_t begin, size_t end, int) {
            for (size_t i = begin; i < end; i++) fill_node(*wide_[i], bvh_.nodes[i]);
        });
        in_chunks(leaves_.size(), [&](size_t begin, size_t end, int) {
            for (size_t i = begin; i < end; i++) fill_block(leaves_[i], bvh_.blocks[i]);
        });
        return std::move(bvh_);
    }

private:
    static constexpr int chunks = 64;

    /// Calls work(begin, end, chunk) for the parts of 0 .. size-1, on all threads.
    template <typename Work>
    void in_chunks(size_t size, const Work& work) {
        parallel_for(chunks, size < worth_a_thread ? 1 : threads_, [&](int i) {
            auto part = static_cast<size_t>(i);
            work(size * part / chunks, size * (part + 1) / chunks, i);
        });
    }

    Range make_refs() {
        refs_.resize(g_.size());
        // Far from the origin, boxes relative to the middle are no wider than near it.
        Vec3 centre = bounds_of(g_).centre();
        if (is_finite(centre)) bvh_.centre = centre;
        std::array<Range, chunks> parts;
        in_chunks(refs_.size(), [&](size_t begin, size_t end, int chunk) {
            Range part{0, 0};
            for (size_t i = begin; i < end; i++) {
                // No ray can hit a primitive with NaN or infinity in it.
                auto prim = static_cast<uint32_t>(i);
                size_t first_disk = g_.triangles.size() + g_.spheres.size();
                Box box = i < first_disk ? box_of(g_, prim, bvh_.centre)
                                         : box_of_disk(g_.disks[i - first_disk], bvh_.centre);
                bool is_finite_box = is_finite(box.low) && is_finite(box.high);
                refs_[i] = {box, pad_of(box), is_finite_box ? prim : PrimHit::none};
                if (!is_finite_box) continue;
                part.grow(refs_[i].box);
                part.end++;
            }
            parts[static_cast<size_t>(chunk)] = part;
        });
        Range all;
        for (const Range& part : parts) all.grow(part);
        if (all.size() < refs_.size())
            std::erase_if(refs_, [](const Ref& ref) { return ref.prim() == PrimHit::none; });
        if (all.size() > few) cut_slanted(all);
        return all;
    }

    /// Long slanted triangles fill little of their boxes, and every ray through such a box tests
    /// them. So they are cut in the middle of their longest edges into parts, each a reference with
    /// a box of its own: first those whose boxes waste the most surface.
    /// source  Dammertz, Keller 2008, "The Edge Volume Heuristic"; by waste: Karras, Aila 2013
    void cut_slanted(Range& all) {
        struct Part {
            float waste, pad;  // half of the surface; that of the whole
            uint32_t ref;
            std::array<Vec3, 3> p;  // relative to the centre

            bool operator<(const Part& other) const {
                return waste < other.waste || (waste == other.waste && ref > other.ref);
            }
        };
        std::priority_queue<Part> worst;
        auto add = [&](Part part) {
            Vec3 n = abs(cross(part.p[1] - part.p[0], part.p[2] - part.p[0]));
            part.waste = refs_[part.ref].box.area() - (n.x + n.y + n.z);
            if (part.waste > worth_cutting * all.box.area()) worst.push(part);
        };
        for (uint32_t i = 0; i < all.size(); i++) {
            if (!is_triangle(refs_[i])) continue;
            Part whole{0, 0, i, {}};
            for (size_t k = 0; k < 3; k++)
                whole.p[k] = g_.positions[g_.triangles[refs_[i].prim()].v[k]] - bvh_.centre;
            whole.pad = pad_of(box_of(g_, refs_[i].prim(), bvh_.centre));
            add(whole);
        }
        for (uint32_t left = all.size() / whole_for_a_part; left > 0 && !worst.empty(); left--) {
            Part part = worst.top();
            worst.pop();
            auto edge = [&](size_t k) { return length_squared(part.p[(k + 1) % 3] - part.p[k]); };
            size_t k = edge(0) >= edge(1) && edge(0) >= edge(2) ? 0 : edge(1) >= edge(2) ? 1 : 2;
            Vec3 a = part.p[k], b = part.p[(k + 1) % 3], c = part.p[(k + 2) % 3], m = (a + b) / 2;
            refs_.push_back(refs_[part.ref]);
            for (Part half : {Part{0, part.pad, part.ref, {a, m, c}},
                              Part{0, part.pad, all.end++, {m, b, c}}}) {
                Box box;
                for (Vec3 p : half.p) box.add(p);
                refs_[half.ref] = {box, half.pad, refs_[half.ref].prim()};
                all.grow(refs_[half.ref].box);
                add(half);
            }
        }
    }

    /// Builds the tree over a range, on another thread for one half when one is idle.
    Costs build(Node& node, const Range& range, int level) {
        node.box = range.box;
        node.begin = range.begin;
        node.end = range.end;
        Costs one_block;
        one_block.fill(range.box.area());
        if (range.size() <= small) return one_block;
        std::array<Range, 2> halves;
        node.axis = split(range, level < cost_levels, halves);
        float parts = halves[0].box.area() + halves[1].box.area();
        if (node.fits_a_block() && parts > worth_parting * range.box.area()) return one_block;
        node.children = std::make_unique<Node[]>(2);
        uint32_t smaller = std::min(halves[0].size(), halves[1].size());
        bool apart = smaller >= worth_a_thread && idle_threads_ > 0;
        if (apart) idle_threads_--;
        std::array<Costs, 2> costs;
        parallel_for(2, apart ? 2 : 1, [&](int i) {
            auto k = static_cast<size_t>(i);
            costs[k] = build(node.children[k], halves[k], level + 1);
            if (apart) idle_threads_++;
        });
        if (apart) idle_threads_--;
        return share_places(node, costs[0], costs[1]);
    }

    /// Parts a range in two, by cost or else by number, and returns the axis.
    uint8_t split(const Range& range, bool by_cost, std::array<Range, 2>& halves) {
        uint32_t front = range.begin, middle = range.begin + range.size() / 2;
        Binning bin_of(range.centers);
        Split best;
        if (by_cost) best = find_split(refs_, range, bin_of);
        by_cost = best.cost < infinity;
        // Swap what goes left to the front. The side cannot be predicted, so there is no branch.
        for (uint32_t i = range.begin; i < range.end; i++) {
            Ref ref = refs_[i];
            bool to_right = by_cost ? bin_of(ref.box)[best.axis] >= best.bin : i >= middle;
            halves[to_right].grow(ref.box);
            uint32_t to = to_right ? i : front;
            refs_[i] = refs_[to];
            refs_[to] = ref;
            front += !to_right;
        }
        halves[0].begin = range.begin;
        halves[0].end = halves[1].begin = front;
        halves[1].end = range.end;
        return static_cast<uint8_t>(best.axis);
    }

    /// Numbers the wide nodes and the leaves below a node, depth first: all that one thread has to
    /// do alone before many can write them. Returns the BvhNode::child of the node. Of its lanes,
    /// the last are those that are likeliest to stop a ray: large ones that hold little.
    uint32_t number(Node& root) {
        if (root.fits_a_block()) {
            leaves_.push_back({root.begin, root.end});
            return BvhNode::leaf | static_cast<uint32_t>(leaves_.size() - 1);
        }
        auto index = static_cast<uint32_t>(wide_.size());
        wide_.push_back(&root);
        Gathered children(root, 7);
        auto worth = [](const Node* n) { return n->box.area() / std::sqrt(n->end - n->begin); };
        std::stable_sort(children.node.begin(), children.node.begin() + children.size,
                         [&](Node* a, Node* b) { return worth(a) < worth(b); });
        for (uint32_t i = 0; i < children.size; i++) {
            children.node[i]->lane = static_cast<uint8_t>(i);
            children.node[i]->number = number(*children.node[i]);
        }
        return index;
    }

    /// Writes the boxes of the children, their numbers, and for each octant their order.
    void fill_node(Node& root, BvhNode& node) {
        Gathered children(root, 7);
        for (uint32_t i = 0; i < lanes; i++) {
            const Node* child = i < children.size ? children.node[i] : nullptr;
            NegatedBox box = child ? child->box : NegatedBox{};
            uint32_t lane = child ? child->lane : i;
            for (int axis = 0; axis < 3; axis++) {
                node.plane[2 * axis][lane] = -box.neg_lo[axis];
                node.plane[2 * axis + 1][lane] = box.hi[axis];
            }
            node.child[lane] = child ? child->number : BvhNode::nothing;
        }
        for (uint32_t octant = 0; octant < 8; octant++) {
            Gathered sorted(root, octant);
            LaneOrder order = 0;
            for (uint32_t i = 0; i < lanes; i++)
                order |= LaneOrder{i < sorted.size ? sorted.node[i]->lane : i} << (4 * i);
            node.far_first[octant] = order;
        }
    }

    bool is_triangle(const Ref& ref) const { return ref.prim() < g_.triangles.size(); }

    /// A few blocks and no node: triangles first, and of these the large ones. Most rays hit
    /// something in the first block and nothing in the others, so that the processor can foresee
    /// it.
    void add_few(uint32_t size) {
        std::sort(refs_.begin(), refs_.end(), [&](const Ref& a, const Ref& b) {
            bool first = is_triangle(a), second = is_triangle(b);
            return first != second ? first : a.box.area() > b.box.area();
        });
        for (uint32_t i = 0; i < size; i += lanes)
            leaves_.push_back({i, std::min(i + lanes, size)});
    }

    void fill_block(std::pair<uint32_t, uint32_t> leaf, BvhBlock& block) {
        auto [begin, end] = leaf;
        std::fill_n(&block.vertex[0][0], 9 * lanes, std::numeric_limits<float>::quiet_NaN());
        std::fill_n(block.prim, lanes, PrimHit::none);
        std::partition(refs_.begin() + begin, refs_.begin() + end,
                       [&](const Ref& ref) { return !is_triangle(ref); });
        uint32_t lane = 0;
        for (uint32_t i = begin; i < end; i++) {
            uint32_t prim = refs_[i].prim();
            if (std::find(block.prim, block.prim + lane, prim) != block.prim + lane) continue;
            block.prim[lane] = prim;
            for (size_t k = 0; prim < g_.triangles.size() && k < 3; k++) {  // else NaN
                Vec3 p = g_.positions[g_.triangles[prim].v[k]];
                for (int axis = 0; axis < 3; axis++)
                    block.vertex[3 * k + static_cast<size_t>(axis)][lane] = p[axis];
            }
            lane++;
        }
    }

    const Geometry& g_;
    int threads_;
    std::atomic<int> idle_threads_;
    Refs refs_;
    std::vector<Node*> wide_;  // the roots of wide nodes, in their order
    // Begin and end of the references of each block, in the order of the blocks.
    std::vector<std::pair<uint32_t, uint32_t>> leaves_;
    Bvh bvh_;
};

}  // namespace

Bvh build_bvh(const Geometry& geometry, int threads) { return Builder(geometry, threads).build(); }
