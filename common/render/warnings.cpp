#include "common/render/warnings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/percent.h"
#include "common/light/light_table.h"
#include "common/material/cosine.h"
#include "common/material/metal.h"
#include "common/path/light_paths.h"
#include "common/path/sampler.h"
#include "common/scene/camera.h"
#include "common/scene/intersect.h"

namespace {

constexpr double too_much = 0.01;     // of a picture, in one sample
constexpr double negligible = 0.001;  // standard error, of the mean: no noise to warn of
constexpr double few_samples = 100;   // effective samples: below, intervals are too short
constexpr double much_blur = 0.1;     // of the standard error
constexpr double few_pixels = 30, few_audits = 16;  // that the error is estimated from
constexpr double few_hits = 50;                     // of a light that is found by random hits
constexpr double few_reflections = 20;              // of a light, found via metal
constexpr double few_paths = 10;                    // from lights, to the mirrors of a scene
constexpr double few_missed = 0.01;                 // of the surfaces in view

using Lines = std::vector<std::string>;
/// When a line is told.
struct Rule {
    bool holds;
    std::string line;
};
Lines told(const std::vector<Rule>& rules) {
    Lines lines;
    for (const Rule& rule : rules)
        if (rule.holds) lines.push_back(rule.line);
    return lines;
}

/// Whether a surface reflects light, and is neither mirror nor glass.
bool is_receiver(const Material& m) {
    return !is_specular(m) &&
           !is_black(is_rough(m) ? fresnel_conductor(1, m.eta, m.k) : m.reflectance);
}

/// Mirrors, glass, and metal so smooth that its lobe rarely leads `paths` paths to a light.
///
/// A path finds a light reflected in metal if a sampled point of the light lies in the metal's
/// lobe. The expected number of hits of N paths is N alpha^2.
/// Measured beside lamps of 0.5 to 9 degrees: intervals cover the truth in 10 to 87 % of the runs
/// for up to 8 hits, in 93 % and more from 25 on.
bool is_like_mirror(const Material& m, double paths) {
    double alpha = double{m.alpha};
    bool is_smooth = is_rough(m) && is_receiver(m) && paths * alpha * alpha < few_reflections;
    return is_specular(m) || is_smooth;
}

/// Whether a random point of a random light shines on x.
bool is_lit(const Scene& scene, const Hit& x, Sampler& sampler) {
    size_t lights = scene.lights.size() + (scene.sky_image ? 1 : 0);
    size_t i = static_cast<size_t>(sampler.u1() * static_cast<float>(lights));
    LightSample y{Frame(x.n).to_world(sample_cosine_hemisphere(sampler.u2())), {}, infinity, 1};
    if (i < scene.lights.size()) y = sample_one_light(scene, i, x, sampler.u2());
    return y.pdf_w > 0 && dot(y.wi, x.n) > 0 && !occluded(scene, spawn_ray(x, y.wi, y.dist));
}

/// Whether a picture has a hole around a pixel: noise leaves hardly ever 25 pixels black.
bool is_hole(const Image& picture, int x, int y) {
    for (int j = std::max(0, y - 2); j < std::min(picture.height, y + 3); j++)
        for (int i = std::max(0, x - 2); i < std::min(picture.width, x + 3); i++)
            if (!is_black(picture.at(i, j))) return false;
    return true;
}

/// What rays through the middles of all pixels meet, in numbers of pixels.
struct InView {
    double pixels = 0, mirrors = 0, receivers = 0;
    double missed = 0;  // receivers in holes of the picture, though lit
};
InView in_view(const Scene& scene, const Image& picture, double paths) {
    InView seen;
    CameraView view = camera_view(scene.camera, picture.width, picture.height);
    Sampler sampler(SamplerType::independent, 1, 1);
    for (int i = 0; i < picture.width * picture.height; i++) {
        int x = i % picture.width, y = i / picture.width;
        Vec2 middle = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
        std::optional<Hit> hit = intersect(scene, camera_ray(view, middle));
        seen.pixels++;
        if (!hit) continue;
        sampler.start(0, static_cast<uint32_t>(i));
        bool receives = is_receiver(*hit->material);
        seen.mirrors += is_like_mirror(*hit->material, paths);
        seen.receivers += receives;
        seen.missed += receives && is_hole(picture, x, y) && is_lit(scene, *hit, sampler);
    }
    return seen;
}

/// m^2: a light's power falls evenly on so large an area around p, if nothing is in its way.
///
///   point, area  4 pi d^2;   distant  pi R^2;   sky  4 pi R^2
double spread_of(const Scene& scene, size_t i, Vec3 p) {
    const Light& light = scene.lights[i];
    const LightShape& shape = scene.light_shapes[i];
    float d = scene.radius;
    if (light.type == LightType::distant) d = scene.radius / 2;
    if (light.type == LightType::point) d = length(light.p - p);
    if (light.type == LightType::area) d = std::max(length(shape.centre - p), shape.radius);
    return 4 * std::numbers::pi * double{d} * double{d};
}

/// Whether a lamp that brings more than 1 % of the light to the camera is so small that random hits
/// are too rare: in a closed room each part of the walls is hit in proportion to its area, at most
/// the area of the scene's bounding sphere.
bool has_rare_lamp(const Scene& scene, double samples) {
    double R = double{scene.radius}, sphere = 4 * std::numbers::pi * R * R, all = 0;
    std::vector<double> light;
    for (size_t i = 0; i < scene.lights.size(); i++) {
        light.push_back(double{light_power(scene, i)} / spread_of(scene, i, scene.camera.o));
        all += light.back();
    }
    for (size_t i = 0; i < light.size(); i++) {
        bool counts = scene.lights[i].type == LightType::area && light[i] > 0.01 * all;
        double area = double{scene.light_shapes[i].area};
        if (counts && samples * area / sphere < few_hits) return true;
    }
    return false;
}

bool is_delta(const Light& light) {
    return light.type == LightType::point || light.type == LightType::distant;
}

/// Whether few paths from a point or distant light hit any mirror, glass or metal like a mirror.
bool are_mirrors_rare(const Scene& scene, double paths) {
    double area = 0;  // of the outlines, about
    Vec3 middle;
    auto shape_of = [](const auto& primitive) { return primitive.shape; };
    for (uint32_t i = 0; i < scene.geometry.size(); i++) {
        uint32_t shape = visit(scene.geometry, i, shape_of, shape_of, shape_of);
        if (!is_like_mirror(scene.materials[scene.shapes[shape].material], paths)) continue;
        Emitter e = emitter_of(scene, i);
        float outline = area_of(e) / 4;
        area += double{outline};
        middle += outline * e.p0;
    }
    if (area == 0 || scene.max_depth < 2) return false;
    middle = middle / static_cast<float>(area);
    Endpoints endpoints = endpoints_of(scene);
    for (size_t i = 0; i < scene.lights.size(); i++) {
        double hit = std::min(1.0, area / spread_of(scene, i, middle));
        double pmf = (1 - endpoints.p_image) * double{pmf_light(endpoints.lights, i)};
        if (is_delta(scene.lights[i]) && paths * pmf * hit < few_paths) return true;
    }
    return false;
}

/// Light that this chapter's search misses in the scene, or finds too rarely for its reported error
/// to be true. It follows from sizes and distances of lights and materials, what rays through the
/// pixels meet, and the number of samples.
Lines missed_light(const Scene& scene, const RenderOptions& options, const Film& film) {
    const double samples = static_cast<double>(film.samples());
    auto any_material = [&](auto is) {
        return std::any_of(scene.shapes.begin(), scene.shapes.end(),
                           [&](const Shape& s) { return is(scene.materials[s.material]); });
    };
    auto like_mirror = [&](const Material& m) { return is_like_mirror(m, samples); };
    auto is_lamp = [](const Light& light) { return light.type == LightType::area; };
    const bool mirrors = any_material(is_specular), receivers = any_material(is_receiver),
               casts = mirrors && receivers && scene.max_depth > 1,
               metal_casts = any_material(like_mirror) && receivers && scene.max_depth > 1,
               has_delta = std::ranges::any_of(scene.lights, is_delta),
               has_area = std::ranges::any_of(scene.lights, is_lamp) || scene.sky_image;
    const std::string larger = "the true error may be larger than the reported one",
                      by_chance = "is found only by chance: " + larger,
                      is_left_out =
                          "from a point or distant light is left out: no path can hit such a light",
                      by_mirrors = "light that reaches a surface through mirrors or glass ",
                      both_ends =
                          "light that goes through mirrors or glass to a surface that the camera "
                          "sees in mirrors or glass ";
    switch (options.search) {
        case LightSearch::photons: break;  // they find all light, but blur it
        case LightSearch::by_chance:
            return told({{has_rare_lamp(scene, samples),
                          "this chapter finds lights only by chance, and one is so small that few "
                          "paths hit it: " +
                              larger}});
        case LightSearch::from_lights: {
            InView seen = in_view(scene, film.image(), samples);
            return told(
                {{options.paths.empty() && scene.max_depth > 0 &&
                      seen.missed > few_missed * seen.receivers,
                  "no path from a light has reached " + percent(seen.missed / seen.receivers) +
                      " of the surfaces in view, though light falls on them: " + larger},
                 {seen.mirrors > 0,
                  percent(seen.mirrors / seen.pixels) +
                      " of the picture shows mirrors, glass or nearly smooth metal, and is "
                      "too dark there: no path from a light, or hardly any, leaves them "
                      "towards the camera"}});
        }
        case LightSearch::light_sampling:
            return told({{casts && has_delta, by_mirrors + is_left_out},
                         {casts && has_area, by_mirrors + by_chance},
                         {metal_casts && !casts && (has_area || has_delta),
                          "light that reaches a surface via nearly smooth metal " + by_chance}});
        case LightSearch::direct:
            return told({{receivers && scene.max_depth > 0,
                          "this chapter lights surfaces from the middle of each lamp, and leaves "
                          "out the light of the sky, of other surfaces, and through mirrors and "
                          "glass: the error is not reported"}});
        case LightSearch::both_ends:
        case LightSearch::merging: {
            auto is_metal = [](const Material& m) { return is_rough(m) && is_receiver(m); };
            bool merges = options.search == LightSearch::merging;
            bool is_seen = casts && scene.max_depth > 2 && (!merges || any_material(is_metal));
            return told({{receivers && has_delta && are_mirrors_rare(scene, samples),
                          "hardly any path from a point or distant light hits a mirror, glass or "
                          "smooth metal: the light that these cast on surfaces may be missing"},
                         {is_seen && has_delta, both_ends + is_left_out},
                         {is_seen && !has_delta && has_area, both_ends + by_chance}});
        }
    }
    return {};
}

}  // namespace

Lines warnings_of(const Film& film, const SampleCounts& counts, const std::string& place) {
    double samples = static_cast<double>(film.samples()), mean = film.mean(), sum = mean * samples;
    double error = film.standard_error(), effective = film.effective_samples();
    double empty =
        static_cast<double>(film.empty_pixels()) / static_cast<double>(film.pixels().size());
    bool has_noise = !(error < negligible * mean);  // or it is unknown
    Film::ErrorBasis basis = film.error_basis();
    double excess = std::max(counts.largest - mean, 0.0);
    bool one_in_many =
        basis.pixels < few_pixels && basis.squares > 0 && excess * excess > 0.05 * basis.squares;
    // If light is even, half of the photons lie in the inner half of their disk. What is not there
    // is about the part by which blur changes the light that they bring.
    double half = static_cast<double>(counts.photons) / 2;
    double blur = std::abs(static_cast<double>(counts.inner_photons) / half - 1);
    bool few_means = (film.has_audits() || film.has_halves()) && basis.squares > 0 &&
                     basis.audits < few_audits,
         few_passes = film.has_batches() && film.spp() > 1 && film.spp() < few_audits;
    const std::string larger = ": the true error is larger than the reported one";
    return told(
        {{empty > 0, "rendering ended before " + percent(empty) +
                         " of the pixels had a sample: they are black"},
         {samples > 0 && sum == 0,
          "the picture is black, since no sample found light: see whether the camera sees a "
          "surface "
          "(LookAt, fov, Scale), a light shines on it (ReverseOrientation, twosided), and depth, "
          "--paths and samples suffice"},
         {sum > 0 && counts.largest > too_much * sum,
          "one sample contains " + percent(counts.largest / sum) + " of the whole picture" + place},
         {has_noise && effective > 0 && effective < few_samples,
          "as few as " + std::to_string(std::lround(effective)) + " samples determine the picture" +
              larger},
         {has_noise && one_in_many && effective >= few_samples,
          "a few bright samples determine the error" + larger},
         {few_means || few_passes, "the error is estimated from few " +
                                       std::string(few_passes ? "passes" : "pixels") +
                                       ": the true one may be half or twice as large"},
         {half > 0 && !(blur * mean < much_blur * error),
          "photons blur light within their radius: the reported error does not include this "
          "bias"}});
}

Lines warnings_of(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    std::string at = r.stats.largest_at();
    Lines lines = warnings_of(r.film, r.stats, at.empty() ? "" : ": see --explain " + at);
    for (const Lines& more : {missed_light(scene, options, r.film), r.warnings})
        lines.insert(lines.end(), more.begin(), more.end());
    return lines;
}
