// What a chapter hands to the programs: its trace(), with all that it needs beside the scene.
#pragma once
#include <functional>

#include "common/path/path_log.h"
#include "common/path/sampler.h"
#include "common/path/splats.h"

/// A chapter's estimator: one sample of the radiance that arrives along the ray.
using Trace = std::function<Rgb(const Scene&, Ray, Sampler&, PathLog&)>;

/// The same for a chapter whose paths also begin at lights: what they bring to whatever pixels they
/// meet goes into the splats, that of the ray's own pixel is returned.
using SplatTrace = std::function<Rgb(const Scene&, Ray, Splats&, Sampler&, PathLog&)>;

/// A chapter's trace(), and what the chapter has prepared for it and hands in behind the scene.
///
/// gnu::flatten makes one piece of code of all that trace() calls: a fifth faster.
template <auto trace, class... Own>
Trace trace_with(Own... own) {
    return [... own = std::move(own)](const Scene& scene, Ray ray, Sampler& sampler, PathLog& log)
        __attribute__((flatten)) {
        return trace(scene, own..., ray, sampler, log);
    };
}

/// The same for a chapter whose trace() also adds splats.
template <auto trace, class... Own>
SplatTrace splat_trace_with(Own... own) {
    return [... own = std::move(own)](const Scene& scene, Ray ray, Splats& splats, Sampler& sampler,
                                      PathLog& log) __attribute__((flatten)) {
        return trace(scene, own..., ray, splats, sampler, log);
    };
}

/// A chapter's trace_light(), which needs no ray.
template <auto trace_light, class... Own>
SplatTrace trace_light_with(Own... own) {
    return [... own = std::move(own)](const Scene& scene, Ray, Splats& splats, Sampler& sampler,
                                      PathLog& log) __attribute__((flatten)) {
        trace_light(scene, own..., splats, sampler, log);
        return Rgb{};
    };
}
