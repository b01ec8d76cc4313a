#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/path/image_light.h"
#include "common/picture/drawing.h"
#include "common/render/render.h"
#include "common/scene/prepare.h"

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
    std::vector<std::pair<Ray, Hit>> points;  // about 1000 of the receivers

    /// Whether is(hit, sampler) is true of one of the points, each with its own random numbers.
    template <class Is>
    bool any(const Is& is) const {
        Sampler sampler(SamplerType::independent, 1, 1);
        uint32_t i = 0;
        return std::any_of(points.begin(), points.end(), [&](const auto& point) {
            sampler.start(0, i++);
            return is(point.second, sampler);
        });
    }
};
InView in_view(const Scene& scene) {
    InView seen;
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    int pixels = scene.width * scene.height, every = 1 + pixels / 1000, receivers = 0;
    for (int i = 0; i < pixels; i++) {
        Ray ray = pixel_ray(scene, view, i);
        std::optional<Hit> hit = intersect(scene, ray);
        if (!hit) continue;
        seen.hits++, seen.backs += !hit->front;
        seen.mirrors += is_specular(*hit->material);
        if (!is_receiver(*hit->material)) continue;
        if (receivers++ % every == 0) seen.points.emplace_back(ray, *hit);
    }
    seen.pixels = pixels, seen.receivers = receivers;
    return seen;
}

/// Whether no light and no surface in view face each other.
bool all_face_away(const Scene& scene, const InView& seen) {
    size_t lights = std::min<size_t>(scene.lights.size(), 64);
    return !scene.sky_image && !seen.any([&](const Hit& x, Sampler& sampler) {
        for (size_t l = 0; l < lights; l++) {
            LightSample y = sample_one_light(scene, l, x, sampler.u2());
            if (y.pdf_w > 0 && dot(y.wi, x.n) > 0) return true;
        }
        return false;
    });
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

/// The lights that bring more than 1 % of the light at p, if nothing is in its way; and their
/// shares of it.
std::vector<std::pair<size_t, double>> important_lights(const Scene& scene, Vec3 p) {
    std::vector<std::pair<size_t, double>> lights;
    double all = 0;
    auto light_of = [&](size_t i) {
        return double{light_power(scene, i)} / spread_of(scene, i, p);
    };
    for (size_t i = 0; i < scene.lights.size(); i++) all += light_of(i);
    for (size_t i = 0; i < scene.lights.size(); i++) {
        if (light_of(i) > 0.01 * all) lights.push_back({i, light_of(i) / all});
    }
    return lights;
}

/// Whether an important light is so small that random hits are too rare: in a closed room each part
/// of the walls is hit in proportion to its area, at most the area of the scene's bounding sphere.
bool has_rare_light(const Scene& scene, double samples) {
    double R = double{scene.radius}, sphere = 4 * std::numbers::pi * R * R;
    for (auto [light, share] : important_lights(scene, scene.camera.o)) {
        bool is_area = scene.lights[light].type == LightType::area;
        double area = double{scene.light_shapes[light].area};
        if (is_area && samples * area / sphere < few_hits) return true;
    }
    return false;
}

/// The outlines of all surfaces of which material they are, about, and their middle.
struct Outlines {
    double area = 0;  // m^2
    Vec3 middle;
};
template <class Is>
Outlines outlines_of(const Scene& scene, const Is& is) {
    Outlines all;
    for (uint32_t i = 0; i < scene.geometry.size(); i++) {
        if (!is(scene.materials[shape_of(scene, i).material])) continue;
        Emitter e = emitter_of(scene, i);
        float area = area_of(e) / 4;
        all.area += double{area};
        all.middle += area * e.p0;
    }
    all.middle = all.middle / static_cast<float>(all.area);
    return all;
}

/// Whether metal is so smooth that its lobe rarely leads `paths` paths to a light.
///
/// A path finds a light reflected in metal if a sampled point of the light lies in the metal's
/// lobe, or if a sampled direction of the lobe hits the light. The expected number of hits of N
/// paths:
///
///   hits = N (alpha^2 + size),   size = A / (4 pi d^2)
///
/// Here each of the two terms alone must be too small.
/// Measured with a metal plate beside a floor, a lamp of 0.5 to 9 degrees and alpha from 0.001 to
/// 0.1: intervals cover the truth in 10 to 87 % of the runs for hits up to 8, in 93 % and more from
/// 25 on.
bool is_nearly_mirror(const Material& m, double paths) {
    double alpha = double{m.alpha};
    return is_rough(m) && is_receiver(m) && paths * alpha * alpha < few_reflections;
}

/// About the share of the picture's light that first hits metal that is nearly a mirror, from
/// lights so small that too few of its reflections hit them. hits_lights: whether BSDF samples
/// count, or light samples alone.
double share_on_smooth_metal(const Scene& scene, double paths, bool hits_lights) {
    Outlines metal =
        outlines_of(scene, [&](const Material& m) { return is_nearly_mirror(m, paths); });
    if (metal.area == 0) return 0;
    if (scene.sky_image) return 1;  // it may hold a sun
    Vec3 to_camera = scene.camera.o - metal.middle;
    double in_view = 4 * std::numbers::pi * double{dot(to_camera, to_camera)}, sum = 0;
    for (auto [light, share] : important_lights(scene, metal.middle)) {
        double spread = spread_of(scene, light, metal.middle), size = 0;
        if (scene.lights[light].type == LightType::infinite) continue;
        if (hits_lights) size = double{scene.light_shapes[light].area} / spread;
        if (paths * size < few_reflections)
            sum += share * std::min(1.0, metal.area / std::min(spread, in_view));
    }
    return sum;
}

/// Whether a surface in view faces another one that reflects light.
bool surfaces_face_each_other(const Scene& scene, const InView& seen) {
    return seen.any([&](const Hit& x, Sampler& sampler) {
        Vec3 wi = Frame(x.n).to_world(sample_cosine_hemisphere(sampler.u2()));
        std::optional<Hit> y = intersect(scene, spawn_ray(x, wi));
        return y && is_receiver(*y->material);
    });
}

/// Whether a flat lamp is so near to a surface in view that it is no point: within twice the radius
/// of a disk of its area. Below a disk a point is 25 % too bright there, and more if nearer.
bool lamps_are_near(const Scene& scene, const InView& seen) {
    return seen.any([&](const Hit& x, Sampler&) {
        auto is_near = [&](const LightShape& lamp) {
            return lamp.flat && length(lamp.centre - x.p) < 2 * std::sqrt(lamp.area / pi);
        };
        return std::any_of(scene.light_shapes.begin(), scene.light_shapes.end(), is_near);
    });
}

/// The probabilities with which chapter 20 starts paths: at the lights, as in chapter 11; then at
/// the pixels of the sky's image, by their light.
std::vector<double> starts_of(const Scene& scene) {
    std::vector<double> pmf = light_pmf(scene, 0.25), cdf = {0};
    if (scene.sky_image) cdf = sky_light::image_cdf(*scene.sky_image, false);
    if (cdf.back() == 0) return pmf;
    double share = pmf.empty() ? 1 : 0.5;
    for (double& p : pmf) p *= 1 - share;
    for (size_t i = 1; i < cdf.size(); i++) pmf.push_back(share * (cdf[i] - cdf[i - 1]));
    return pmf;
}

/// The part of the picture's mean that hardly any path from a light finds: the direct light of
/// those places in view that the fewest paths reach, together fewer than few_paths. A light sample
/// at each place tells how many of `paths` paths from that light reach it.
double light_by_few_paths(const Scene& scene, const InView& seen, double paths) {
    constexpr uint32_t tries = 4;
    std::vector<double> pmf = starts_of(scene), cdf(pmf.size());
    std::partial_sum(pmf.begin(), pmf.end(), cdf.begin());
    if (scene.max_depth == 0 || pmf.empty()) return 0;
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Vec3 pixel = cross(view.dx, view.dy);
    double pixels = seen.receivers / static_cast<double>(tries * seen.points.size());  // of a place
    std::vector<std::pair<double, double>> places;  // paths that reach it; its light
    Sampler sampler(SamplerType::independent, 1, 1);
    for (uint32_t i = 0; i < tries * seen.points.size(); i++) {
        const auto& [ray, x] = seen.points[i / tries];
        sampler.start(0, i);
        double u = to_unit_double(sampler.u2());
        auto light =
            static_cast<size_t>(std::upper_bound(cdf.begin(), cdf.end() - 1, u) - cdf.begin());
        LightSample y;
        float power = pi * scene.radius * scene.radius;
        if (light < scene.lights.size()) {
            y = sample_one_light(scene, light, x, sampler.u2());
            power = light_power(scene, light);
        } else {
            const SkyImage& sky = *scene.sky_image;
            Vec2 uv = sky.point_in(light - scene.lights.size(), sampler.u2());
            float all = static_cast<float>(sky.pixels.size());
            y = {direction_of(sky, uv), sky.at(uv), infinity, all / solid_angle_per_area(sky, uv)};
            power *= average(y.Le) / y.pdf_w;
        }
        float cos_x = dot(y.wi, x.n);
        if (y.pdf_w == 0 || cos_x <= 0 || occluded(scene, spawn_ray(x, y.wi, y.dist))) continue;
        // A path carries power / pmf; this place has this area, and this is its irradiance.
        float a = dot(pixel, ray.d), b = a / dot(pixel, view.corner);  // a b^2: its solid angle
        double area = pixels * double{std::abs(a / dot(ray.d, x.ng)) * b * b * x.t * x.t};
        double E = double{average(y.Le) * cos_x / y.pdf_w};
        Rgb L = glossy_bsdf::eval_bsdf(x, -ray.d, y.wi) * y.Le * (cos_x / y.pdf_w);
        places.emplace_back(paths * E * area / double{power},
                            pixels / seen.pixels * double{average(L)} / pmf[light]);
    }
    std::sort(places.begin(), places.end());
    double reached = 0, light = 0;
    for (auto [here, L] : places) {
        reached += here;
        if (reached < few_paths) light += L;
    }
    return light;
}

/// The share of the light of point and distant lights to mirrors, glass and metal that is nearly a
/// mirror that few paths carry.
double share_by_few_paths_to_mirrors(const Scene& scene, double paths) {
    if (scene.max_depth < 2) return 0;
    Outlines mirrors = outlines_of(
        scene, [&](const Material& m) { return is_specular(m) || is_nearly_mirror(m, paths); });
    if (mirrors.area == 0) return 0;
    std::vector<double> pmf = starts_of(scene);
    double few = 0, all = 0;
    for (size_t i = 0; i < scene.lights.size(); i++) {
        LightType type = scene.lights[i].type;
        if (type != LightType::distant && type != LightType::point) continue;
        double hit = std::min(1.0, mirrors.area / spread_of(scene, i, mirrors.middle));
        double power = hit * double{light_power(scene, i)};
        all += power;
        if (paths * pmf[i] * hit < few_paths) few += power;
    }
    return all > 0 ? few / all : 0;
}

/// The share of the picture that shows metal that is nearly a mirror.
double share_of_smooth_metal(const InView& seen, double paths) {
    double metal = 0, points = static_cast<double>(seen.points.size());
    for (const auto& [ray, x] : seen.points) metal += is_nearly_mirror(*x.material, paths);
    return points > 0 ? metal / points * seen.receivers / seen.pixels : 0;
}

/// Light that this chapter's search misses in the scene, or finds too rarely for its reported error
/// to be true. It follows from sizes and distances of lights and materials, what rays through the
/// pixels meet, and the number of samples. Photons find all light, but blur it.
Lines missed_light(const Scene& scene, const RenderOptions& o, const Film& film) {
    auto any_material = [&](auto is) {
        return std::any_of(scene.shapes.begin(), scene.shapes.end(),
                           [&](const Shape& s) { return is(scene.materials[s.material]); });
    };
    auto any_light = [&](auto... types) {
        return std::any_of(scene.lights.begin(), scene.lights.end(),
                           [&](const Light& light) { return (... || (light.type == types)); });
    };
    auto is_metal = [](const Material& m) {
        return is_receiver(m) && m.type != MaterialType::diffuse;
    };
    const double samples = static_cast<double>(film.samples()), mean = film.mean(),
                 error = film.standard_error();
    const int depth = scene.max_depth;
    const bool mirrors = any_material(is_specular), receivers = any_material(is_receiver),
               casts = mirrors && receivers && depth > 1,
               has_delta = any_light(LightType::point, LightType::distant),
               has_area = any_light(LightType::area);
    const std::string larger = "the true error may be larger than the reported one",
                      at_random = "found only by random hits: " + larger,
                      is_left_out =
                          "from a point or distant light is left out: no path can hit such a light",
                      by_mirrors = "light that reaches a surface through mirrors or glass ";
    using enum LightSearch;
    Lines lines;

    lines.warn(o.search == random_hits && has_rare_light(scene, samples),
               "a small light is " + at_random);

    if (o.search == from_lights) {
        InView seen = in_view(scene);
        double metal = share_of_smooth_metal(seen, samples), share = seen.mirrors / seen.pixels;
        bool all = o.paths.empty();
        lines.warn(all && metal * mean > error,
                   percent(metal) +
                       " of the picture shows metal that is nearly a mirror: few paths from a "
                       "light leave it towards the camera, so " +
                       larger);
        lines.warn(all && light_by_few_paths(scene, seen, samples) > 2 * error,
                   "few paths from a light reach a part of the picture: " + larger);
        lines.warn(share > 0, percent(share) +
                                  " of the picture shows a mirror or glass: this part is black, "
                                  "because no vertex on it can be connected to the camera");
    }

    if (o.search == light_sampling) {
        // By default, chapter 13 samples lights only; later chapters also sample the metal's BSDF.
        // What surfaces in view receive from metal may be ten times its share of all light.
        Notes::value_type by_light = {"strategy", "light"};
        bool alone = std::count(o.own.begin(), o.own.end(), by_light) > 0;
        double hidden = receivers ? 10 * share_on_smooth_metal(scene, samples, !alone) * mean : 0;
        lines.warn(hidden > 0 && !(hidden <= error),
                   "light that reaches a surface via nearly smooth metal is " + at_random);
        lines.warn(casts && has_delta, by_mirrors + is_left_out);
        lines.warn(casts && (has_area || scene.sky_image), by_mirrors + "is " + at_random);
    }

    if (o.search == direct && depth > 0) {
        InView seen = in_view(scene);
        lines.warn(scene.sky_light >= 0 && receivers,
                   "light that surfaces receive from the sky is left out");
        lines.warn(lamps_are_near(scene, seen),
                   "a lamp near a surface lights it as if all came from the lamp's middle: the "
                   "reported error does not include this");
        lines.warn(depth > 1 && !mirrors && surfaces_face_each_other(scene, seen),
                   "light that one surface reflects to another is left out");
        lines.warn(casts, by_mirrors +
                              "is left out, and so is light that one surface reflects to another");
    }

    if (o.search == both_ends || o.search == merging) {
        const std::string both =
            "light that goes through mirrors or glass to a surface that the camera sees in mirrors "
            "or glass ";
        bool is_seen = casts && depth > 2 && (o.search == both_ends || any_material(is_metal));
        lines.warn(receivers && share_by_few_paths_to_mirrors(scene, samples) > 0.01,
                   "hardly any path from a point or distant light hits a mirror, glass or smooth "
                   "metal: the light that these cast on surfaces may be missing");
        lines.warn(is_seen && has_delta, both + is_left_out);
        lines.warn(is_seen && !has_delta && has_area, both + "is " + at_random);
    }
    return lines;
}

}  // namespace

std::vector<std::string> causes_of_black(const Scene& scene, const RenderOptions& options) {
    Lines lines;
    InView seen = in_view(scene);
    bool is_deep = seen.hits > 0 && scene.max_depth > 0, all_mirrors = seen.mirrors == seen.hits,
         all_black = seen.mirrors + seen.receivers == 0;
    bool away = is_deep && seen.receivers > 0 && all_face_away(scene, seen);
    auto shines = [](const Light& light) { return light.type == LightType::area && light.at; };
    auto lamp = std::find_if(scene.lights.begin(), scene.lights.end(), shines);
    std::string place;
    if (lamp != scene.lights.end()) place = " (" + printable(place_text(*lamp->at)) + ")";
    lines.warn(!options.paths.empty(), "--paths keeps no class of path that brings light");
    lines.warn(seen.hits == 0, "the camera sees no surface: see its LookAt, fov and Scale");
    lines.warn(seen.hits > 0 && scene.max_depth == 0,
               "with a depth of 0 only lights themselves are seen, and none is in view");
    lines.warn(is_deep && seen.backs == seen.hits,
               "all that the camera sees it sees from behind: it may be inside something");
    lines.warn(is_deep && all_mirrors,
               "the camera sees mirrors and glass alone, and no light in them");
    lines.warn(is_deep && all_black, "all surfaces in view are black: they reflect nothing");
    lines.warn(away, "the lights and all that is in view face away from each other" + place +
                         ": ReverseOrientation turns a light, \"bool twosided\" true lights both "
                         "sides");
    lines.warn(
        is_deep && !all_mirrors && !all_black && !away,
        options.search == LightSearch::random_hits
            ? "this chapter finds lights only by random hits: more samples find them, or a "
              "chapter that samples lights (from 09 on)"
            : "too few paths find a way from the lights to what is in view: more samples, or "
              "a chapter that finds light in another way");
    return lines;
}

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
    const std::string half_or_twice = ": the true one may be half or twice as large",
                      is_larger = ": the true error is larger than the reported one";

    lines.warn(empty > 0, "rendering ended before " + percent(empty) +
                              " of the pixels had a sample: they are black");
    lines.warn(samples > 0 && sum == 0, "the picture is black: no sample found light");
    lines.warn(
        sum > 0 && counts.largest > too_much * sum,
        "one sample contains " + percent(counts.largest / sum) + " of the whole picture" + place);
    lines.warn(has_noise && effective > 0 && effective < few_samples,
               format("as few as %.0f samples determine the picture", effective) + is_larger);
    lines.warn(has_noise && one_in_many && effective >= few_samples,
               "a few bright samples determine the error" + is_larger);
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
    auto lines = warnings_of(r.film, r.stats, at ? ": see --explain " + at->text() : "");
    if (r.film.samples() > 0 && r.film.mean() == 0)
        for (const std::string& cause : causes_of_black(scene, options))
            lines.push_back("possible cause: " + cause);
    for (const std::string& line : missed_light(scene, options, r.film)) lines.push_back(line);
    lines.insert(lines.end(), r.warnings.begin(), r.warnings.end());
    return lines;
}
