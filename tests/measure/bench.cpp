// Rays per second of the hierarchy of common/, beside Embree where it is installed, on one thread.
#include <cstdio>
#include <cstring>
#include <functional>

#include "common/base/error.h"
#include "common/geometry/bvh.h"
#include "common/material/basic_bsdf.h"
#include "common/path/sampler.h"
#include "common/scene/camera.h"
#include "common/scene/prepare.h"
#include "tests/measure/measure.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
constexpr bool have_embree = true;
#else
constexpr bool have_embree = false;
#endif

namespace {

struct RaySet {
    std::string name;
    bool any;  // asks for any hit, not for the nearest
    std::vector<Ray> rays = {};
};

/// From the camera; from where those hit, in proportion to the cosine, and once more from there.
/// From where the first hit: to the middle of a lamp, and a short way up.
std::vector<RaySet> rays_for(const Scene& scene, const Bvh& bvh, int size) {
    std::vector<RaySet> sets = {{"primary", false},
                                {"bounce", false},
                                {"second bounce", false},
                                {"shadow", true},
                                {"short", true}};
    const Geometry& g = scene.geometry;
    CameraView view = camera_view(scene.camera, size, size);
    Sampler sampler(SamplerType::independent, 3, 1);
    for (int i = 0; i < size * size; i++) {
        sampler.start(static_cast<uint32_t>(i), 0);
        Vec2 u = sampler.u2();
        Ray ray = camera_ray(
            view, {static_cast<float>(i % size) + u.x, static_cast<float>(i / size) + u.y});
        sets[0].rays.push_back(ray);
        for (size_t bounce = 1; bounce <= 2; bounce++) {
            PrimHit hit = closest_hit(bvh, g, ray);
            if (hit.prim == PrimHit::none) break;
            auto [a, b, c] = g.triangles[hit.prim].v;
            Vec3 n = cross(g.positions[b] - g.positions[a], g.positions[c] - g.positions[a]);
            n = normalize(dot(n, ray.d) > 0 ? -n : n);
            Vec3 foot = ray.o + hit.t * ray.d + 1e-4f * n;
            auto by_cosine = [&] {
                return Frame(n).to_world(sample_cosine_hemisphere(sampler.u2()));
            };
            if (bounce == 1) {
                size_t count = scene.light_shapes.size();
                Vec3 light = scene.light_shapes[static_cast<size_t>(i) % count].centre;
                float reach = 0.05f * scene.radius;
                sets[3].rays.push_back({foot, light - foot, 0.999f});
                sets[4].rays.push_back({foot, by_cosine(), reach});
            }
            ray = {foot, by_cosine()};
            sets[bounce].rays.push_back(ray);
        }
    }
    return sets;
}

/// Something that finds hits: traces all rays, and returns a sum over what it found.
using Contender = std::function<double(const RaySet&)>;

template <class Closest, class Any>
Contender contender(const Closest& closest, const Any& any_hit) {
    return [=](const RaySet& set) {
        double sum = 0;
        for (const Ray& ray : set.rays) {
            float t = !set.any ? closest(ray) : any_hit(ray) ? 1.0f : infinity;
            if (t < infinity) sum += double{t};
        }
        return sum;
    };
}

/// Embree over the triangles of a mesh, called as ours is: one ray at a time.
Contender embree(const Geometry& g) {
#if __has_include(<embree3/rtcore.h>)
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                              sizeof(Vec3), g.positions.size());
    std::memcpy(positions, g.positions.data(), sizeof(Vec3) * g.positions.size());
    auto* index = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(uint32_t), g.triangles.size()));
    for (const Triangle& t : g.triangles)
        for (uint32_t v : t.v) *index++ = v;
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcCommitScene(scene);
    auto as_embree = [](const Ray& r) {
        return RTCRay{r.o.x, r.o.y, r.o.z, 0, r.d.x, r.d.y, r.d.z, 0, r.t_max, ~0u, 0, 0};
    };
    auto closest = [=](const Ray& r) {
        RTCRayHit hit = {as_embree(r), {}};
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene, &context, &hit);
        return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? infinity : hit.ray.tfar;
    };
    auto any = [=](const Ray& r) {
        RTCRay ray = as_embree(r);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(scene, &context, &ray);
        return ray.tfar < 0;
    };
    return contender(closest, any);
#else
    static_cast<void>(g);
    return {};
#endif
}

/// M rays/s: the median over runs in which all take turns, so that what else the machine does slows
/// all of them alike.
std::vector<double> speeds(const std::vector<Contender>& contenders, const RaySet& set, int runs) {
    std::vector<std::vector<double>> of(contenders.size());
    for (int run = 0; run < runs; run++) {
        for (size_t i = 0; i < contenders.size(); i++) {
            double start = cpu_seconds();
            volatile double sum = contenders[i](set);
            static_cast<void>(sum);
            of[i].push_back(1e-6 * static_cast<double>(set.rays.size()) / (cpu_seconds() - start));
        }
    }
    std::vector<double> medians;
    for (const auto& s : of) medians.push_back(median(s));
    return medians;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        constexpr int runs = 5, size = 384;  // of which the median counts; size^2 primary rays
        parse_options(
            argc, argv, "",
            "M rays/s of `four` of chapter 06, of common/geometry, and of Embree where it "
            "is installed (libembree-dev), on one thread. Writes out/bench.tsv.",
            {}, [](const std::string& word) {
                throw UsageError("error: bench takes options alone, not '" + word + "'");
            });
        const std::vector<std::string> scenes = {
            "scenes/knot.pbrt", "scenes/pool.pbrt",
            "tests/pictures/real-scenes/modern-hall/scene-v4.pbrt"};
        Work work("bench: rays per second on one thread", static_cast<double>(scenes.size()));
        Table table{
            {"M rays/s, ours / Embree", "primary", "bounce", "second bounce", "shadow", "short"},
            {}};
        for (const std::string& path : scenes) {
            work.next(path);
            Scene scene = load_scene_for(path, {.threads = 1});
            Geometry& g = scene.geometry;
            g.spheres.clear(), g.disks.clear();  // Embree gets triangles alone
            Bvh bvh = build_bvh(g, 1);
            std::vector<Contender> contenders = {
                contender([&](const Ray& ray) { return closest_hit(bvh, g, ray).t; },
                          [&](const Ray& ray) { return any_hit(bvh, g, ray); })};
            if (have_embree) contenders.push_back(embree(g));
            table.rows.push_back({scene_name(path)});
            for (const RaySet& set : rays_for(scene, bvh, size)) {
                std::string cell;
                for (double s : speeds(contenders, set, runs))
                    cell += (cell.empty() ? "" : " / ") + short_number(s);
                table.rows.back().push_back(cell);
            }
        }
        std::printf("%s", markdown(table).c_str());
        write_table("out", "bench", table);
        return 0;
    });
}
