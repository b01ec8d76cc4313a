#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/light/light_table.h"
#include "common/material/basic_bsdf.h"
#include "common/material/hit.h"
#include "common/path/sampler.h"
#include "common/picture/drawing.h"
#include "common/render/render.h"
#include "common/scene/intersect.h"
#include "common/scene/prepare.h"
#include "common/scene/sky_image.h"

namespace {

constexpr double too_much = 0.01;     // of a picture, in one sample
constexpr double negligible = 0.001;  // standard error, of the mean: no noise to warn of
constexpr double few_samples = 100;   // effective samples: below, intervals are too short
constexpr double much_blur = 0.1;     // of the standard error
constexpr double few_pixels = 30, few_audits = 16;  // that the error is estimated from
constexpr double few_hits = 50;                     // of a light that is found by random hits
constexpr double few_reflections = 20;              // of a light, found via metal
constexpr double few_paths = 10;                    // from lights, to a part of the scene

/// Warnings: conditions and lines.
struct Lines : std::vector<std::string> {
    void warn(bool is_so, const std::string& line) {
        if (is_so) push_back(line);
    }
};

/// Whether a surface reflects light, and is neither mirror nor glass.
bool is_receiver(const Material& m) {
    return !is_specular(m) &&
           !is_black(is_rough(m) ? fresnel_conductor(1, m.eta, m.k) : m.reflectance);
}

/// What rays through the middles of all pixels meet.
struct InView {
    double pixels = 0, hits = 0, backs = 0;   // numbers of rays; those that meet a back side
    double mirrors = 0, receivers = 0;        // mirrors and glass; see is_receiver()
    double every = 1;                         // hits for each of the
    std::vector<std::pair<Ray, Hit>> points;  // about 1000 of them
};
InView in_view(const Scene& scene) {
    InView seen;
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    int pixels = scene.width * scene.height, every = 1 + pixels / 1000, hits = 0;
    seen.pixels = pixels, seen.every = every;
    for (int i = 0; i < pixels; i++) {
        Ray ray = pixel_ray(scene, view, i);
        std::optional<Hit> hit = intersect(scene, ray);
        if (!hit) continue;
        seen.hits++, seen.backs += !hit->front;
        seen.mirrors += is_specular(*hit->material), seen.receivers += is_receiver(*hit->material);
        if (hits++ % every == 0) seen.points.emplace_back(ray, *hit);
    }
    return seen;
}

/// Whether no light and no surface in view face each other.
bool all_face_away(const Scene& scene, const InView& seen) {
    size_t lights = std::min<size_t>(scene.lights.size(), 64);
    Sampler sampler(SamplerType::independent, 1, 1);
    sampler.start(0, 0);
    for (const auto& [ray, x] : seen.points)
        for (size_t l = 0; l < lights; l++) {
            LightSample y = sample_one_light(scene, l, x, sampler.u2());
            if (is_receiver(*x.material) && y.pdf_w > 0 && dot(y.wi, x.n) > 0) return false;
        }
    return !scene.sky_image;
}

/// m^2: the area of the scene's bounding sphere.
double sphere_around(const Scene& scene) {
    return 4 * std::numbers::pi * double{scene.radius} * double{scene.radius};
}

/// m^2: a light's power falls evenly on so large an area around p, if nothing is in its way.
///
///   point, area  4 pi d^2;   distant  pi R^2;   sky  4 pi R^2
double spread_of(const Scene& scene, size_t i, Vec3 p) {
    const Light& light = scene.lights[i];
    const LightShape& shape = scene.light_shapes[i];
    double d = double{scene.radius};
    if (light.type == LightType::distant) d = d / 2;
    if (light.type == LightType::point) d = double{length(light.p - p)};
    if (light.type == LightType::area) d = double{std::max(length(shape.centre - p), shape.radius)};
    return 4 * std::numbers::pi * d * d;
}

/// The share that each light has of all light at p, if nothing is in its way.
std::vector<double> shares_at(const Scene& scene, Vec3 p) {
    std::vector<double> shares;
    for (size_t i = 0; i < scene.lights.size(); i++)
        shares.push_back(double{light_power(scene, i)} / spread_of(scene, i, p));
    double all = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (double& share : shares) share /= all;
    return shares;
}

/// Whether an important light is so small that fewer than `few` random directions hit it: in a
/// closed room each part of the walls is hit in proportion to its area, at most the area of the
/// scene's bounding sphere.
bool has_small_light(const Scene& scene, double directions, double few) {
    std::vector<double> shares = shares_at(scene, scene.camera.o);
    for (size_t i = 0; i < shares.size(); i++) {
        bool is_important = scene.lights[i].type != LightType::infinite && shares[i] > 0.01;
        double hits = directions * double{scene.light_shapes[i].area} / sphere_around(scene);
        if (is_important && hits < few) return true;
    }
    return false;
}

/// Whether metal is so smooth that its lobe rarely leads `paths` paths to a light.
///
/// A path finds a light reflected in metal if a sampled point of the light lies in the metal's
/// lobe, or if a sampled direction of the lobe hits the light. The expected number of hits of N
/// paths:
///
///   hits = N (alpha^2 + size),   size = A / (4 pi d^2)
///
/// Here each of the two terms alone must be too small; for the second see has_small_light().
/// Measured with a metal plate beside a floor, a lamp of 0.5 to 9 degrees and alpha from 0.001 to
/// 0.1: intervals cover the truth in 10 to 87 % of the runs for hits up to 8, in 93 % and more from
/// 25 on.
bool is_nearly_mirror(const Material& m, double paths) {
    double alpha = double{m.alpha};
    bool is_smooth = alpha < 0.1 && paths * alpha * alpha < few_reflections;
    return is_smooth && is_rough(m) && is_receiver(m);
}

/// Whether a surface in view faces another one that reflects light.
bool surfaces_face_each_other(const Scene& scene, const InView& seen) {
    Sampler sampler(SamplerType::independent, 1, 1);
    uint32_t i = 0;
    return std::any_of(seen.points.begin(), seen.points.end(), [&](const auto& point) {
        const Hit& x = point.second;
        sampler.start(0, i++);
        Vec3 wi = Frame(x.n).to_world(sample_cosine_hemisphere(sampler.u2()));
        std::optional<Hit> y = intersect(scene, spawn_ray(x, wi));
        return is_receiver(*x.material) && y && is_receiver(*y->material);
    });
}

/// Of the light to those materials that the camera sees, from some lights, if nothing is in its
/// way: the share that so few of `paths` paths carry that each carries more than a tenth of it. The
/// area is about that of all pixels, if each shows as much as the median of them.
double share_by_few_paths(const Scene& scene, const InView& seen, double paths,
                          const std::function<bool(const Material&)>& is_to,
                          const std::function<bool(const Light&)>& is_from) {
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Vec3 pixel = cross(view.dx, view.dy);
    std::vector<std::pair<double, size_t>> areas;  // of a pixel; number of the point
    for (size_t i = 0; i < seen.points.size(); i++) {
        const auto& [ray, x] = seen.points[i];
        float a = dot(pixel, ray.d), b = a / dot(pixel, view.corner);  // a b^2: its solid angle
        float area = std::abs(a / dot(ray.d, x.ng)) * b * b * x.t * x.t;
        if (is_to(*x.material)) areas.emplace_back(area, i);
    }
    if (areas.empty()) return 0;
    std::sort(areas.begin(), areas.end());
    auto [area, median] = areas[areas.size() / 2];
    area *= static_cast<double>(areas.size()) * seen.every;
    Vec3 middle = seen.points[median].second.p;
    Light image;  // of the sky
    image.type = LightType::infinite;
    bool has_image = scene.sky_image && is_from(image);
    if (has_image && paths * area < few_paths * sphere_around(scene)) return 1;

    std::vector<double> pmf = light_pmf(scene, 0.25), shares = shares_at(scene, middle);
    double all = 0, by_few = 0;
    for (size_t i = 0; i < pmf.size(); i++) all += is_from(scene.lights[i]) ? shares[i] : 0;
    for (size_t i = 0; i < pmf.size(); i++) {
        double hit = std::min(1.0, area / spread_of(scene, i, middle)), share = shares[i] / all;
        if (is_from(scene.lights[i]) && paths * pmf[i] * hit < few_paths * share) by_few += share;
    }
    return by_few;
}

/// Light that this chapter's search misses in the scene, or finds too rarely for its reported error
/// to be true. It follows from sizes and distances of lights and materials, what rays through the
/// pixels meet, and the number of samples. Photons find all light, but blur it.
Lines missed_light(const Scene& scene, const RenderOptions& o, const Film& film) {
    using enum LightSearch;
    const double samples = static_cast<double>(film.samples()), mean = film.mean(),
                 error = film.standard_error();
    auto any_material = [&](auto is) {
        return std::any_of(scene.shapes.begin(), scene.shapes.end(),
                           [&](const Shape& s) { return is(scene.materials[s.material]); });
    };
    auto is_metal = [](const Material& m) {
        return is_receiver(m) && m.type != MaterialType::diffuse;
    };
    auto is_smooth_metal = [&](const Material& m) { return is_nearly_mirror(m, samples); };
    auto is_delta = [](const Light& light) {
        return light.type == LightType::point || light.type == LightType::distant;
    };
    bool has_delta = false, has_area = false, is_near = false;
    for (const Light& light : scene.lights) {
        has_delta |= is_delta(light);
        has_area |= light.type == LightType::area;
    }
    const bool mirrors = any_material(is_specular), receivers = any_material(is_receiver),
               casts = mirrors && receivers && scene.max_depth > 1;
    const bool starts_at_lights = o.search == both_ends || o.search == merging;
    const bool looks = o.search == from_lights || o.search == direct || starts_at_lights;
    const InView seen = looks ? in_view(scene) : InView{};
    const std::string larger = "the true error may be larger than the reported one",
                      at_random = "found only by random hits: " + larger,
                      is_left_out =
                          "from a point or distant light is left out: no path can hit such a light",
                      by_mirrors = "light that reaches a surface through mirrors or glass ";
    Lines lines;

    lines.warn(o.search == random_hits && !has_delta && has_small_light(scene, samples, few_hits),
               "this chapter finds lights only by random hits, and one is so small that few paths "
               "hit it: " +
                   larger);

    if (o.search == from_lights) {
        double metal = 0, share = seen.mirrors / seen.pixels;
        for (const auto& [ray, x] : seen.points) metal += is_smooth_metal(*x.material);
        metal *= seen.every / seen.pixels;
        double few = share_by_few_paths(scene, seen, samples, is_receiver,
                                        [](const Light&) { return true; });
        bool is_missing = few > 0 && few * mean >= 2 * error * (1 - few);
        lines.warn(o.paths.empty() && metal * mean > error,
                   percent(metal) +
                       " of the picture shows metal that is nearly a mirror: few paths from a "
                       "light leave it towards the camera, so " +
                       larger);
        lines.warn(o.paths.empty() && scene.max_depth > 0 && is_missing,
                   "so few paths from a light reach what the camera sees that its light may be "
                   "missing: " +
                       larger);
        lines.warn(share > 0, percent(share) +
                                  " of the picture shows a mirror or glass: this part is black, "
                                  "because no vertex on it can be connected to the camera");
    }

    if (o.search == light_sampling) {
        // By default, chapter 13 samples lights only; later chapters also sample the metal's BSDF.
        Notes::value_type by_light = {"strategy", "light"};
        bool is_rare = std::count(o.own.begin(), o.own.end(), by_light) > 0 || scene.sky_image ||
                       has_small_light(scene, samples, few_reflections);
        lines.warn(is_rare && any_material(is_smooth_metal),
                   "light that reaches a surface via nearly smooth metal is " + at_random);
        lines.warn(casts && has_delta, by_mirrors + is_left_out);
        lines.warn(casts && (has_area || scene.sky_image), by_mirrors + "is " + at_random);
    }

    if (o.search == direct && scene.max_depth > 0) {
        // Below a disk, at twice its radius, a point is 25 % too bright, and more if nearer.
        for (const LightShape& lamp : scene.light_shapes)
            for (const auto& [ray, x] : seen.points)
                is_near |= lamp.flat && length(lamp.centre - x.p) < 2 * std::sqrt(lamp.area / pi);
        lines.warn(scene.sky_light >= 0 && receivers,
                   "light that surfaces receive from the sky is left out: the sky is seen only "
                   "directly and in mirrors");
        lines.warn(is_near,
                   "a lamp near a surface lights it as if all came from the lamp's middle: the "
                   "reported error does not include this");
        lines.warn(scene.max_depth > 1 && !mirrors && surfaces_face_each_other(scene, seen),
                   "light that one surface reflects to another is left out");
        lines.warn(casts, by_mirrors +
                              "is left out, and so is light that one surface reflects to another");
    }

    if (starts_at_lights) {
        auto casts_light = [&](const Material& m) { return is_specular(m) || is_smooth_metal(m); };
        double few = share_by_few_paths(scene, seen, samples, casts_light, is_delta);
        bool is_seen =
            casts && scene.max_depth > 2 && (o.search == both_ends || any_material(is_metal));
        const std::string both =
            "light that goes through mirrors or glass to a surface that the camera sees in mirrors "
            "or glass ";
        lines.warn(receivers && scene.max_depth > 1 && few > 0.01,
                   "hardly any path from a point or distant light hits a mirror, glass or smooth "
                   "metal: the light that these cast on surfaces may be missing");
        lines.warn(is_seen && has_delta, both + is_left_out);
        lines.warn(is_seen && !has_delta && has_area, both + "is " + at_random);
    }
    return lines;
}

}  // namespace

std::vector<std::string> warnings_of(const Film& film, const SampleCounts& counts,
                                     const std::string& place) {
    Lines lines;
    double samples = static_cast<double>(film.samples()), mean = film.mean(), sum = mean * samples;
    const Film::Error basis = film.error();
    double error = basis.standard, effective = basis.samples;
    double empty =
        static_cast<double>(film.empty_pixels()) / static_cast<double>(film.pixels().size());
    bool has_noise = !(error < negligible * mean);  // or it is unknown
    double excess = std::max(counts.largest - mean, 0.0);
    bool one_in_many =
        basis.pixels < few_pixels && basis.squares > 0 && excess * excess > 0.05 * basis.squares;
    // If light is even, half of the photons lie in the inner half of their disk. What is not there
    // is about the part by which blur changes the light that they bring.
    double half = static_cast<double>(counts.photons) / 2;
    double blur = std::abs(static_cast<double>(counts.inner_photons) / half - 1);
    bool is_told_by_means = film.has_audits() || film.has_halves();
    const std::string half_or_twice = ": the true one may be half or twice as large";

    lines.warn(empty > 0, "rendering ended before " + percent(empty) +
                              " of the pixels had a sample: they are black");
    lines.warn(samples > 0 && sum == 0, "the picture is black: no sample found light");
    lines.warn(
        sum > 0 && counts.largest > too_much * sum,
        "one sample contains " + percent(counts.largest / sum) + " of the whole picture" + place);
    lines.warn(
        has_noise && effective > 0 && effective < few_samples,
        "as few as " + std::to_string(std::lround(effective)) +
            " samples determine the picture: the true error is larger than the reported one");
    lines.warn(has_noise && one_in_many && effective >= few_samples,
               "a few bright samples determine the error: the true error is larger than the "
               "reported one");
    lines.warn(film.has_batches() && film.spp() > 1 && film.spp() < few_audits,
               "the error is estimated from few passes" + half_or_twice);
    lines.warn(half > 0 && !(blur * mean < much_blur * error),
               "photons blur light within their radius: the reported error does not include this "
               "bias");
    lines.warn(is_told_by_means && basis.squares > 0 && basis.audits < few_audits,
               "the error is estimated from few pixels" + half_or_twice);
    return lines;
}

std::vector<std::string> warnings_of(const Scene& scene, const RenderOptions& options,
                                     const Rendering& r) {
    const std::optional<SampleAt>& at = r.stats.largest_at;
    Lines lines{warnings_of(r.film, r.stats, at ? ": see --explain " + at->text() : "")};
    if (r.film.samples() > 0 && r.film.mean() == 0) {
        InView seen = in_view(scene);
        lines.warn(seen.hits == 0,
                   "possible cause: the camera sees no surface: see its LookAt, fov and Scale");
        lines.warn(seen.receivers > 0 && all_face_away(scene, seen),
                   "possible cause: the lights and all that is in view face away from each other: "
                   "ReverseOrientation turns a light, \"bool twosided\" true lights both sides");
    }
    for (const std::string& line : missed_light(scene, options, r.film)) lines.push_back(line);
    lines.insert(lines.end(), r.warnings.begin(), r.warnings.end());
    return lines;
}
