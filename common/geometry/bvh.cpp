// How a ray finds its way through the hierarchy of bounding boxes (chapter 05).
#include "common/geometry/bvh.h"

#include <bit>

#include "common/geometry/shapes.h"

namespace {

/// One axis of a ray, made ready for boxes: distance to a plane = plane * inv - o_inv.
///
/// Distances are lengths of d times `scale`, the longest side of d, so that they do not overflow
/// for a very short or a very long d.
struct AxisRay {
    Floats inv, o_inv;
    uint32_t negative;
    size_t near_row, far_row;  // of BvhNode::plane

    AxisRay(const Ray& ray, Vec3 centre, int axis, float inverse)
        : inv(splat(inverse)),
          o_inv(splat((ray.o[axis] - centre[axis]) * inverse)),
          negative(std::bit_cast<uint32_t>(ray.d[axis]) >> 31),
          near_row(2 * static_cast<size_t>(axis) + negative),
          far_row(near_row ^ 1) {}
    Floats enter(const BvhNode& node) const {
        return multiply_subtract(load(node.plane[near_row]), inv, o_inv);
    }
    Floats leave(const BvhNode& node) const {
        return multiply_subtract(load(node.plane[far_row]), inv, o_inv);
    }
};

/// The floats next to t > 0.
float next_below(float t) { return std::bit_cast<float>(std::bit_cast<uint32_t>(t) - 1); }
float next_above(float t) { return std::bit_cast<float>(std::bit_cast<uint32_t>(t) + 1); }

/// These triangles of a block, one by one in double precision; their edges have the ray inside.
[[gnu::noinline]] bool test_in_double(const BvhBlock& block, uint32_t hits, const Ray& ray,
                                      const Shear& shear, PrimHit& best) {
    bool found = false;
    for (; hits != 0; hits &= hits - 1) {
        int k = std::countr_zero(hits);
        const auto& v = block.vertex;
        Vec3 p0 = {v[0][k], v[1][k], v[2][k]}, p1 = {v[3][k], v[4][k], v[5][k]},
             p2 = {v[6][k], v[7][k], v[8][k]};
        TriangleHit hit = meet_plane(ray, p0, p1, p2);
        if (!is_within(hit)) [[unlikely]] {
            auto met = intersect_triangle({ray.o, ray.d}, shear, p0, p1, p2);
            if (!met) continue;
            hit = *met;
        }
        if (!(hit.t > 0 && hit.t <= best.t)) continue;
        if (hit.t == best.t && block.prim[k] >= best.prim) continue;
        best = {block.prim[k], hit.t, hit.b1, hit.b2};
        found = true;
    }
    return found;
}

/// The same, with a copy of `best`, so that the caller can keep it in registers.
bool in_double(const BvhBlock& block, uint32_t hits, const Ray& ray, const Shear& shear,
               PrimHit& best) {
    PrimHit nearer = best;
    bool found = test_in_double(block, hits, ray, shear, nearer);
    best = nearer;
    return found;
}

/// Relative error of t in float at which double precision takes over.
constexpr float float_error = 0x1p-8f;

/// 1 / 2^k.
float power_of_half(uint32_t k) { return std::bit_cast<float>((127 - k) << 23); }

/// In which lanes t in float is good enough, on triangles that are not thin and whose sides are
/// not longer than `side`.
///
/// With u = 2^-24, R for the distance of the corners and m <= side for their distance from the ray:
/// rounding moves each sheared corner by 6 u R, and so t by 12 u R tan at most; the products of the
/// e_i are off by u m^2, and so t by 9 u m^2 side / |det|. On triangles that are not thin (the
/// longest side, squared, is at most 64 times twice the area) both together are below
///
///   600 u (t + side) / cos,   cos >= |det| |d_z| / side^2      (d of length 1)
///
/// tested by  "truth: every hit as in double precision"
[[gnu::always_inline]] inline uint32_t trusted(Floats t, Floats det, float side,
                                               const Shear& shear) {
    float enough = 600 * 0x1p-24f / float_error * side * side;
    Floats per_t = splat(1.74f * enough);  // where d is not of length 1, t counts up to sqrt(3) d_z
    Floats constant = splat(enough * side * std::abs(shear.sz));
    Floats product = t * det;
    return less(per_t * t + constant, max(product, splat(0) - product));
}

/// intersect_triangle() on a whole block: the edges of all triangles at once, with the same bits.
/// Hits up to best.t count, that included; of those at best.t only ones with a lower number.
///
/// t and the weights are worked out in float first. Where they may be wrong by more than
/// float_error, in double precision, as intersect_triangle() does.
template <bool any>
[[gnu::always_inline]] inline bool test_triangles(const BvhBlock& block, uint32_t leaf, float side,
                                                  const Ray& ray, const Shear& shear,
                                                  PrimHit& best) {
    // Shear space, so that the ray is the z axis.
    auto [kx, ky, kz, sx, sy, sz] = shear;
    Floats ox = splat(ray.o[kx]), oy = splat(ray.o[ky]), oz = splat(ray.o[kz]);
    Floats shear_x = splat(sx), shear_y = splat(sy), zero = splat(0);
    Floats az = load(block.vertex[kz]) - oz;
    Floats ax = load(block.vertex[kx]) - ox - shear_x * az;
    Floats ay = load(block.vertex[ky]) - oy - shear_y * az;
    Floats bz = load(block.vertex[3 + kz]) - oz;
    Floats bx = load(block.vertex[3 + kx]) - ox - shear_x * bz;
    Floats by = load(block.vertex[3 + ky]) - oy - shear_y * bz;
    Floats cz = load(block.vertex[6 + kz]) - oz;
    Floats cx = load(block.vertex[6 + kx]) - ox - shear_x * cz;
    Floats cy = load(block.vertex[6 + ky]) - oy - shear_y * cz;

    // Leave out the triangles that the ray passes by.
    Floats e0 = cx * by - cy * bx, e1 = ax * cy - ay * cx, e2 = bx * ay - by * ax;
    uint32_t outside = less(min(min(e0, e1), e2), zero) & less(zero, max(max(e0, e1), e2));

    // Of thin ones t in float tells nothing: leave out those with all corners too near or too far.
    Floats scale = splat(sz), reach = splat(best.t);
    if ((leaf & BvhNode::careful) == BvhNode::careful) [[unlikely]] {
        Floats ta = az * scale, tb = bz * scale, tc = cz * scale;
        Floats near = min(min(ta, tb), tc), far = max(max(ta, tb), tc);
        uint32_t hits = ~outside & less(zero, far) & less_equal(near, reach);
        return hits != 0 && in_double(block, hits, ray, shear, best);
    }

    Floats det = e0 + e1 + e2;
    Floats t = (e0 * az + e1 * bz + e2 * cz) / det * scale;
    uint32_t hits = ~outside & less(zero, t) & less_equal(t, reach);
    if (hits == 0) return false;
    side *= power_of_half(leaf >> BvhNode::side_at & 31);
    uint32_t sure = hits & trusted(t, det, side, shear);
    if (any && sure != 0) return true;
    if (hits != sure) [[unlikely]]
        return in_double(block, hits, ray, shear, best);

    // Keep the nearest.
    alignas(64) float ts[lanes], e1s[lanes], e2s[lanes], dets[lanes];
    store(t, ts);
    store(e1, e1s);
    store(e2, e2s);
    store(det, dets);
    for (; hits != 0; hits &= hits - 1) {
        int k = std::countr_zero(hits);
        if (ts[k] < best.t || (ts[k] == best.t && block.prim[k] < best.prim))
            best = {block.prim[k], ts[k], e1s[k] / dets[k], e2s[k] / dets[k]};
    }
    return true;
}

/// The spheres and disks of a block, one by one.
bool test_others(const BvhBlock& block, const Geometry& g, Ray ray, PrimHit& best) {
    bool found = false;
    for (uint32_t prim : block.prim) {
        if (prim == PrimHit::none) continue;
        ray.t_max = next_above(best.t);
        auto t = visit(
            g, prim, [](const Triangle&) { return std::optional<float>{}; },
            [&](const Sphere& s) { return intersect_sphere(ray, s.c, s.r); },
            [&](const Disk& d) { return intersect_disk(ray, d.c, d.n, d.r); });
        if (!t || (*t == best.t && prim >= best.prim)) continue;
        best = {prim, *t};
        found = true;
    }
    return found;
}

/// Asks for a child's memory before it is needed.
void prefetch(const Bvh& bvh, uint32_t child) {
    const void* p = child & BvhNode::leaf
                        ? static_cast<const void*>(&bvh.blocks[child & BvhNode::index])
                        : static_cast<const void*>(&bvh.nodes[child]);
    for (int line = 0; line < 9; line++)
        __builtin_prefetch(static_cast<const char*>(p) + 64 * line);
}

/// What ray and block have in common becomes the best hit. Returns whether any was asked for, and
/// is found.
template <bool any, bool counting>
[[gnu::always_inline]] inline bool test_block(const BvhBlock& block, uint32_t leaf, float side,
                                              const Geometry& g, const Ray& ray, const Shear& shear,
                                              PrimHit& best, BvhCount* count) {
    if (counting) count->blocks++;
    bool found = test_triangles<any>(block, leaf, side, ray, shear, best);
    if (leaf & BvhNode::mixed && !(any && found)) {
        PrimHit other = best;  // a copy, so that `best` can stay in registers
        found |= test_others(block, g, ray, other);
        best = other;
    }
    return any && found;
}

/// All blocks, one after the other: no boxes.
template <bool any, bool counting>
PrimHit scan(const Bvh& bvh, const Geometry& g, const Ray& ray, BvhCount* count) {
    Shear shear = shear_to_ray(ray.d);
    PrimHit best;
    best.t = next_below(ray.t_max);
    for (const BvhBlock& block : bvh.blocks)
        if (test_block<any, counting>(block, bvh.root, bvh.side, g, ray, shear, best, count))
            return {0};
    return best.prim == PrimHit::none ? PrimHit{} : best;
}

template <bool any, bool counting>
PrimHit traverse(const Bvh& bvh, const Geometry& g, const Ray& ray, BvhCount* count) {
    if (bvh.root & BvhNode::leaf) return scan<any, counting>(bvh, g, ray, count);
    // A rounded t may come before its box; and boxes at the same t must be looked at.
    constexpr float slack = 1 + 0x1p-12f, tiny = 0x1p-60f;
    PrimHit best;
    float scale = max_component(abs(ray.d));
    if (!(scale > 0 && scale < infinity && ray.t_max > 0)) return {};
    Shear shear = shear_to_ray(ray.d);
    best.t = next_below(ray.t_max);

    // Where d is 0, put one so small that the ray stays within the padding.
    auto not_zero = [&](float d) { return std::copysign(std::max(std::abs(d), tiny * scale), d); };
    Float4 inv = scale / Float4{not_zero(ray.d.x), not_zero(ray.d.y), not_zero(ray.d.z), 1};
    Vec3 centre = bvh.centre;
    const AxisRay x(ray, centre, 0, inv[0]), y(ray, centre, 1, inv[1]), z(ray, centre, 2, inv[2]);
    uint32_t octant = x.negative | y.negative << 1 | z.negative << 2;
    float reach = best.t * scale * slack;
    // A hit may lie outside of its primitive's box by what rounding did to it, and the distances
    // are rounded too. The former is padded for when a box is built; for the latter the far planes
    // are taken a bit further away. Never closer: what a box lets through for nothing the
    // triangles turn down, but what it keeps out is lost.
    Floats further = splat(1 + 0x1p-20f);

    // Children still to be visited, the nearest on top, each with the distance to its box. At most
    // lanes - 1 stay behind on each level, and the builder makes no more than 96 levels.
    alignas(64) uint32_t stack[97 * lanes];
    alignas(64) float stack_enter[97 * lanes];
    int size = 1;
    stack[0] = BvhNode::nothing;
    stack_enter[0] = -infinity;
    auto pop = [&] {
        do size--;
        while (!(stack_enter[size] <= reach));
        return stack[size];
    };

    uint32_t current = bvh.root;
    while (true) {
        // Go down to a leaf.
        while (!(current & BvhNode::leaf)) {
            const BvhNode& node = bvh.nodes[current];
            if (counting) count->nodes++;
            Floats enter = max(max(x.enter(node), y.enter(node)), max(z.enter(node), splat(0)));
            Floats leave = min(x.leave(node), min(y.leave(node), z.leave(node))) * further;
            leave = min(leave, splat(reach));
            uint32_t hits = less_equal(enter, leave);
            if (hits == 0) {
                current = pop();
            } else if ((hits & (hits - 1)) == 0) {
                current = node.child[std::countr_zero(hits)];
            } else if (any) {
                // Any hit will do: no order but that of the lanes, in which the builder puts last
                // what is likeliest to stop a ray.
                store(compress(load(node.child), hits), stack + size);
                store(compress(enter, hits), stack_enter + size);
                size += std::popcount(hits) - 1;
                current = node.child[31 - std::countl_zero(hits)];
            } else {
                // Put them on the stack from far to near, and go on with the nearest.
                Ints order = lanes_of(node.far_first[octant]);
                enter = permute(enter, order);
                hits = less_equal(enter, permute(leave, order));
                store(compress(permute(load(node.child), order), hits), stack + size);
                store(compress(enter, hits), stack_enter + size);
                size += std::popcount(hits) - 1;
                // The nearest, without a wait for what was just stored.
                int last = 31 - std::countl_zero(hits);
                current = node.child[node.far_first[octant] >> (4 * last) & (lanes - 1)];
                prefetch(bvh, stack[size - 1]);
            }
        }
        if (current == BvhNode::nothing) break;

        const BvhBlock& block = bvh.blocks[current & BvhNode::index];
        if (test_block<any, counting>(block, current, bvh.side, g, ray, shear, best, count))
            return {0};
        reach = best.t * scale * slack;
        current = pop();
    }
    return best.prim == PrimHit::none ? PrimHit{} : best;
}

}  // namespace

PrimHit closest_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray) {
    return traverse<false, false>(bvh, geometry, ray, nullptr);
}

PrimHit closest_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray, BvhCount& count) {
    return traverse<false, true>(bvh, geometry, ray, &count);
}

bool any_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray) {
    return traverse<true, false>(bvh, geometry, ray, nullptr).prim != PrimHit::none;
}
