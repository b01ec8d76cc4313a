#include "common/render/render.h"

#include "common/render/explain.h"
#include "common/render/results.h"
#include "common/render/stop.h"

namespace {

/// Renders to find the brightest sample, and explains it. A lamp that is seen directly, or only via
/// mirrors and glass, is bright in all samples, so it is no firefly: without --paths, only light
/// that a diffuse or rough surface has scattered counts.
int find_and_explain(const Scene& scene, const RenderOptions& options, const Method& method) {
    RenderOptions whole = options;
    whole.split.clear();
    whole.film.clear();
    if (whole.paths.empty()) whole.paths = "L.*D.*E";
    StopOnSignal signal;
    Rendering r = render_film(scene, whole, method);
    signal.take_request();  // the signal ended the render; explain the sample found so far
    int code = explain(scene, explain_brightest(options, r), method);
    return code == 0 && r.stats.interrupted ? 3 : code;
}

}  // namespace

int render(const Scene& scene, const RenderOptions& options, const Method& method) {
    StopOnSignal until_all_is_written;
    check_outputs(scene, options);
    if (options.explain_brightest) return find_and_explain(scene, options, method);
    if (options.explain) return explain(scene, options, method);
    return write_results(scene, options, render_film(scene, options, method));
}
