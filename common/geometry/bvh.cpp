// How a ray finds its way through the hierarchy of bounding boxes (chapter 06).
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

/// Relative error of t in float at which double precision takes over.
constexpr float float_error = 0x1p-8f;

/// Corners of a block of triangles, relative to the origin of the ray, which is the z axis.
struct Corners {
    Floats x[3], y[3], z[3];

    Corners(const BvhBlock& block, const Ray& ray, const Shear& shear) {
        auto [kx, ky, kz, sx, sy, sz] = shear;
        Floats ox = splat(ray.o[kx]), oy = splat(ray.o[ky]), oz = splat(ray.o[kz]);
        for (int k = 0; k < 3; k++) {
            z[k] = load(block.vertex[3 * k + kz]) - oz;
            x[k] = load(block.vertex[3 * k + kx]) - ox - splat(sx) * z[k];
            y[k] = load(block.vertex[3 * k + ky]) - oy - splat(sy) * z[k];
        }
    }
};

Floats min3(const Floats (&a)[3]) { return min(min(a[0], a[1]), a[2]); }
Floats max3(const Floats (&a)[3]) { return max(max(a[0], a[1]), a[2]); }
Floats farthest(const Floats (&a)[3]) { return max(max(abs(a[0]), abs(a[1])), abs(a[2])); }

/// How far z_t = sum of e_i z_i may be off, where the ray is inside of the triangle.
///
/// With u = 2^-24, m the largest |x| and |y| of the corners, Z the largest |z|, D the difference of
/// their z, and det = sum of e_i: the sum of the sides is 6.9 m at most, so that the slope is
/// 3.5 m D / |det|, and |det| is 4 m^2 at most. Rounding moves each corner by 2 u m + 4 u Z in x
/// and in y; each e_i is off by u (2 m^2 + |e_i|); the products and their sum by 3 u |det| Z, where
/// Z <= z_t / det + D. All in all
///
///   error of z_t / det < 32 u (m + Z) m D / |det| + 3 u z_t / det
///
/// tested by  "truth: every hit as in double precision"
[[gnu::always_inline]] inline Floats error_of(const Corners& c) {
    Floats m = max(farthest(c.x), farthest(c.y)), low = min3(c.z), high = max3(c.z);
    return splat(32 * 0x1p-24f) * (m + max(abs(low), abs(high))) * m * (high - low);
}

/// intersect_triangle() on a whole block: the edges of all triangles at once, with the same bits.
/// Hits with t up to and including best.t count; at best.t only one with a lower number.
///
/// t and the weights are computed in float first. Where they may be wrong by more than float_error,
/// they are computed in double precision, as in intersect_triangle().
template <bool any>
[[gnu::always_inline]] inline bool test_triangles(const BvhBlock& block, const Ray& ray,
                                                  const Shear& shear, PrimHit& best) {
    // Leave out the triangles that the ray passes by, and what has no corners.
    Corners c(block, ray, shear);
    Floats e[3] = {c.x[2] * c.y[1] - c.y[2] * c.x[1], c.x[0] * c.y[2] - c.y[0] * c.x[2],
                   c.x[1] * c.y[0] - c.y[1] * c.x[0]};
    Floats zero = splat(0), scale = splat(shear.sz), reach = splat(best.t);
    Floats low = min3(e), high = max3(e);
    uint32_t inside = less_equal(zero, low) | less_equal(high, zero);
    inside &= ~equal(load(block.prim), ray.from);
    if (inside == 0) return false;

    // Float is used only where its error is small. If an e_i is 0, this may be due to rounding, and
    // the ray may miss the triangle.
    Floats z_t = e[0] * c.z[0] + e[1] * c.z[1] + e[2] * c.z[2], det = e[0] + e[1] + e[2];
    Floats t = z_t / det * scale, size = abs(z_t), error = error_of(c);
    uint32_t strictly = inside & (less(zero, low) | less(high, zero));
    uint32_t in_float = strictly & less(error, size * splat(float_error));
    uint32_t sure = in_float & less(zero, t) & less_equal(t, reach);
    bool found = sure != 0;
    if (any && found) return true;

    // Keep the nearest.
    if (found) {
        alignas(64) float ts[lanes], e1s[lanes], e2s[lanes], dets[lanes];
        store(t, ts);
        store(e[1], e1s);
        store(e[2], e2s);
        store(det, dets);
        for (; sure != 0; sure &= sure - 1) {
            int k = std::countr_zero(sure);
            if (ts[k] < best.t || (ts[k] == best.t && block.prim[k] < best.prim))
                best = {block.prim[k], ts[k], e1s[k] / dets[k], e2s[k] / dets[k]};
        }
    }

    // Of the others, leave out those with all corners too near or too far.
    uint32_t unsure = inside ^ in_float;
    if (unsure != 0) [[unlikely]] {
        Floats ends[2] = {min3(c.z) * scale, max3(c.z) * scale};
        Floats near = min(ends[0], ends[1]), far = max(ends[0], ends[1]);
        unsure &= ~(less(t, zero) & less(error, size));
        unsure &= less(zero, far) & less_equal(near, reach);
        PrimHit nearer = best;  // a copy, so that `best` can stay in registers
        if (unsure != 0 && test_in_double(block, unsure, ray, shear, nearer)) {
            best = nearer;
            found = true;
        }
    }
    return found;
}

/// The spheres and disks of a block, one by one.
[[gnu::noinline]] bool test_others(const BvhBlock& block, const Geometry& g, Ray ray,
                                   PrimHit& best) {
    Shear shear = shear_to_ray(ray.d);
    bool found = false;
    for (int k = 0; k < lanes && block.prim[k] != PrimHit::none; k++) {
        uint32_t prim = block.prim[k];
        if (prim < g.triangles.size()) break;
        ray.t_max = next_above(best.t);
        PrimHit hit = intersect_primitive(g, prim, ray, shear);
        if (hit.prim == PrimHit::none || (hit.t == best.t && prim >= best.prim)) continue;
        best = hit;
        found = true;
    }
    return found;
}

/// Updates `best` by hits with the block. Returns whether `any` is set and there was one.
template <bool any>
[[gnu::always_inline]] inline bool test_block(const BvhBlock& block, const Geometry& g,
                                              const Ray& ray, const Shear& shear, PrimHit& best) {
    bool found = test_triangles<any>(block, ray, shear, best);
    if (block.prim[0] >= g.triangles.size() && !(any && found)) {
        PrimHit other = best;  // a copy, so that `best` can stay in registers
        found |= test_others(block, g, ray, other);
        best = other;
    }
    return any && found;
}

template <bool any>
PrimHit scan(const Bvh& bvh, const Geometry& g, const Ray& ray) {
    Shear shear = shear_to_ray(ray.d);
    PrimHit best;
    best.t = next_below(ray.t_max);
    for (const BvhBlock& block : bvh.blocks)
        if (test_block<any>(block, g, ray, shear, best)) return {0};
    return best.prim == PrimHit::none ? PrimHit{} : best;
}

template <bool any>
PrimHit traverse(const Bvh& bvh, const Geometry& g, const Ray& ray) {
    if (bvh.nodes.empty()) return scan<any>(bvh, g, ray);
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
    // Rounding may move a hit out of its primitive's box, and the distances are rounded too. For
    // the first, boxes are padded when they are built. For the second, the far planes are moved a
    // bit away, never closer: a box that is tested needlessly costs some time, but a box that is
    // skipped by mistake loses a hit.
    Floats further = splat(1 + 0x1p-20f);

    // Children still to be visited, the nearest on top, each with the distance to its box. At most
    // lanes - 1 stay behind on each level, and the builder makes no more than 96 levels.
    alignas(64) uint32_t stack[97 * lanes];
    alignas(64) float stack_enter[97 * lanes];
    int size = 1;
    stack[0] = BvhNode::nothing;
    stack_enter[0] = -infinity;
    auto pop = [&] {
        if (any) return stack[--size];  // where it is does not matter
        do size--;
        while (!(stack_enter[size] <= reach));
        return stack[size];
    };

    uint32_t current = 0;
    while (true) {
        // Go down to a leaf.
        while (!(current & BvhNode::leaf)) {
            const BvhNode& node = bvh.nodes[current];
            Floats enter = max(max(x.enter(node), y.enter(node)), max(z.enter(node), splat(0)));
            Floats leave = min(x.leave(node), min(y.leave(node), z.leave(node))) * further;
            leave = min(leave, splat(reach));
            uint32_t hits = less_equal(enter, leave);
            if (hits == 0) {
                current = pop();
            } else if ((hits & (hits - 1)) == 0) {
                current = node.child[std::countr_zero(hits)];
            } else if (any) {
                // Any hit will do: the last of the lanes first, as the builder orders them.
                store(compress(load(node.child), hits), stack + size);
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
            }
        }
        if (current == BvhNode::nothing) break;

        const BvhBlock& block = bvh.blocks[current ^ BvhNode::leaf];
        if (test_block<any>(block, g, ray, shear, best)) return {0};
        reach = best.t * scale * slack;
        current = pop();
    }
    return best.prim == PrimHit::none ? PrimHit{} : best;
}

}  // namespace

[[gnu::flatten]] PrimHit closest_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray) {
    return traverse<false>(bvh, geometry, ray);
}

[[gnu::flatten]] bool any_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray) {
    return traverse<true>(bvh, geometry, ray).prim != PrimHit::none;
}
