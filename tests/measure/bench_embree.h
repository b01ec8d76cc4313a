// Embree, where it is installed, called as the hierarchy of common/ is: one ray at a time.
#pragma once
#include <cstdint>
#include <cstring>

#include "common/geometry/geometry.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>

inline constexpr bool have_embree = true;

/// Embree's hierarchy over the triangles of a mesh.
class Embree {
public:
    /// Copies the mesh; commit() then builds.
    Embree(const Geometry& g, bool high_quality, int threads)
        : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
        auto count = [](void* bytes, ssize_t change, bool) {
            *static_cast<int64_t*>(bytes) += change;
            return true;
        };
        rtcSetDeviceMemoryMonitorFunction(device_, count, &bytes_);
        scene_ = rtcNewScene(device_);
        rtcSetSceneBuildQuality(scene_,
                                high_quality ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* positions = rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), g.positions.size());
        std::memcpy(positions, g.positions.data(), sizeof(Vec3) * g.positions.size());
        auto* index = static_cast<uint32_t*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(uint32_t), g.triangles.size()));
        for (const Triangle& t : g.triangles) {
            for (uint32_t v : t.v) *index++ = v;
        }
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
        mesh_bytes_ = bytes_;
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    void commit() { rtcCommitScene(scene_); }
    /// Of the hierarchy alone.
    double bytes() const { return static_cast<double>(bytes_ - mesh_bytes_); }

    /// The distance to the first hit, or infinity.
    float closest_t(const Ray& r) {
        RTCRayHit hit = {as_embree(r), {}};
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_, &context, &hit);
        return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? infinity : hit.ray.tfar;
    }
    bool any_hit(const Ray& r) {
        RTCRay ray = as_embree(r);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(scene_, &context, &ray);
        return ray.tfar < 0;
    }

private:
    static RTCRay as_embree(const Ray& r) {
        return {r.o.x, r.o.y, r.o.z, 0, r.d.x, r.d.y, r.d.z, 0, r.t_max, ~0u, 0, 0};
    }

    int64_t bytes_ = 0, mesh_bytes_ = 0;
    RTCDevice device_;
    RTCScene scene_;
};

#else

inline constexpr bool have_embree = false;

class Embree {
public:
    Embree(const Geometry&, bool, int) {}
    void commit() {}
    double bytes() const { return 0; }
    float closest_t(const Ray&) { return infinity; }
    bool any_hit(const Ray&) { return false; }
};

#endif
