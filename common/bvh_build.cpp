// Builds the hierarchy of bounding boxes: binned surface area heuristic, eight children per node.
#include "common/bvh.h"
#include "common/parallel.h"
#include "common/simd.h"

namespace {

/// A box with its lower ends negated, so that one max8 grows both: -lo.xyz, any, hi.xyz, any.
struct alignas(32) Ref {
    Vec3 neg_lo;
    uint32_t prim;
    Vec3 hi;
    uint32_t unused = 0;
};

/// References begin .. end-1, the box around them, and the box around twice their centres.
struct Range {
    uint32_t begin = 0, end = 0;
    Float8 box, centers;
    uint32_t size() const { return end - begin; }
};

constexpr int bins = 16;
constexpr uint32_t leaf_size = 8;

Float8 nothing() { return splat8(-infinity); }
Float8 twice_center(Float8 box) { return box - swap_halves(box); }

/// Half the surface of a box; 0 for none.
float half_area(Float8 box) {
    float e[8];
    store8(box + swap_halves(box), e);
    return e[0] < 0 ? 0 : e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
}

/// The box of a primitive, padded by more than its rounded hits can lie outside of it.
bool make_ref(const Geometry& g, uint32_t prim, Ref& ref) {
    Vec3 lo, hi;
    size_t i = prim;
    if (i < g.triangles.size()) {
        const Triangle& tri = g.triangles[i];
        Vec3 a = g.positions[tri.v[0]], b = g.positions[tri.v[1]], c = g.positions[tri.v[2]];
        if (!is_finite(a) || !is_finite(b) || !is_finite(c)) return false;
        lo = min(min(a, b), c);
        hi = max(max(a, b), c);
    } else if ((i -= g.triangles.size()) < g.spheres.size()) {
        float r = std::abs(g.spheres[i].r);
        lo = g.spheres[i].c - Vec3{r, r, r};
        hi = g.spheres[i].c + Vec3{r, r, r};
    } else {
        const Disk& disk = g.disks[i - g.spheres.size()];
        Vec3 n = disk.n;
        Vec3 side = std::abs(disk.r) / length(n) *
                    Vec3{std::hypot(n.y, n.z), std::hypot(n.z, n.x), std::hypot(n.x, n.y)};
        lo = disk.c - side;
        hi = disk.c + side;
    }
    float pad = 0x1p-20f * max_component(max(abs(lo), abs(hi)));
    ref = {-lo + Vec3{pad, pad, pad}, prim, hi + Vec3{pad, pad, pad}};
    return is_finite(lo) && is_finite(hi);
}

/// Which bin a reference belongs to, on each axis.
struct Binning {
    Float8 offset, scale;

    explicit Binning(Float8 centers) {
        offset = swap_halves(centers);
        scale = splat8(bins * (1 - 0x1p-20f)) / (centers + offset);
    }
    /// Lane 4 + axis: the bin. Where all centres are the same (0 * inf is NaN): bin 0.
    Int8 bin(Float8 twice_center) const {
        Float8 x = (twice_center + offset) * scale;
        return to_int(min8(max8(x, splat8(0)), splat8(bins - 1)));
    }
};

struct Split {
    float cost = infinity;
    int axis = 0, bin = 0;  // bins below `bin` go to the left
};

/// Tries all planes between bins on all axes; cost: sum of half area x number of references.
Split find_split(const std::vector<Ref>& refs, const Range& range, const Binning& binning) {
    Float8 box[3][bins];
    uint32_t count[3][bins] = {};
    for (auto& axis : box)
        for (Float8& b : axis) b = nothing();
    for (uint32_t i = range.begin; i < range.end; i++) {
        Float8 b = load8(&refs[i]);
        int32_t bin[8];
        store8(binning.bin(twice_center(b)), bin);
        for (int axis = 0; axis < 3; axis++) {
            Float8& to = box[axis][bin[4 + axis]];
            to = max8(to, b);
            count[axis][bin[4 + axis]]++;
        }
    }
    Split best;
    for (int axis = 0; axis < 3; axis++) {
        float right_cost[bins];
        Float8 right = nothing();
        uint32_t n = 0;
        for (int i = bins - 1; i > 0; i--) {
            right = max8(right, box[axis][i]);
            n += count[axis][i];
            right_cost[i] = half_area(right) * static_cast<float>(n);
        }
        Float8 left = nothing();
        n = 0;
        for (int i = 1; i < bins; i++) {
            left = max8(left, box[axis][i - 1]);
            n += count[axis][i - 1];
            if (n == 0 || n == range.size()) continue;
            float cost = half_area(left) * static_cast<float>(n) + right_cost[i];
            if (cost < best.cost) best = {cost, axis, i};
        }
    }
    return best;
}

/// The boxes of references begin .. end-1.
Range bound(const std::vector<Ref>& refs, uint32_t begin, uint32_t end) {
    Range range;
    range.begin = begin;
    range.end = end;
    range.box = range.centers = nothing();
    for (uint32_t i = begin; i < end; i++) {
        Float8 b = load8(&refs[i]);
        range.box = max8(range.box, b);
        range.centers = max8(range.centers, twice_center(b));
    }
    return range;
}

/// Splits a range in two where it is cheapest, or by index where that does not work. Returns the
/// axis.
int split(std::vector<Ref>& refs, const Range& range, bool by_cost, Range& left, Range& right) {
    Binning binning(range.centers);
    Split best;
    if (by_cost) best = find_split(refs, range, binning);
    uint32_t middle = range.begin + range.size() / 2;
    if (best.cost < infinity) {
        auto goes_left = [&](const Ref& ref) {
            int32_t bin[8];
            store8(binning.bin(twice_center(load8(&ref))), bin);
            return bin[4 + best.axis] < best.bin;
        };
        auto first = refs.begin() + range.begin, last = refs.begin() + range.end;
        middle = static_cast<uint32_t>(std::partition(first, last, goes_left) - refs.begin());
    }
    left = bound(refs, range.begin, middle);
    right = bound(refs, middle, range.end);
    return best.axis;
}

struct Builder {
    const Geometry& g;
    std::vector<Ref> refs;
    Bvh bvh;

    uint32_t make_leaf(const Range& range) {
        BvhBlock block;
        uint32_t child = BvhNode::leaf | static_cast<uint32_t>(bvh.blocks.size());
        constexpr float nan = std::numeric_limits<float>::quiet_NaN();
        for (uint32_t lane = 0; lane < 8; lane++) {
            uint32_t prim = lane < range.size() ? refs[range.begin + lane].prim : PrimHit::none;
            block.prim[lane] = prim;
            bool triangle = prim < g.triangles.size();
            if (!triangle && prim != PrimHit::none) child |= BvhNode::mixed;
            for (size_t k = 0; k < 3; k++)
                for (int axis = 0; axis < 3; axis++)
                    block.vertex[3 * k + static_cast<size_t>(axis)][lane] =
                        triangle ? g.positions[g.triangles[prim].v[k]][axis] : nan;
        }
        bvh.blocks.push_back(block);
        return child;
    }

    uint32_t build(const Range& range, int depth) {
        if (range.size() <= leaf_size) return make_leaf(range);
        Range children[8] = {range};
        int n = 1;
        int order[8][8] = {};
        while (n < 8) {
            int widest = -1;
            for (int i = 0; i < n; i++) {
                if (children[i].size() <= leaf_size) continue;
                if (widest < 0 || half_area(children[i].box) > half_area(children[widest].box))
                    widest = i;
            }
            if (widest < 0) break;
            Range left, right;
            int axis = split(refs, children[widest], depth < 32, left, right);
            children[widest] = left;
            children[n] = right;
            for (int octant = 0; octant < 8; octant++) {
                // Far to near: along +axis the right one is the far one.
                int* o = order[octant];
                int* at = std::find(o, o + n, widest);
                bool negative = octant >> axis & 1;
                std::copy_backward(at + 1, o + n, o + n + 1);
                at[0] = negative ? widest : n;
                at[1] = negative ? n : widest;
            }
            n++;
        }
        auto index = static_cast<uint32_t>(bvh.nodes.size());
        bvh.nodes.emplace_back();
        BvhNode node;
        for (int i = 0; i < 8; i++) {
            float box[8];
            store8(i < n ? children[i].box : nothing(), box);
            for (int axis = 0; axis < 3; axis++) {
                node.plane[2 * axis][i] = -box[axis];
                node.plane[2 * axis + 1][i] = box[4 + axis];
            }
            node.child[i] = i < n ? build(children[i], depth + 1) : 0;
            node.order[i] = 0;
            for (int k = 0; k < 8; k++)
                node.order[i] |= static_cast<uint32_t>(k < n ? order[i][k] : k) << (4 * k);
        }
        bvh.nodes[index] = node;
        return index;
    }
};

}  // namespace

Bvh build_bvh(const Geometry& geometry, int /*threads*/) {
    Builder b{geometry, {}, {}};
    for (uint32_t prim = 0; prim < geometry.size(); prim++) {
        Ref ref;
        if (make_ref(geometry, prim, ref)) b.refs.push_back(ref);
    }
    b.bvh.root = b.build(bound(b.refs, 0, static_cast<uint32_t>(b.refs.size())), 0);
    return std::move(b.bvh);
}
