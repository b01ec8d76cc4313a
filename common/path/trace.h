// What a chapter hands to the programs: its trace(), with all that it needs beside the scene.
#pragma once
#include <functional>

#include "common/base/parallel.h"
#include "common/path/sampler.h"
#include "common/path/splats.h"
#include "common/recording/recorder.h"

/// A chapter's estimator: one sample of the radiance that arrives along the ray.
using Trace = std::function<Rgb(const Scene&, Ray, Sampler&, Recorder&)>;

/// The estimator of a chapter whose paths also begin at lights: what they bring to whatever pixels
/// they meet goes into the splats; the radiance along the ray itself is returned.
using SplatTrace = std::function<Rgb(const Scene&, Ray, Splats&, Sampler&, Recorder&)>;

/// The estimator of a chapter that prepares something anew for each sample: the samples of all
/// pixels that have the same number make a pass, and depend on each other by what was prepared. So
/// that passes do not, paths from the eye have independent numbers here: --sampler is for what is
/// prepared.
struct PassTrace {
    /// Before sample number `pass` is taken of any pixel. Ends early when `stopped()`, and that
    /// pass is then not begun.
    std::function<void(uint32_t pass, int threads, const Stopped& stopped)> prepare;
    Trace trace;
};

/// A copy, number by number: `volatile` forbids to copy more at once, for which the processor would
/// have to wait until all that was just written is in memory.
inline Ray copy_of(const volatile Ray& ray) {
    return {
        {ray.o.x, ray.o.y, ray.o.z}, {ray.d.x, ray.d.y, ray.d.z}, ray.t_max, ray.time, ray.from};
}

/// A chapter's trace(), and what the chapter has prepared for it and hands in behind the scene.
///
/// gnu::flatten makes one piece of code of all that trace() calls: a fifth faster.
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
        return trace(scene, own..., copy_of(ray), splats, sampler, recorder);
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
