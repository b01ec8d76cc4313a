// A chapter's estimator, as the renderer calls it, with what the chapter has prepared bound to it;
// and where a path from the camera begins.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "common/base/parallel.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/camera.h"

/// Starts sample `number` of a pixel. Samples of half 1, and audits, have random numbers of their
/// own, from a key that no pixel has.
inline void start_sample(Sampler& sampler, size_t pixel, int half, uint32_t number) {
    constexpr uint32_t another_key = 1u << 31;
    sampler.start(static_cast<uint32_t>(pixel) | (half == 1 ? another_key : 0), number);
}

/// A uniformly distributed point of pixel (x, y) on the film, in pixels from its top left, from the
/// first two numbers of a sample. The mean over rays through such points is the pixel's average: a
/// box filter. `centre`: always the pixel's centre, a mistake that chapter 16 shows.
///
/// tested by  "identity: a camera sample is a point of its pixel, at the next two numbers"
inline Vec2 film_point(int x, int y, Sampler& sampler, bool centre = false) {
    Vec2 u = sampler.u2();
    if (centre) u = {0.5f, 0.5f};
    return {static_cast<float>(x) + u.x, static_cast<float>(y) + u.y};
}

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
    /// From a function object that has the parameters of trace, but for the splats.
    template <class Sample>
    requires(!std::is_same_v<Sample, Method>) Method(Sample sample)
        : trace([=](const Scene& scene, const Ray& ray, Splats&, Sampler& sampler,
                    Recorder& recorder) { return sample(scene, ray, sampler, recorder); }) {}
    /// One sample, without what it adds to other pixels.
    Rgb operator()(const Scene& scene, const Ray& ray, Sampler& sampler, Recorder& recorder) const {
        Splats none;
        return trace(scene, ray, none, sampler, recorder);
    }
};

/// What was prepared once, or what a pass prepares anew. As a call it would make 22 6 % slower.
template <class T>
[[gnu::always_inline]] inline const auto& prepared(const T& own) {
    if constexpr (requires { own.use_count(); })
        return *own;
    else
        return own;
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
            return trace(scene, prepared(own)..., ray, sampler, recorder);
        } else if constexpr (has_splats) {
            trace(scene, prepared(own)..., splats, sampler, recorder);
            return {};
        } else {
            return trace(scene, prepared(own)..., ray, splats, sampler, recorder);
        }
    };
    return method;
}
