// How a ray finds its way through the hierarchy of bounding boxes (chapter 05).
#include "common/bvh.h"

#include <array>
#include <bit>

#include "common/shapes.h"
#include "common/simd.h"

namespace {

/// For each mask of 8 bits: the lanes whose bits are set, one after the other, 4 bits each.
constexpr auto packed_lanes = [] {
    std::array<uint32_t, 256> lanes = {};
    for (uint32_t mask = 0; mask < 256; mask++) {
        int n = 0;
        for (uint32_t i = 0; i < 8; i++) {
            if (mask >> i & 1) lanes[mask] |= i << (4 * n++);
        }
    }
    return lanes;
}();

/// A ray made ready for boxes. Distances along it are measured on the axis where d is longest, so
/// that nothing overflows for a very short or a very long d.
struct BoxRay {
    Float8 inv[3], o_inv[3];
    int near_row[3];
    uint32_t octant = 0;
    float scale;  // from lengths of d to distances

    BoxRay(const Ray& ray) {
        scale = max_component(abs(ray.d));
        for (int axis = 0; axis < 3; axis++) {
            // A direction of 0 becomes one so small that it stays within the padding of the boxes.
            float d = ray.d[axis] / scale;
            float inverse = 1 / std::copysign(std::max(std::abs(d), 0x1p-40f), d);
            bool negative = std::signbit(d);
            inv[axis] = splat8(inverse);
            o_inv[axis] = splat8(ray.o[axis] * inverse);
            near_row[axis] = 2 * axis + (negative ? 1 : 0);
            octant |= static_cast<uint32_t>(negative) << axis;
        }
    }
};

/// The floats next to t > 0.
float next_below(float t) { return std::bit_cast<float>(std::bit_cast<uint32_t>(t) - 1); }
float next_above(float t) { return std::bit_cast<float>(std::bit_cast<uint32_t>(t) + 1); }

/// intersect_triangle() on eight at once: the same operations in the same order, so the same bits.
/// Returns true as soon as anything is hit when `any` is set.
template <bool any>
bool test_triangles(const BvhBlock& block, const Ray& ray, const Shear& shear, PrimHit& best) {
    auto [kx, ky, kz, sx, sy, sz] = shear;
    Float8 ox = splat8(ray.o[kx]), oy = splat8(ray.o[ky]), oz = splat8(ray.o[kz]);
    Float8 shear_x = splat8(sx), shear_y = splat8(sy);
    Float8 az = load8(block.vertex[kz]) - oz;
    Float8 bz = load8(block.vertex[3 + kz]) - oz;
    Float8 cz = load8(block.vertex[6 + kz]) - oz;
    Float8 ax = load8(block.vertex[kx]) - ox - shear_x * az;
    Float8 ay = load8(block.vertex[ky]) - oy - shear_y * az;
    Float8 bx = load8(block.vertex[3 + kx]) - ox - shear_x * bz;
    Float8 by = load8(block.vertex[3 + ky]) - oy - shear_y * bz;
    Float8 cx = load8(block.vertex[6 + kx]) - ox - shear_x * cz;
    Float8 cy = load8(block.vertex[6 + ky]) - oy - shear_y * cz;
    Float8 e0 = cx * by - cy * bx, e1 = ax * cy - ay * cx, e2 = bx * ay - by * ax;
    Float8 zero = splat8(0);
    uint32_t outside = less(min8(min8(e0, e1), e2), zero) & less(zero, max8(max8(e0, e1), e2));
    if (outside == 0xff) return false;
    Float8 det = e0 + e1 + e2;
    Float8 t = (e0 * az + e1 * bz + e2 * cz) * splat8(sz) / det;
    uint32_t hits = ~outside & less(zero, t) & less_equal(t, splat8(best.t));
    if (any || hits == 0) return hits != 0;

    alignas(32) float ts[8], b1[8], b2[8];
    store8(t, ts);
    store8(e1 / det, b1);
    store8(e2 / det, b2);
    for (; hits != 0; hits &= hits - 1) {
        int i = std::countr_zero(hits);
        if (ts[i] < best.t || (ts[i] == best.t && block.prim[i] < best.prim))
            best = {block.prim[i], ts[i], b1[i], b2[i]};
    }
    return true;
}

/// The spheres and disks of a block, one by one.
template <bool any>
bool test_others(const BvhBlock& block, const Geometry& g, Ray ray, PrimHit& best) {
    bool found = false;
    for (uint32_t prim : block.prim) {
        size_t i = prim;
        if (prim == PrimHit::none || i < g.triangles.size()) continue;
        i -= g.triangles.size();
        ray.t_max = next_above(best.t);
        std::optional<float> t;
        if (i < g.spheres.size()) {
            t = intersect_sphere(ray, g.spheres[i].c, g.spheres[i].r);
        } else {
            const Disk& disk = g.disks[i - g.spheres.size()];
            t = intersect_disk(ray, disk.c, disk.n, disk.r);
        }
        if (!t || (*t == best.t && prim > best.prim)) continue;
        best = {prim, *t};
        found = true;
        if (any) return true;
    }
    return found;
}

template <bool any>
PrimHit traverse(const Bvh& bvh, const Geometry& g, const Ray& ray) {
    constexpr float slack = 1 + 0x1p-12f;
    PrimHit best;
    if (!(ray.t_max > 0)) return best;
    BoxRay r(ray);
    Shear shear = shear_to_ray(ray.d);
    best.t = next_below(ray.t_max);  // hits up to here count, this one included
    float best_distance = best.t * r.scale * slack;

    alignas(32) uint32_t stack[512];
    alignas(32) float stack_near[512];
    int size = 0;
    uint32_t current = bvh.root;
    while (true) {
        if (current & BvhNode::leaf) {
            const BvhBlock& block = bvh.blocks[current & BvhNode::index];
            bool found = test_triangles<any>(block, ray, shear, best);
            if (current & BvhNode::mixed && !(any && found))
                found |= test_others<any>(block, g, ray, best);
            if (found) {
                if (any) {
                    best.prim = 0;
                    return best;
                }
                best_distance = best.t * r.scale * slack;
            }
        } else {
            const BvhNode& node = bvh.nodes[current];
            Float8 near[3], far[3];
            for (int axis = 0; axis < 3; axis++) {
                int row = r.near_row[axis];
                near[axis] = multiply_subtract(load8(node.plane[row]), r.inv[axis], r.o_inv[axis]);
                far[axis] =
                    multiply_subtract(load8(node.plane[row ^ 1]), r.inv[axis], r.o_inv[axis]);
            }
            Float8 enter = max8(max8(near[0], near[1]), max8(near[2], splat8(0)));
            Float8 leave = min8(min8(far[0], far[1]), min8(far[2], splat8(best_distance)));
            Int8 order = order_lanes(node.order[r.octant]);
            enter = permute(enter, order);
            uint32_t mask = less_equal(enter, permute(leave, order) * splat8(1 + 0x1p-20f));
            Int8 pack = order_lanes(packed_lanes[mask]);
            store8(permute(enter, pack), stack_near + size);
            store8(permute(permute(load8_int(node.child), order), pack), stack + size);
            size += std::popcount(mask);
        }
        do {
            if (size == 0) {
                if (best.prim == PrimHit::none) best.t = infinity;
                return best;
            }
            size--;
        } while (!(stack_near[size] <= best_distance));
        current = stack[size];
    }
}

}  // namespace

PrimHit closest_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray) {
    return traverse<false>(bvh, geometry, ray);
}

bool any_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray) {
    return traverse<true>(bvh, geometry, ray).prim != PrimHit::none;
}
