// Rays per second of each step of chapter 05, beside Embree where it is installed: make bench.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <string>

#include "common/bvh.h"
#include "common/sampler.h"
#include "common/shapes.h"
#if __has_include(<embree3/rtcore.h>)
#define HAVE_EMBREE
#include <embree3/rtcore.h>
#endif

namespace {

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

struct Rng {
    uint32_t i = 0, seed = 1;
    float u1() { return to_unit_float(hash32(i++, seed)); }
};

// ---- meshes

void add_grid(Geometry& g, int nu, int nv, const std::function<Vec3(float, float)>& f) {
    auto base = static_cast<uint32_t>(g.positions.size());
    for (int j = 0; j <= nv; j++)
        for (int i = 0; i <= nu; i++)
            g.positions.push_back(f(static_cast<float>(i) / static_cast<float>(nu),
                                    static_cast<float>(j) / static_cast<float>(nv)));
    auto at = [&](int i, int j) { return base + static_cast<uint32_t>(j * (nu + 1) + i); };
    for (int j = 0; j < nv; j++)
        for (int i = 0; i < nu; i++) {
            g.triangles.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, 0});
            g.triangles.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, 0});
        }
}
void add_quad(Geometry& g, Vec3 o, Vec3 u, Vec3 v, int n = 1) {
    add_grid(g, n, n, [&](float a, float b) { return o + a * u + b * v; });
}
void add_box(Geometry& g, Vec3 lo, Vec3 hi, int n = 1) {
    Vec3 e = hi - lo, x{e.x, 0, 0}, y{0, e.y, 0}, z{0, 0, e.z};
    add_quad(g, lo, x, y, n);
    add_quad(g, lo + z, x, y, n);
    add_quad(g, lo, x, z, n);
    add_quad(g, lo + y, x, z, n);
    add_quad(g, lo, y, z, n);
    add_quad(g, lo + x, y, z, n);
}
void add_blob(Geometry& g, Vec3 c, float r, int n) {
    add_grid(g, n, n / 2, [&](float a, float b) {
        float phi = 2 * pi * a, theta = pi * b;
        Vec3 d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
        float s = 1;
        for (int k = 0; k < 5; k++) {
            float w = static_cast<float>(3 << k);
            s += 0.25f / static_cast<float>(1 << k) *
                 std::sin(w * d.x + 1.3f * static_cast<float>(k)) * std::sin(w * d.y + 0.7f) *
                 std::sin(w * d.z + 2.1f);
        }
        return c + r * s * d;
    });
}
Vec3 rotated(Vec3 v) {  // around y and x by irrational angles
    float c = std::cos(0.6f), s = std::sin(0.6f);
    v = {c * v.x + s * v.z, v.y, -s * v.x + c * v.z};
    c = std::cos(0.4f);
    s = std::sin(0.4f);
    return {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
}

struct Case {
    std::string name;
    Geometry g;
    Vec3 eye, at, light;
    float light_size, fov;
};

Case cornell() {
    Case c{"cornell36", {}, {0.5f, 0.5f, -1.4f}, {0.5f, 0.5f, 0}, {0.5f, 0.98f, 0.5f}, 0.2f, 39};
    Geometry& g = c.g;
    add_quad(g, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
    add_quad(g, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
    add_quad(g, {0, 0, 1}, {1, 0, 0}, {0, 1, 0});
    add_quad(g, {0, 0, 0}, {0, 1, 0}, {0, 0, 1});
    add_quad(g, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    add_quad(g, {0.35f, 0.999f, 0.35f}, {0.3f, 0, 0}, {0, 0, 0.3f});
    for (int k = 0; k < 2; k++) {
        Geometry b;
        add_box(b, {-0.15f, 0, -0.15f}, {0.15f, k ? 0.6f : 0.3f, 0.15f});
        float a = k ? 0.3f : -0.3f;
        for (Vec3& p : b.positions)
            p = Vec3{std::cos(a) * p.x - std::sin(a) * p.z + (k ? 0.3f : 0.68f), p.y,
                     std::sin(a) * p.x + std::cos(a) * p.z + (k ? 0.65f : 0.3f)};
        auto base = static_cast<uint32_t>(g.positions.size());
        g.positions.insert(g.positions.end(), b.positions.begin(), b.positions.end());
        for (Triangle t : b.triangles) {
            for (uint32_t& v : t.v) v += base;
            g.triangles.push_back(t);
        }
    }
    return c;
}
Case blob(const char* name, int n) {
    Case c{name, {}, {0, 0.5f, -3}, {0, 0, 0}, {2, 4, -3}, 0.5f, 45};
    add_blob(c.g, {0, 0, 0}, 1, n);
    return c;
}
// A hall: floor, walls, vaults, columns, drapes; `s` scales the tessellation.
Case hall(const char* name, int s, bool turned) {
    Case c{name, {}, {-9, 1.7f, 0.5f}, {5, 2.5f, 0}, {0, 7.5f, 0}, 1.0f, 65};
    Geometry& g = c.g;
    add_quad(g, {-10, 0, -5}, {20, 0, 0}, {0, 0, 10}, 2 * s);
    add_quad(g, {-10, 8, -5}, {20, 0, 0}, {0, 0, 10}, 2 * s);
    add_quad(g, {-10, 0, -5}, {20, 0, 0}, {0, 8, 0}, 2 * s);
    add_quad(g, {-10, 0, 5}, {20, 0, 0}, {0, 8, 0}, 2 * s);
    add_quad(g, {-10, 0, -5}, {0, 8, 0}, {0, 0, 10}, s);
    add_quad(g, {10, 0, -5}, {0, 8, 0}, {0, 0, 10}, s);
    for (int k = 0; k < 14; k++) {
        float x = -9 + 3 * static_cast<float>(k % 7), z = k < 7 ? -3.0f : 3.0f;
        add_grid(g, 4 * s, 2 * s, [&](float a, float b) {
            float r = 0.3f + 0.1f * std::pow(std::abs(2 * b - 1), 8.0f) +
                      0.01f * std::sin(12 * 2 * pi * a);
            return Vec3{x + r * std::cos(2 * pi * a), 4 * b, z + r * std::sin(2 * pi * a)};
        });
        add_box(g, {x - 0.45f, 0, z - 0.45f}, {x + 0.45f, 0.25f, z + 0.45f});
        add_box(g, {x - 0.45f, 4, z - 0.45f}, {x + 0.45f, 4.25f, z + 0.45f});
        if (k % 7 < 6)
            add_grid(g, 3 * s, s, [&](float a, float b) {  // arch
                return Vec3{x + 1.5f - 1.3f * std::cos(pi * a),
                            4.25f + 1.3f * std::sin(pi * a) + 0.05f * std::sin(2 * pi * b),
                            z - 0.4f + 0.8f * b};
            });
        if (k % 2)
            add_grid(g, 6 * s, 6 * s, [&](float a, float b) {  // drape
                return Vec3{
                    x + 0.5f + 2 * a, 3.8f - 2.5f * b,
                    z * 0.9f + 0.1f * std::sin(40 * a + 3 * b) * b + 0.05f * std::sin(13 * b)};
            });
    }
    for (int k = 0; k < 6; k++)
        add_blob(g, {-7.5f + 3 * static_cast<float>(k), 0.6f, k % 2 ? 1.0f : -1.2f}, 0.45f, 6 * s);
    if (turned) {
        for (Vec3& p : g.positions) p = rotated(p);
        c.eye = rotated(c.eye);
        c.at = rotated(c.at);
        c.light = rotated(c.light);
    }
    return c;
}
Case corner() {
    Case c{"corner", {}, {0.5f, 3, 0.5f}, {9, 0.5f, 9}, {5, 5.5f, 5}, 1.0f, 60};
    add_box(c.g, {0, 0, 0}, {10, 6, 10});
    for (int k = 0; k < 8; k++)
        add_box(c.g, {1.0f + static_cast<float>(k), 0, 4}, {1.3f + static_cast<float>(k), 6, 4.3f});
    for (int k = 0; k < 27; k++)
        add_blob(
            c.g,
            {9.3f + 0.2f * static_cast<float>(k % 3), 0.15f + 0.2f * static_cast<float>(k / 3 % 3),
             9.3f + 0.2f * static_cast<float>(k / 9)},
            0.1f, 100);
    return c;
}
Case needles(const char* name, int n, float len, float wid) {
    Case c{name, {}, {0.5f, 0.5f, -1.8f}, {0.5f, 0.5f, 0.5f}, {0.5f, 3, -1}, 0.3f, 45};
    Rng r{0, 7};
    for (int k = 0; k < n; k++) {
        Vec3 p{r.u1(), r.u1(), r.u1()},
            d = normalize(Vec3{1, 1 - 0.5f * r.u1(), 1 - 0.5f * r.u1()}),
            w{r.u1() - 0.5f, r.u1() - 0.5f, r.u1() - 0.5f};
        auto b = static_cast<uint32_t>(c.g.positions.size());
        c.g.positions.insert(c.g.positions.end(),
                             {p - len * d, p + len * d, p + len * d + wid * w});
        c.g.triangles.push_back({{b, b + 1, b + 2}, 0});
    }
    return c;
}

// ---- rays

struct Kind {
    std::string name;
    std::vector<Ray> rays;
    bool any;
};

std::vector<Kind> make_rays(const Case& c, const Bvh& bvh, int size) {
    Rng r{0, 3};
    std::vector<Kind> kinds{{"primary", {}, false},
                            {"bounce", {}, false},
                            {"bounce2", {}, false},
                            {"shadow", {}, true}};
    Vec3 w = normalize(c.at - c.eye), u = normalize(cross({0, 1, 0}, w)), v = cross(w, u);
    float s = std::tan(c.fov * pi / 360);
    for (int i = 0; i < size * size; i++) {
        float x = (static_cast<float>(i % size) + r.u1()) / static_cast<float>(size),
              y = (static_cast<float>(i / size) + r.u1()) / static_cast<float>(size);
        kinds[0].rays.push_back({c.eye, normalize(w + s * (2 * x - 1) * u + s * (1 - 2 * y) * v)});
    }
    auto point = [&](const Ray& ray, const PrimHit& h, Vec3& n) {
        const Triangle& t = c.g.triangles[h.prim];
        Vec3 a = c.g.positions[t.v[0]];
        n = normalize(cross(c.g.positions[t.v[1]] - a, c.g.positions[t.v[2]] - a));
        if (dot(n, ray.d) > 0) n = -n;
        return ray.o + h.t * ray.d + 1e-4f * n;
    };
    for (int k = 0; k < 2; k++)
        for (const Ray& ray : kinds[static_cast<size_t>(k)].rays) {
            PrimHit h = closest_hit(bvh, c.g, ray);
            if (h.prim == PrimHit::none) continue;
            Vec3 n, p = point(ray, h, n);
            float z = 2 * r.u1() - 1, phi = 2 * pi * r.u1(), q = std::sqrt(1 - z * z);
            kinds[static_cast<size_t>(k) + 1].rays.push_back(
                {p, normalize(n + 0.999f * Vec3{q * std::cos(phi), q * std::sin(phi), z})});
            if (k == 0) {
                Vec3 l =
                    c.light + c.light_size * (Vec3{r.u1(), r.u1(), r.u1()} - Vec3{.5f, .5f, .5f});
                kinds[3].rays.push_back({p, l - p, 0.999f});
            }
        }
    return kinds;
}

#ifdef HAVE_EMBREE
struct Embree {
    RTCDevice device;
    RTCScene scene;
    double seconds;
    int64_t bytes = 0;
    Embree(const Geometry& g, RTCBuildQuality quality, RTCSceneFlags flags,
           const char* config = "threads=1") {
        device = rtcNewDevice(config);
        rtcSetDeviceMemoryMonitorFunction(
            device,
            [](void* p, ssize_t b, bool) {
                *static_cast<int64_t*>(p) += b;
                return true;
            },
            &bytes);
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, flags);
        rtcSetSceneBuildQuality(scene, quality);
        RTCGeometry geom = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* p = rtcSetNewGeometryBuffer(geom, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                          g.positions.size());
        std::memcpy(p, g.positions.data(), 12 * g.positions.size());
        auto* q = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            geom, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, g.triangles.size()));
        for (const Triangle& t : g.triangles)
            for (uint32_t i : t.v) *q++ = i;
        rtcCommitGeometry(geom);
        rtcAttachGeometry(scene, geom);
        rtcReleaseGeometry(geom);
        double t = now();
        rtcCommitScene(scene);
        seconds = now() - t;
    }
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    double run(const Kind& k) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        double sum = 0;
        for (const Ray& r : k.rays) {
            if (k.any) {
                RTCRay q{r.o.x, r.o.y, r.o.z, 0, r.d.x, r.d.y, r.d.z, 0, r.t_max, ~0u, 0, 0};
                rtcOccluded1(scene, &context, &q);
                sum += q.tfar < 0;
            } else {
                RTCRayHit q{{r.o.x, r.o.y, r.o.z, 0, r.d.x, r.d.y, r.d.z, 0, r.t_max, ~0u, 0, 0},
                            {}};
                q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
                rtcIntersect1(scene, &context, &q);
                if (q.hit.geomID != RTC_INVALID_GEOMETRY_ID) sum += q.ray.tfar;
            }
        }
        return sum;
    }
};
#endif
double run_bvh(const Bvh& bvh, const Geometry& g, const Kind& k) {
    double sum = 0;
    for (const Ray& r : k.rays) {
        if (k.any) {
            sum += any_hit(bvh, g, r);
        } else {
            PrimHit h = closest_hit(bvh, g, r);
            if (h.prim != PrimHit::none) sum += h.t;
        }
    }
    return sum;
}
double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
    std::string only = argc > 1 ? argv[1] : "";
    int runs = argc > 2 ? std::atoi(argv[2]) : 5;
    int size = argc > 3 ? std::atoi(argv[3]) : 384;
    std::vector<std::function<Case()>> cases{
        cornell,
        [] { return blob("blob70k", 264); },
        [] { return hall("hall66k", 10, false); },
        [] { return hall("hallturn66k", 10, true); },
        corner,
        [] { return needles("needles20k", 20000, 0.3f, 0.02f); },
        [] { return blob("blob1M", 1000); },
        [] { return hall("hall1.3M", 45, false); }};
    double all = 0;
    int cells = 0;
    std::map<std::string, double> geo;
    for (auto& make : cases) {
        Case c = make();
        if (!only.empty() && c.name.find(only) == std::string::npos) continue;
        double t = now();
        Bvh bvh = build_bvh(c.g, 1);
        double seconds = now() - t, m = static_cast<double>(c.g.triangles.size());
        std::printf("%-12s %8.0f tris  build %.3f s (%.2f s/M)  %4.0f B/tri nodes %zu blocks %zu\n",
                    c.name.c_str(), m, seconds, seconds / m * 1e6,
                    static_cast<double>(bvh.nodes.size() * sizeof(BvhNode) +
                                        bvh.blocks.size() * sizeof(BvhBlock)) /
                        m,
                    bvh.nodes.size(), bvh.blocks.size());
        auto kinds = make_rays(c, bvh, size);
#ifdef HAVE_EMBREE
        Embree medium(c.g, RTC_BUILD_QUALITY_MEDIUM, RTC_SCENE_FLAG_NONE),
            high(c.g, RTC_BUILD_QUALITY_HIGH, RTC_SCENE_FLAG_NONE);
        std::printf("  embree build %.3f / %.3f s, %.0f / %.0f B/tri\n", medium.seconds,
                    high.seconds, static_cast<double>(medium.bytes) / m,
                    static_cast<double>(high.bytes) / m);
#endif
        for (auto& k : kinds) {
            std::vector<double> own, me, hi;
            double so = 0, sm = 0;
            for (int i = 0; i < runs; i++) {
                t = now();
                so = run_bvh(bvh, c.g, k);
                own.push_back(now() - t);
#ifdef HAVE_EMBREE
                t = now();
                sm = medium.run(k);
                me.push_back(now() - t);
                t = now();
                high.run(k);
                hi.push_back(now() - t);
#endif
            }
            double n = static_cast<double>(k.rays.size()) / 1e6;
            double ratio = std::min(median(me), median(hi)) / median(own);
            std::printf("  %-8s %7.2f M/s  embree %6.2f %6.2f  ratio %.2f   (%.4f %.4f)\n",
                        k.name.c_str(), n / median(own), n / median(me), n / median(hi), ratio,
                        so / n, sm / n);
            all += std::log(ratio);
            cells++;
            geo[k.name] += std::log(ratio);
        }
        std::fflush(stdout);
    }
    std::printf("geomean %.3f  ", std::exp(all / cells));
    for (auto& [k, s] : geo) std::printf(" %s %.3f", k.c_str(), std::exp(s / cells * 4));
    std::printf("\n");
}
