// A chapter's trace() as a function object, with the chapter's prepared data bound to it.
#pragma once
#include <functional>
#include <type_traits>

#include "common/base/parallel.h"
#include "common/path/sampler.h"
#include "common/path/splats.h"
#include "common/recording/recorder.h"

/// A chapter's estimator: one sample of the radiance that arrives along the ray.
using Trace = std::function<Rgb(const Scene&, Ray, Sampler&, Recorder&)>;

/// The estimator of a chapter whose paths also start at lights: it returns the radiance along the
/// ray, and adds contributions to other pixels to the splats.
using SplatTrace = std::function<Rgb(const Scene&, Ray, Splats&, Sampler&, Recorder&)>;

/// The estimator of a chapter that prepares something for each pass, such as photons. A pass is one
/// sample of every pixel; its samples depend on each other, since they share what was prepared.
/// What is prepared for one pass must not depend on what is prepared for another.
struct PassTrace {
    /// Called before sample number `pass` of any pixel. If `stopped()`, it returns early, and the
    /// pass does not start.
    std::function<void(uint32_t pass, int threads, const Stopped& stopped)> prepare;
    Trace trace;
    float first_radius = 0;  // m, in which photons of the first pass count; 0: there are none
};

/// The estimator of a chapter that prepares something for each pass, and also adds splats.
struct SplatPassTrace {
    std::function<void(uint32_t pass, int threads, const Stopped& stopped)> prepare;
    SplatTrace trace;
    float first_radius = 0;
};

template <class AnyTrace>
inline constexpr bool adds_splats =
    std::is_same_v<AnyTrace, SplatTrace> || std::is_same_v<AnyTrace, SplatPassTrace>;
template <class AnyTrace>
inline constexpr bool has_passes =
    std::is_same_v<AnyTrace, PassTrace> || std::is_same_v<AnyTrace, SplatPassTrace>;

/// Copies number by number: `volatile` forbids wider loads, which would have to wait until the
/// numbers just written have reached the cache.
inline Ray copy_of(const volatile Ray& ray) {
    return {
        {ray.o.x, ray.o.y, ray.o.z}, {ray.d.x, ray.d.y, ray.d.z}, ray.t_max, ray.time, ray.from};
}

/// A chapter's trace(), with what the chapter has prepared as its arguments after the scene.
///
/// gnu::flatten inlines all that trace() calls, which makes it a fifth faster.
template <auto trace, class... Own>
Trace trace_with(Own... own) {
    return [... own = std::move(own)](const Scene& scene, const Ray& ray, Sampler& sampler,
                                      Recorder& recorder) __attribute__((flatten)) {
        return trace(scene, own..., copy_of(ray), sampler, recorder);
    };
}

/// trace_with for a chapter whose trace() also adds splats.
template <auto trace, class... Own>
SplatTrace splat_trace_with(Own... own) {
    return [... own = std::move(own)](const Scene& scene, const Ray& ray, Splats& splats,
                                      Sampler& sampler, Recorder& recorder)
        __attribute__((flatten)) {
        return trace(scene, own..., ray, splats, sampler, recorder);
    };
}

/// A chapter's trace_light(), which needs no ray.
template <auto trace_light, class... Own>
SplatTrace trace_light_with(Own... own) {
    return [... own = std::move(own)](const Scene& scene, Ray, Splats& splats, Sampler& sampler,
                                      Recorder& recorder) __attribute__((flatten)) {
        trace_light(scene, own..., splats, sampler, recorder);
        return Rgb{};
    };
}
