// What holds for each of chapters 20 to 25, whose paths begin at lights.
#include <doctest/doctest.h>

#include "tests/traces/20.h"
#include "tests/traces/21.h"
#include "tests/traces/22.h"
#include "tests/traces/23.h"
#include "tests/traces/24.h"
#include "tests/traces/25.h"
#include "tests/support/known_lights.h"
#include "tests/support/light_paths.h"
#include "tests/support/photons.h"

namespace {

Method by_20(const Scene& scene, const PhotonSettings&) {
    return method_of<ch20::trace_light>(ch20::endpoints_of(scene));
}
Method by_21(const Scene& scene, const PhotonSettings&) {
    return method_of<ch21::trace>(endpoints_of(scene));
}
Method by_22(const Scene& scene, const PhotonSettings&) {
    return method_of<ch22::trace>(ch22::prepare(scene));
}
Method by_23(const Scene& scene, const PhotonSettings& s) {
    return passes_of<ch23::photon_passes>(
        scene, ch23::PhotonSettings{s.sampler, s.seed, s.light_paths, s.final_gathering, s.radius});
}
Method by_24(const Scene& scene, const PhotonSettings& s) {
    return passes_of<ch24::photon_passes>(scene, s);
}
Method by_25(const Scene& scene, const PhotonSettings& s) {
    return passes_of<ch25::merging_passes>(scene, s);
}

/// A chapter, and the samples of each pixel with which it knows the mean of a picture. 0: where
/// nothing is a mirror or glass, each of its samples is that of the chapter before.
struct Way {
    std::string name;
    Method (*of)(const Scene&, const PhotonSettings&);
    int spp = 0;
    bool final_gathering = true;
};
const std::vector<Way> ways = {{"20", by_20, 48000},
                               {"21", by_21, 400},
                               {"22", by_22, 400},
                               {"23", by_23, 100},
                               {"24", by_24},
                               {"25", by_25},
                               {"23, photons alone", by_23, 72, false}};

}  // namespace

TEST_SUITE("from lights") {
    TEST_CASE("truth: irradiance of all lights, by paths from lights" * doctest::skip()) {
        // The picture shows a square of 10 cm around the origin.
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
                if (way.spp == 0) continue;
                CAPTURE(way.name);
                Method method = way.of(scene, {.light_paths = 40000,
                                               .final_gathering = way.final_gathering,
                                               .radius = 0.02f});
                Measured m = picture_of(scene, method, way.spp);
                double truth = 0.5 * E / pi_exact;
                CHECK(std::abs(m.mean - truth) < 5 * m.se + 0.003 * truth);  // not quite even
                CHECK(m.se < 0.05 * truth);
            }
        }
    }

    TEST_CASE("truth: the flux of a spot of light does not depend on the radius" *
              doctest::skip()) {
        struct {
            Way way;
            int light_paths;
            double relative_se;
        } cases[] = {{{"20", by_20, 1000}, 0, 0.01},
                     {{"22", by_22, 1000}, 0, 0.01},
                     {{"23", by_23, 32}, 40000, 0.004},
                     {{"23, photons alone", by_23, 32, false}, 40000, 0.004},
                     {{"25", by_25, 512}, 4000, 0.04},
                     {{"25, few paths", by_25, 512}, 100, 0.04}};
        const SpotByMirror spot;
        for (const auto& c : cases) {
            for (float radius : {0.06f, 0.15f, 0.4f}) {
                CAPTURE(c.way.name);
                CAPTURE(radius);
                PhotonSettings settings{.sampler = SamplerType::sobol,
                                        .light_paths = c.light_paths,
                                        .final_gathering = c.way.final_gathering,
                                        .radius = radius};
                Method method = c.way.of(spot.scene, settings);
                Measured m = picture_of(spot.scene, method, c.way.spp, "LSDE");
                CHECK(std::abs(m.mean - spot.mean) < 5 * m.se);
                CHECK(m.se < c.relative_se * spot.mean);
            }
        }
    }

    TEST_CASE("identity: parts add up to the whole, error included") {
        Scene scene = scene_from("scenes/cornell-spheres.pbrt", 16, 5);
        scene.spp = 7;
        for (const Way& way : ways) {
            CAPTURE(way.name);
            RenderOptions options;
            options.threads = 2, options.quiet = true;
            Method method = way.of(scene, {.light_paths = 1000});
            Film whole = render_film(scene, options, method).film;
            std::vector<Film> parts;
            options.parts = 3;
            for (int part : {2, 3, 1}) {
                options.part = part;
                parts.push_back(render_film(scene, options, method).film);
            }
            parts[0].add(parts[1]);
            parts[0].add(parts[2]);
            CHECK(parts[0].image().pixels == whole.image().pixels);
            CHECK(parts[0].standard_error() == whole.standard_error());
            CHECK(whole.standard_error() > 0);
        }
    }
}

TEST_SUITE("from lights slow") {
    TEST_CASE("consistency: the reported error is the spread over seeds, with each sampler") {
        // 200 runs know their spread to 5 %. Of photons the reported error is too large where the
        // points of a pass are even over the picture.
        Scene scene = scene_from("scenes/cornell-spheres.pbrt", 16, 5);
        for (const Way& way : ways) {
            CAPTURE(way.name);
            Measured independent;
            for (SamplerType sampler :
                 {SamplerType::independent, SamplerType::stratified, SamplerType::sobol}) {
                RunningStats means, squares;
                for (uint32_t seed = 0; seed < 200; seed++) {
                    PhotonSettings settings{sampler, seed, 500, way.final_gathering};
                    Film film = film_of(scene, way.of(scene, settings), 8, seed, sampler).film;
                    means.add(film.mean());
                    squares.add(std::pow(film.standard_error(), 2));
                }
                double ratio = std::sqrt(squares.mean() / means.variance());
                CAPTURE(ratio);
                CHECK(ratio > 1 / 1.25);
                CHECK(ratio < (way.name < "23" ? 1.25 : 1.5));
                Measured mean = {means.mean(), means.standard_error()};
                if (independent.mean == 0) independent = mean;
                CHECK(z_between(mean, independent) < 5);
                CHECK(mean.se < 0.01 * mean.mean);
            }
        }
    }
}
