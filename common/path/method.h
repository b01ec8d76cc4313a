// A chapter's estimator, as the renderer calls it, with what the chapter has prepared bound to it.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "common/base/parallel.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/scene.h"

/// The statistics of the pilot samples of one half of a pixel: mean and sum of (sample - mean)^2 of
/// each channel, computed as in RunningStats.
struct PilotPixel {
    uint32_t n = 0, rays = 0;
    double mean[3] = {}, m2[3] = {};

    void add(Rgb L) {
        double x[3] = {double{L.r}, double{L.g}, double{L.b}}, share = 1.0 / ++n;
        for (int c : {0, 1, 2}) {
            double delta = x[c] - mean[c];
            mean[c] += share * delta;
            m2[c] += delta * (x[c] - mean[c]);
        }
    }
};
struct Pilot {
    int width = 0;
    std::vector<PilotPixel> half[2] = {};
};

/// The number of samples of each pixel.
using SamplesOf = std::function<uint32_t(size_t pixel)>;

/// How samples are distributed unevenly among pixels, after a pilot with as many for each. The
/// samples of a pixel alternate between two halves: sample number 2 k + h is number k of half h.
struct Allocation {
    uint32_t pilot = 0;  // samples of each pixel; 0: no allocation, all pixels get the same

    /// Decides the numbers of samples from the pilot. Empty: already decided.
    std::function<void(const Pilot& pilot, int threads)> choose_densities = {};

    /// The numbers of samples in a half, for `spp` samples per pixel on average. They grow with
    /// spp, and are the same for all pixels up to the end of the pilot.
    std::function<SamplesOf(int half, uint32_t spp)> samples = {};
};

/// What a chapter hands to the renderer.
struct Method {
    /// One sample of the radiance that arrives along the ray. Paths that start at lights add
    /// contributions to other pixels to the splats.
    std::function<Rgb(const Scene&, const Ray&, Splats&, Sampler&, Recorder&)> trace;
    bool splats = false;  // whether it adds any

    /// Prepares something for each pass, such as photons. A pass is one sample of every pixel; its
    /// samples depend on each other, since they share what was prepared. What is prepared for one
    /// pass must not depend on what is prepared for another. Called before sample number `pass` of
    /// any pixel; if `stopped()`, it returns early, and the pass does not start. Empty: nothing.
    std::function<void(uint32_t pass, int threads, const Stopped& stopped)> prepare = {};
    float first_radius = 0;  // m, in which photons of the first pass count; 0: there are none

    Allocation allocation = {};  // of samples to pixels

    Method() = default;
    /// From a function object that has the parameters of trace, or all but the splats.
    template <class Sample>
    requires(!std::is_same_v<Sample, Method>) Method(Sample sample) {
        constexpr bool adds_splats =
            std::is_invocable_v<Sample, const Scene&, Ray, Splats&, Sampler&, Recorder&>;
        splats = adds_splats;
        if constexpr (adds_splats)
            trace = std::move(sample);
        else
            trace = [=](const Scene& scene, const Ray& ray, Splats&, Sampler& sampler,
                        Recorder& recorder) { return sample(scene, ray, sampler, recorder); };
    }
    /// One sample, without what it adds to other pixels.
    Rgb operator()(const Scene& scene, const Ray& ray, Sampler& sampler, Recorder& recorder) const {
        Splats none;
        return trace(scene, ray, none, sampler, recorder);
    }
};

/// Copies number by number: `volatile` forbids wider loads, which would have to wait until the
/// numbers just written have reached the cache.
inline Ray copy_of(const volatile Ray& ray) {
    return {
        {ray.o.x, ray.o.y, ray.o.z}, {ray.d.x, ray.d.y, ray.d.z}, ray.t_max, ray.time, ray.from};
}

/// What was prepared once, or what a pass prepares anew. As a call it would make 22 6 % slower.
template <class T>
[[gnu::always_inline]] inline const T& prepared(const T& once) {
    return once;
}
template <class T>
[[gnu::always_inline]] inline const T& prepared(const std::shared_ptr<T>& in_each_pass) {
    return *in_each_pass;
}

/// A chapter's trace(), with what the chapter has prepared as its arguments after the scene. It may
/// have splats, as in chapter 22; in chapter 20 it has these alone, and no ray.
///
/// gnu::flatten inlines all that trace() calls, which makes it a fifth faster.
template <auto trace, class... Own>
Method method_of(Own... own) {
    using Function = decltype(trace);
    constexpr bool has_ray = std::is_invocable_v<Function, const Scene&, decltype(prepared(own))...,
                                                 Ray, Sampler&, Recorder&>;
    constexpr bool has_splats =
        std::is_invocable_v<Function, const Scene&, decltype(prepared(own))..., Splats&, Sampler&,
                            Recorder&>;
    Method method;
    method.splats = !has_ray;
    method.trace = [... own = std::move(own)](const Scene& scene, [[maybe_unused]] const Ray& ray,
                                              [[maybe_unused]] Splats& splats, Sampler& sampler,
                                              Recorder& recorder) __attribute__((flatten))
                       ->Rgb {
        if constexpr (has_ray) {
            return trace(scene, prepared(own)..., copy_of(ray), sampler, recorder);
        } else if constexpr (has_splats) {
            trace(scene, prepared(own)..., splats, sampler, recorder);
            return {};
        } else {
            return trace(scene, prepared(own)..., ray, splats, sampler, recorder);
        }
    };
    return method;
}
