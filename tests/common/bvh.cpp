// The hierarchy of common/ against the linear scan: the same hits, on awkward rays and awkward
// meshes.
#include "common/geometry/bvh.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "common/geometry/shapes.h"
#include "tests/support/meshes.h"

namespace {

constexpr float largest = std::numeric_limits<float>::max();
constexpr float smallest = std::numeric_limits<float>::denorm_min();

constexpr int ray_kinds = 4;

/// Makes rays that a hierarchy may get wrong, out of the mesh's own numbers: there zeros, ties and
/// touching boxes are.
class RayMaker {
public:
    explicit RayMaker(const Geometry& g) : random_(SamplerType::independent, 11, 1) {
        corners_ = g.positions;
        auto add_around = [&](Vec3 c, float r) {
            for (Vec3 side : {Vec3{r, 0, 0}, {0, r, 0}, {0, 0, r}})
                corners_.insert(corners_.end(), {c - side, c + side});
        };
        for (const Sphere& s : g.spheres) add_around(s.c, s.r);
        for (const Disk& d : g.disks) add_around(d.c, d.r);
        std::erase_if(corners_, [](Vec3 p) { return !is_finite(p); });
        if (corners_.empty()) corners_.push_back({});
        low_ = high_ = corners_[0];
        for (Vec3 p : corners_) low_ = min(low_, p), high_ = max(high_, p);
    }

    Ray make(int kind, uint32_t number) {
        random_.start(static_cast<uint32_t>(kind), number);
        Vec3 outside = point(1), a = corner(), b = corner();
        Vec3 to = number % 2 == 0 ? point(0) : a + random_.u1() * (b - a);
        float far = std::exp2(17 * random_.u1());  // in sizes of the mesh
        switch (kind) {
            case 0: {  // from around the mesh, with directions of any length
                float scale = std::exp2(std::floor(120 * random_.u1() - 60));
                return {outside, (number % 3 == 0 ? scale : 1) * (to - outside)};
            }
            case 1: {  // from coordinates of corners or elsewhere, along one or two axes
                Vec3 d = axis_direction();
                if (number % 4 == 0) d = d + 0.5f * axis_direction();
                const float back[] = {0, 2, far};
                Vec3 through = number % 2 == 0 ? Vec3{a.x, b.y, corner().z} : to;
                return {through - back[number % 3] * max_component(high_ - low_) * d, d};
            }
            case 2: return {a, to - outside};
            default: return {to + far * (outside - b), far * (b - outside)};
        }
    }

private:
    /// In the box, or in one that is larger by `margin` of its size on each side.
    Vec3 point(float margin) {
        Vec2 u = random_.u2();
        Vec3 p, v = {u.x, u.y, random_.u1()};
        for (int axis = 0; axis < 3; axis++) {
            float at = v[axis] * (1 + 2 * margin) - margin;
            p[axis] = (1 - at) * low_[axis] + at * high_[axis];
        }
        return p;
    }
    Vec3 corner() {
        float i = random_.u1() * static_cast<float>(corners_.size());
        return corners_[std::min(static_cast<size_t>(i), corners_.size() - 1)];
    }
    Vec3 axis_direction() {
        Vec3 d;
        for (int axis = 0; axis < 3; axis++) d[axis] = random_.u1() < 0.5f ? 0.0f : -0.0f;
        d[static_cast<int>(3 * random_.u1())] = random_.u1() < 0.5f ? 1.0f : -1.0f;
        return d;
    }

    Sampler random_;
    std::vector<Vec3> corners_;
    Vec3 low_, high_;
};

/// Whether a triangle is next to nothing, seen from so far away.
bool is_tiny(const Geometry& g, uint32_t prim, Vec3 from) {
    if (prim >= g.triangles.size()) return false;
    auto [a, b, c] = g.triangles[prim].v;
    Vec3 p = g.positions[a], u = g.positions[b] - p, v = g.positions[c] - p;
    float height = length(cross(u, v)) / std::max(length(u), length(v));
    return !(height > 0x1p-18f * length(p - from));
}

/// Whether the hierarchy gives this ray the hit of the linear scan, and has one answer to both
/// questions.
bool agrees(const Bvh& bvh, const Geometry& g, const Ray& ray, const PrimHit& truth) {
    PrimHit found = closest_hit(bvh, g, ray);
    bool hit = truth.prim != PrimHit::none, any = any_hit(bvh, g, ray);
    // Next to where a ray starts, and as far away as float can just tell, rounding decides, and
    // double precision decides otherwise than float.
    if (hit && (truth.t < 0x1p-20f || is_tiny(g, truth.prim, ray.o)))
        return any == (found.prim != PrimHit::none);
    return same_hit(found, truth) && any == hit;
}

/// Rays of all kinds find in the hierarchy what they find one primitive after the other. At least
/// this share of them hits something.
void check_same_hits(const Geometry& g, double least_share, uint32_t rays_of_each = 2000) {
    Bvh bvh = build_bvh(g, 1);
    RayMaker maker(g);
    int rays = 0, hits = 0;
    std::set<std::pair<int, uint32_t>> wrong;  // kind and number
    for (int kind = 0; kind < ray_kinds; kind++) {
        for (uint32_t i = 0; i < rays_of_each; i++) {
            Ray ray = maker.make(kind, i);
            PrimHit hit = linear_scan(g, ray);
            bool right = agrees(bvh, g, ray, hit);
            rays++, hits += hit.prim != PrimHit::none;
            if (hit.prim != PrimHit::none) {
                // A ray that ends before the hit does not have it any more, one behind it does.
                for (float end : {0.999f, 1.001f}) {
                    ray.t_max = end * hit.t;
                    PrimHit within = linear_scan(g, ray);
                    right = right && agrees(bvh, g, ray, within);
                    rays++, hits += within.prim != PrimHit::none;
                }
            }
            if (!right) wrong.emplace(kind, i);
        }
    }
    CHECK(wrong == decltype(wrong){});
    CHECK(hits >= least_share * rays);
}

/// n triangles of this size with their centres in the cube [-1,1]^3.
Geometry random_triangles(uint32_t n, float size) {
    Geometry g;
    Sampler random(SamplerType::independent, 12, 1);
    for (uint32_t i = 0; i < n; i++) {
        random.start(i, 0);
        auto point = [&] {
            Vec2 u = random.u2();
            return Vec3{2 * u.x - 1, 2 * u.y - 1, 2 * random.u1() - 1};
        };
        Vec3 centre = point();
        for (int k = 0; k < 3; k++) g.positions.push_back(centre + size * point());
        g.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, 0});
    }
    return g;
}

/// With spheres and disks among the triangles.
Geometry mixed(uint32_t triangles) {
    Geometry g = random_triangles(triangles, 0.2f);
    for (size_t i = 0; i < 40; i++) {
        Vec3 a = g.positions[3 * i], b = g.positions[3 * i + 1], c = g.positions[3 * i + 2];
        g.spheres.push_back({c, 0.5f * length(b - a), 0});
        Vec3 n = normalize(cross(b - a, c - a));
        if (i % 4 == 0) n = {0, i % 8 == 0 ? 1.0f : -1.0f, 0};
        g.disks.push_back({b, n, 0.4f * length(c - a), 0});
    }
    return g;
}

template <typename Array>
bool same_memory(const Array& a, const Array& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

/// Nodes on the longest way down.
int levels_of(const Bvh& bvh, uint32_t child) {
    if (child & BvhNode::leaf) return 0;
    int levels = 0;
    for (uint32_t next : bvh.nodes[child].child) levels = std::max(levels, levels_of(bvh, next));
    return levels + 1;
}

template <typename Change>
Geometry changed(Geometry g, const Change& change) {
    for (Vec3& p : g.positions) p = change(p);
    return g;
}

}  // namespace

TEST_SUITE("ch06 bvh hits") {
    TEST_CASE("brute: meshes, spheres and disks are hit as the linear scan hits them") {
        Geometry sphere, disk, boxes, round = mixed(40), flaws = mixed(100);
        sphere.spheres = {{{1, 2, 3}, 2, 0}};
        disk.disks = {{{1, 2, 3}, {0, 0, 1}, 2, 0}};
        for (int k = 0; k < 27; k++) {  // whose sides are met by many rays at once
            float x = static_cast<float>(k % 3), y = static_cast<float>(k / 3 % 3),
                  z = static_cast<float>(k / 9);
            add_box(boxes, {x, y, z}, {x + 1, y + 1, z + 1});
        }
        round.triangles.clear();
        flaws.spheres[3].r = flaws.disks[6].r = 0;
        flaws.disks[7].n = {};
        check_same_hits({}, 0);
        for (const Geometry& g :
             {sphere, round, flaws, mixed(200), closed_mesh(3), random_triangles(40, 2)})
            check_same_hits(g, 0.2);
        for (const Geometry& g : {disk, thin_diagonals(300)}) check_same_hits(g, 0.1);
        check_same_hits(boxes, 0.5);
        for (int axis = 0; axis < 3; axis++) {
            for (float at : {0.0f, -1e5f}) {
                Geometry flat;
                add_surface(flat, 10, 10, [&](float a, float b) {
                    Vec3 p;
                    p[axis] = at, p[(axis + 1) % 3] = a, p[(axis + 2) % 3] = b;
                    return p;
                });
                check_same_hits(flat, 0.08, 1000);
            }
        }
        // One less and one more than fit side by side.
        for (uint32_t n : {1u, 7u, 8u, 9u, 15u, 16u, 17u, 31u, 32u, 33u})
            check_same_hits(random_triangles(n, 1), 0.05, 600);
        for (size_t n : {2u, 4u, 8u, 10u}) {  // 6, 12, 24 and 30 primitives
            Geometry g = mixed(40);
            g.triangles.resize(n), g.spheres.resize(n), g.disks.resize(n);
            check_same_hits(g, 0.05, 600);
        }
    }

    TEST_CASE("brute: NaN and infinite vertices are never hit, and hide nothing") {
        for (float x : {std::nanf(""), infinity, -infinity}) {
            Geometry g = mixed(300), all_bad = random_triangles(20, 1);
            for (size_t i = 0; i < g.positions.size(); i += 20)
                g.positions[i][static_cast<int>(i / 20 % 3)] = x;
            g.spheres[3].r = g.spheres[4].c.y = g.disks[5].c.z = x;
            g.disks[6].n = {x, x, x};
            check_same_hits(g, 0.2);
            for (Vec3& p : all_bad.positions) p.y = x;
            check_same_hits(all_bad, 0, 100);
        }
    }

    TEST_CASE("brute: coordinates far from 0, huge ones and tiny ones") {
        Geometry g = random_triangles(200, 0.5f);
        for (Vec3 offset : {Vec3{1e4f, -1e4f, 1e4f}, {148376, 1234, -223423}, {1e7f, 0, 0}})
            check_same_hits(changed(g, [&](Vec3 p) { return p + offset; }), 0.05);
        for (float scale : {1e-9f, 1e-6f, 1e6f, 1e9f})
            check_same_hits(changed(g, [&](Vec3 p) { return scale * p; }), 0.05, 600);
        // Of very different size within one mesh.
        for (size_t i = 0; i < 300; i++) g.positions[i] = 1000 * g.positions[i];
        check_same_hits(g, 0.05);
    }

    TEST_CASE("brute: rays without a direction, without an end, and with NaN") {
        const float odd[] = {0.0f, -0.0f, smallest, 1, largest, infinity, -infinity, std::nanf("")};
        Geometry many = mixed(200), few = mixed(40);
        few.triangles.resize(10), few.spheres.resize(10), few.disks.resize(10);  // no boxes
        for (const Geometry& g : {many, few}) {
            Bvh bvh = build_bvh(g, 1);
            for (float x : odd)
                for (float y : odd)
                    for (float z : odd)
                        for (float t_max : {infinity, largest, 1.0f, smallest, 0.0f, -1.0f}) {
                            for (Ray ray : {Ray{{0.1f, 0.2f, 0.3f}, {x, y, z}, t_max},
                                            Ray{{x, y, z}, {0.3f, 0.2f, 0.5f}, t_max}}) {
                                PrimHit truth = linear_scan(g, ray);
                                REQUIRE(same_hit(closest_hit(bvh, g, ray), truth));
                                REQUIRE(any_hit(bvh, g, ray) == (truth.prim != PrimHit::none));
                            }
                        }
        }
    }
}

TEST_SUITE("ch06 bvh build") {
    TEST_CASE("identity: the same hierarchy for any number of threads") {
        Geometry ball, copies;
        add_bumpy_ball(ball, {0, 0, 0}, 1, 200);
        copies.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        copies.triangles.assign(100000, {{0, 1, 2}, 0});
        for (const Geometry& g : {ball, thin_diagonals(20000), mixed(20000), copies}) {
            Bvh one = build_bvh(g, 1);
            CHECK(levels_of(one, 0) <= 17);
            uint32_t parts = 0;  // a tenth more, where long slanted triangles are cut
            for (const BvhBlock& block : one.blocks)
                for (uint32_t prim : block.prim) parts += prim != PrimHit::none;
            CHECK((parts > 1.05 * g.size()) == (g.size() == 20000));
            for (int threads : {1, 2, 2, 7, 7}) {
                Bvh other = build_bvh(g, threads);
                CHECK(same_memory(other.nodes, one.nodes));
                CHECK(same_memory(other.blocks, one.blocks));
            }
        }
    }
}
