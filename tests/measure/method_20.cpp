#include "chapters/20_light_tracing/estimator.h"
#include "common/base/error.h"
#include "tests/measure/methods.h"

/// What mirrors and glass show the camera is missing.
static void refuse_seen_mirrors(const Scene& scene) {
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (is_specular(m)) throw InputError("error: " + scene.file + " has mirrors or glass");
    }
}

static Rendering by_light(const Scene& scene, const RenderOptions& options) {
    return render_film(scene, options, method_of<ch20::trace_light>(ch20::endpoints_of(scene)));
}

[[maybe_unused]] static const bool added = add_method({.name = "20",
                                                       .label = "20 light tracing",
                                                       .color = "#224400",
                                                       .finds_light = "from the light",
                                                       .scenes = {"cornell", "two-lights"},
                                                       .refuse = {refuse_seen_mirrors},
                                                       .render = by_light,
                                                       .search = LightSearch::from_lights});
