#include "chapters/07_path_tracing/estimator.h"
#include "tests/measure/methods.h"

/// Wrong on purpose: uniform directions, but divided by the density of cosine ones.
static Rgb trace_wrong_pdf(const Scene& scene, Ray ray, Sampler& sampler, Recorder&) {
    Rgb L, beta = {1, 1, 1};
    for (int depth = 0;; depth++) {
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) return L + beta * scene.sky;
        L += beta * emission(scene, *x);
        if (depth == scene.max_depth || is_specular(*x->material)) return L;
        Vec3 wi = Frame(x->n).to_world(ch07::sample_uniform_hemisphere(sampler.u2()));
        beta *= x->material->reflectance;
        ray = spawn_ray(*x, wi);
    }
}

[[maybe_unused]] static const bool added[] = {
    add_method({.name = "07",
                .label = "07 path tracing",
                .color = "#888888",
                .finds_light = "by chance",
                .scenes = {"cornell", "color-bleeding"},
                .refuse = {refuse_glossy, refuse_delta_lights},
                .render = by_trace([](const Scene&) { return trace_with<ch07::trace>(); })}),
    add_method({.name = "wrong-pdf",
                .label = "07 with a wrong pdf",
                .color = "#000000",
                .finds_light = "by chance",
                .refuse = {refuse_glossy, refuse_delta_lights},
                .render = by_trace([](const Scene&) { return Trace(trace_wrong_pdf); }),
                .biased = true}),
};
