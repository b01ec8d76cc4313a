#include "common/program/render.h"

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/program/explain.h"
#include "common/program/film_keeping.h"
#include "common/program/lamp_edges.h"
#include "common/program/outputs.h"
#include "common/program/progress.h"
#include "common/program/results.h"
#include "common/program/tile_renderer.h"

namespace {

Film empty_film(const Scene& scene, bool takes_splats) {
    uint64_t pixels = static_cast<uint64_t>(scene.width) * static_cast<uint64_t>(scene.height);
    std::string what =
        "a film of " + std::to_string(scene.width) + "x" + std::to_string(scene.height) + " pixels";
    return needing_memory(what, (takes_splats ? 3 : 1) * pixels * sizeof(PixelSum),
                          [&] { return Film(scene.width, scene.height, takes_splats); });
}

uint32_t fewest_samples(const Film& film) {
    uint32_t fewest = film.pixels()[0].n;
    for (const PixelSum& p : film.pixels()) fewest = std::min(fewest, p.n);
    return fewest;
}

/// Takes samples `wanted.first` to `wanted.last` - 1 of each pixel, except those already in the
/// film.
///
/// A pass takes each pixel once, or more often if there are too few pixels to keep all threads
/// busy; but not more often than all passes before it, so that an early end leaves no pixel empty.
template <class AnyTrace>
void take_samples(const Scene& scene, const RenderOptions& options, const AnyTrace& trace,
                  const Allocation& allocation, const Limit& limit, SampleRange wanted,
                  Rendering& result) {
    bool goes_on = !options.film.empty() && allocation.pilot == 0;
    uint32_t done = goes_on ? fewest_samples(result.film) : 0;
    FilmClock clock(scene, options);
    Progress progress(options.quiet);
    TileRenderer renderer(scene, options, trace, allocation, limit, clock, result, wanted.first);
    uint32_t pixels = static_cast<uint32_t>(scene.width) * static_cast<uint32_t>(scene.height);
    uint32_t most_per_pass = std::max(1u, (1u << 20) / pixels), spp = wanted.last - wanted.first;
    while (done < spp && !limit.reached()) {
        uint32_t next = done + std::min(std::clamp(done, 1u, most_per_pass), spp - done);
        bool in_pilot = wanted.first == 0 && done < allocation.pilot;
        if (in_pilot) next = std::min(next, allocation.pilot);
        if constexpr (renderer.has_passes) {
            next = done + 1;
            try {
                trace.prepare(wanted.first + done, options.threads,
                              [&] { return limit.reached(); });
            } catch (const TracingEnds&) {
            }
            if (limit.reached()) break;
        }
        result.begun = std::max(result.begun, next);
        renderer.set_goal(wanted.first + next);
        std::atomic<int> tiles = 0;
        parallel_for(renderer.tiles(), options.threads, [&](int tile) {
            renderer.render(tile);
            double of_pass = static_cast<double>(++tiles) / renderer.tiles();
            double seconds = limit.elapsed();
            double by_time = options.time > 0 ? seconds / options.time : 0;
            progress.show(std::max(by_time, (done + (next - done) * of_pass) / spp), seconds);
        });
        if (clock.due()) {
            clock.save(result);  // then continue the same pass
            continue;
        }
        done = next;
        bool decides = in_pilot && done == allocation.pilot && !limit.reached();
        if (decides && allocation.choose_densities) {
            allocation.choose_densities(renderer.take_pilot(), options.threads);
        }
    }
}

template <class AnyTrace>
Rendering render_into(Film empty, const Scene& scene, const RenderOptions& options,
                      const AnyTrace& trace, const Allocation& allocation) {
    Rendering result{std::move(empty), {}, {}};
    Limit limit(options.time);
    TracingLimit tracing([&] { return limit.overdue(); });
    if (allocation.pilot > 0) {
        result.film.start_halves();
    } else if (has_passes<AnyTrace>) {
        result.film.start_batches();
    } else if (options.sampler != SamplerType::independent) {
        try {
            mark_lamp_edges(scene, options.threads, result.film);
        } catch (const TracingEnds&) {
        }
        result.film.start_audit();
    }
    continue_film(scene, options, result);
    SampleRange wanted = wanted_samples(scene, options);

    // Render the pilot again if this render does not start with it.
    Allocation decided = allocation;
    if (allocation.pilot > 0 && (wanted.first > 0 || result.film.samples() > 0)) {
        RenderOptions alone = options;
        alone.film.clear(), alone.split.clear();
        Rendering again{Film(scene.width, scene.height), {}, {}};
        again.film.start_halves();
        SampleRange pilot = {options.seed, 0, allocation.pilot};
        take_samples(scene, alone, trace, allocation, limit, pilot, again);
        decided.choose_densities = {};
    }
    take_samples(scene, options, trace, decided, limit, wanted, result);
    for (auto& [path_class, film] : result.classes) film.count_as(result.film);
    result.stats.seconds = limit.elapsed();
    uint64_t all = uint64_t{static_cast<uint32_t>(scene.width)} *
                   static_cast<uint32_t>(scene.height) * (wanted.last - wanted.first);
    result.stats.interrupted = limit.interrupted() && result.film.samples() < all;
    return result;
}

/// A trace that has no splats, as one that adds none.
SplatTrace without_splats(const Trace& trace) {
    return [&](const Scene& scene, Ray ray, Splats&, Sampler& sampler, Recorder& recorder) {
        return trace(scene, ray, sampler, recorder);
    };
}

/// Explains a sample of a pass, once that is prepared.
template <class AnyPassTrace>
int explain_of_pass(const Scene& scene, const RenderOptions& options, const AnyPassTrace& passes,
                    const SplatTrace& trace) {
    Limit limit(0);
    TracingLimit tracing([&] { return limit.overdue(); });
    uint32_t pass = static_cast<uint32_t>(std::max(0, options.explain_sample));
    try {
        passes.prepare(pass, options.threads, [&] { return limit.reached(); });
    } catch (const TracingEnds&) {
    }
    if (limit.reached()) {
        std::fprintf(stderr, "stopped before there was a path to explain\n");
        return 3;
    }
    RenderOptions as_rendered = options;
    as_rendered.sampler = SamplerType::independent;
    return explain(scene, as_rendered, trace, false);
}

/// Renders to find the brightest sample, and explains it. A lamp that is seen directly, or only via
/// mirrors and glass, is bright in all samples, so it is no firefly: without --paths, only light
/// that a diffuse or rough surface has scattered counts.
template <class AnyTrace, class... More>
int find_and_explain(const Scene& scene, const RenderOptions& options, const AnyTrace& trace,
                     const More&... more) {
    RenderOptions whole = options;
    whole.split.clear();
    if (whole.paths.empty()) whole.paths = "L.*D.*E";
    StopOnSignal signal;
    Rendering r = render_film(scene, whole, trace, more...);
    signal.take_request();  // the signal ended the render; explain the sample found so far
    int code = render(scene, explain_brightest(options, r), trace, more...);
    return code == 0 && r.stats.interrupted ? 3 : code;
}

}  // namespace

Rendering render_film(const Scene& scene, const RenderOptions& options, const Trace& trace,
                      const Allocation& allocation) {
    return render_into(empty_film(scene, false), scene, options, trace, allocation);
}
Rendering render_film(const Scene& scene, const RenderOptions& options, const SplatTrace& trace) {
    return render_into(empty_film(scene, true), scene, options, trace, {});
}
Rendering render_film(const Scene& scene, const RenderOptions& options, const PassTrace& trace) {
    return render_into(empty_film(scene, false), scene, options, trace, {});
}
Rendering render_film(const Scene& scene, const RenderOptions& options,
                      const SplatPassTrace& trace) {
    return render_into(empty_film(scene, true), scene, options, trace, {});
}

int render(const Scene& scene, const RenderOptions& options, const Trace& trace,
           const Allocation& allocation) {
    StopOnSignal until_all_is_written;
    check_outputs(scene, options);
    if (options.explain_brightest) return find_and_explain(scene, options, trace, allocation);
    if (options.explain)
        return explain(scene, options, without_splats(trace), allocation.pilot > 0);
    return write_results(scene, options, render_film(scene, options, trace, allocation));
}
int render(const Scene& scene, const RenderOptions& options, const SplatTrace& trace) {
    StopOnSignal until_all_is_written;
    check_outputs(scene, options);
    if (options.explain_brightest) return find_and_explain(scene, options, trace);
    if (options.explain) return explain(scene, options, trace, false);
    return write_results(scene, options, render_film(scene, options, trace));
}
int render(const Scene& scene, const RenderOptions& options, const PassTrace& trace) {
    StopOnSignal until_all_is_written;
    check_outputs(scene, options);
    if (options.explain_brightest) return find_and_explain(scene, options, trace);
    if (options.explain) return explain_of_pass(scene, options, trace, without_splats(trace.trace));
    return write_results(scene, options, render_film(scene, options, trace));
}
int render(const Scene& scene, const RenderOptions& options, const SplatPassTrace& trace) {
    StopOnSignal until_all_is_written;
    check_outputs(scene, options);
    if (options.explain_brightest) return find_and_explain(scene, options, trace);
    if (options.explain) return explain_of_pass(scene, options, trace, trace.trace);
    return write_results(scene, options, render_film(scene, options, trace));
}
