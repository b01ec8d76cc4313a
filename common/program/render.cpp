#include "common/program/render.h"

#include <algorithm>
#include <cstdio>

#include "common/base/report.h"
#include "common/explaining/explain.h"
#include "common/rendering/tile_renderer.h"
#include "common/results/outputs.h"
#include "common/results/results.h"

namespace {

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
        tell("stopped before there was a path to explain\n");
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
