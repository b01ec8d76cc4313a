#include "chapters/21_bidirectional/estimator.h"
#include "tests/measure/methods.h"

[[maybe_unused]] static const bool added = add_method(
    {.name = "21",
     .label = "21 bidirectional",
     .color = "#8c2d72",
     .finds_light = "from both ends",
     .scenes = {"cornell-spheres", "cornell", "lamp"},
     .render =
         [](const Scene& scene, const RenderOptions& options) {
             return render_film(scene, options, method_of<ch21::trace>(endpoints_of(scene)));
         },
     .search = LightSearch::both_ends});
