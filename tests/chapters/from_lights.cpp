// The light of paths from lights, for each chapter that shows it: 20, by splats, and 22 to 25.
#include <doctest/doctest.h>

#include "chapters/20_light_tracing/estimator.h"
#include "chapters/22_fast_bidirectional/estimator.h"
#include "chapters/23_photon_mapping/estimator.h"
#include "chapters/25_vertex_merging/estimator.h"
#include "tests/support/known_lights.h"
#include "tests/support/light_paths.h"
#include "tests/support/photons.h"

namespace {

Method by_20(const Scene& scene, const PhotonSettings&) {
    return method_of<ch20::trace_light>(ch20::endpoints_of(scene));
}
Method by_22(const Scene& scene, const PhotonSettings&) {
    return method_of<ch22::trace>(ch22::prepare(scene));
}
Method by_23(const Scene& scene, const PhotonSettings& s) {
    return ch23::photon_passes(
        scene, ch23::PhotonSettings{s.sampler, s.seed, s.light_paths, s.final_gathering, s.radius});
}
Method by_25(const Scene& scene, const PhotonSettings& s) { return ch25::merging_passes(scene, s); }

/// A chapter with its photons, and how well it knows the mean of a picture from its samples.
struct Way {
    std::string name;
    Method (*of)(const Scene&, const PhotonSettings&);
    int spp;
    double relative_se;
    int light_paths = 0;
    bool final_gathering = true;
};

}  // namespace

TEST_SUITE("from lights") {
    TEST_CASE("truth: irradiance of all lights, by paths from lights" * doctest::skip()) {
        // The picture shows a square of 10 cm around the origin.
        const Way ways[] = {{"20", by_20, 48000, 0.05},
                            {"23", by_23, 100, 0.05, 40000},
                            {"23, photons alone", by_23, 72, 0.05, 40000, false}};
        auto all = lights_of_known_irradiance;
        all.insert(all.end(), lights_without_size.begin(), lights_without_size.end());
        for (const auto& [light, E] : all) {
            if (E < 0.1) continue;  // too few paths come here
            Scene scene = scene_of(
                "LookAt 0 0.05 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 90\n"
                "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
                "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Scale .1 1 "
                ".1 " +
                square(0, true) + "AttributeEnd\n" + light);
            scene.max_depth = 1;
            for (const Way& way : ways) {
                CAPTURE(way.name);
                Method method = way.of(scene, {.light_paths = way.light_paths,
                                               .final_gathering = way.final_gathering,
                                               .radius = 0.02f});
                Measured m = picture_of(scene, method, way.spp);
                double truth = 0.5 * E / pi_exact;
                CHECK(std::abs(m.mean - truth) < 5 * m.se + 0.003 * truth);  // not quite even
                CHECK(m.se < way.relative_se * truth);
            }
        }
    }

    TEST_CASE("truth: the flux of a spot of light does not depend on the radius" *
              doctest::skip()) {
        const Way ways[] = {
            {"20", by_20, 1000, 0.01},       {"22", by_22, 1000, 0.01},
            {"23", by_23, 32, 0.004, 40000}, {"23, photons alone", by_23, 32, 0.004, 40000, false},
            {"25", by_25, 512, 0.04, 4000},  {"25, few paths", by_25, 512, 0.04, 100}};
        const SpotByMirror spot;
        for (const Way& way : ways) {
            for (float radius : {0.06f, 0.15f, 0.4f}) {
                CAPTURE(way.name);
                CAPTURE(radius);
                PhotonSettings settings{.sampler = SamplerType::sobol,
                                        .light_paths = way.light_paths,
                                        .final_gathering = way.final_gathering,
                                        .radius = radius};
                Method method = way.of(spot.scene, settings);
                Measured m = picture_of(spot.scene, method, way.spp, "LSDE");
                CHECK(std::abs(m.mean - spot.mean) < 5 * m.se);
                CHECK(m.se < way.relative_se * spot.mean);
            }
        }
    }
}
