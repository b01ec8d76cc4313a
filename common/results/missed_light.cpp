#include "common/results/missed_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/percent.h"
#include "common/light/light_table.h"
#include "common/material/cosine.h"
#include "common/path/light_paths.h"
#include "common/path/sampler.h"
#include "common/results/in_view.h"

namespace {

constexpr double few_hits = 50;         // of a light that is found by random hits
constexpr double few_reflections = 20;  // of a light, found via metal
constexpr double few_paths = 10;        // from lights, to a part of the scene

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

/// A light, and its share of all light that comes to a point, if nothing is in its way.
struct Share {
    size_t light;
    double light_here;
};
/// The lights that bring more than 1 % of the light at p.
std::vector<Share> important_lights(const Scene& scene, Vec3 p) {
    std::vector<Share> lights;
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
    for (Share share : important_lights(scene, scene.camera.o)) {
        bool is_area = scene.lights[share.light].type == LightType::area;
        double area = double{scene.light_shapes[share.light].area};
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
    auto shape_of = [](const auto& primitive) { return primitive.shape; };
    for (uint32_t i = 0; i < scene.geometry.size(); i++) {
        uint32_t shape = visit(scene.geometry, i, shape_of, shape_of, shape_of);
        if (!is(scene.materials[scene.shapes[shape].material])) continue;
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
    for (Share share : important_lights(scene, metal.middle)) {
        double spread = spread_of(scene, share.light, metal.middle), size = 0;
        if (scene.lights[share.light].type == LightType::infinite) continue;
        if (hits_lights) size = double{scene.light_shapes[share.light].area} / spread;
        if (paths * size < few_reflections)
            sum += share.light_here * std::min(1.0, metal.area / std::min(spread, in_view));
    }
    return sum;
}

/// Whether a surface in view faces another one that reflects light.
bool surfaces_face_each_other(const Scene& scene, const InView& seen) {
    Sampler sampler(SamplerType::independent, 1, 1);
    for (uint32_t i = 0; i < seen.points.size(); i++) {
        const Hit& x = seen.points[i].second;
        sampler.start(0, i);
        Vec3 wi = Frame(x.n).to_world(sample_cosine_hemisphere(sampler.u2()));
        std::optional<Hit> y = intersect(scene, spawn_ray(x, wi));
        if (y && is_receiver(*y->material)) return true;
    }
    return false;
}

/// Whether a flat lamp is so near to a surface in view that it is no point: within twice the radius
/// of a disk of its area. Below a disk a point is 25 % too bright there, and more if nearer.
bool lamps_are_near(const Scene& scene, const InView& seen) {
    auto is_near = [&](const LightShape& lamp) {
        float near = 2 * std::sqrt(lamp.area / pi);
        auto within = [&](const auto& point) {
            return length(lamp.centre - point.second.p) < near;
        };
        return lamp.flat && std::any_of(seen.points.begin(), seen.points.end(), within);
    };
    return std::any_of(scene.light_shapes.begin(), scene.light_shapes.end(), is_near);
}

/// The part of the picture's mean that hardly any path from a light finds: the direct light of
/// those places in view that the fewest paths reach, together fewer than few_paths. A light sample
/// at each place tells how many of `paths` paths from that light reach it.
double light_by_few_paths(const Scene& scene, const InView& seen, double paths) {
    constexpr uint32_t tries = 4;
    Endpoints endpoints = endpoints_of(scene);
    double q = endpoints.p_image;
    if (scene.max_depth == 0 || (scene.lights.empty() && q == 0)) return 0;
    double part = seen.receivers / seen.pixels / static_cast<double>(tries * seen.points.size());
    std::vector<std::pair<double, double>> places;  // paths that reach it; its light
    Sampler sampler(SamplerType::independent, 1, 1);
    for (uint32_t i = 0; i < tries * seen.points.size(); i++) {
        const auto& [ray, x] = seen.points[i / tries];
        sampler.start(0, i);
        double u = to_unit_double(sampler.u2());
        float pmf = static_cast<float>(q), power = pi * scene.radius * scene.radius;
        LightSample y;
        if (u < q) {
            y = sample_image(*scene.sky_image, endpoints.image_cdf, u / q, sampler.u2());
            power *= average(y.Le) / y.pdf_w;
        } else {
            size_t light = pick_light(endpoints.lights, (u - q) / (1 - q));
            y = sample_one_light(scene, light, x, sampler.u2());
            pmf = static_cast<float>(1 - q) * pmf_light(endpoints.lights, light);
            power = light_power(scene, light);
        }
        float cos_x = dot(y.wi, x.n);
        if (y.pdf_w == 0 || cos_x <= 0 || occluded(scene, spawn_ray(x, y.wi, y.dist))) continue;
        // A path carries power / pmf; this place has this area, and this is its irradiance.
        float pixels = importance_cos(endpoints.camera, ray.d) * std::abs(dot(ray.d, x.ng));
        double area = part * double{x.t} * double{x.t} / double{pixels};
        double E = double{average(y.Le) * cos_x / y.pdf_w};
        Rgb L = eval_bsdf(x, -ray.d, y.wi) * y.Le * (cos_x / y.pdf_w / pmf);
        places.emplace_back(paths * E * area / double{power}, part * double{average(L)});
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
    Endpoints endpoints = endpoints_of(scene);
    double few = 0, all = 0;
    for (size_t i = 0; i < scene.lights.size(); i++) {
        LightType type = scene.lights[i].type;
        if (type != LightType::distant && type != LightType::point) continue;
        double hit = std::min(1.0, mirrors.area / spread_of(scene, i, mirrors.middle));
        double power = hit * double{light_power(scene, i)};
        double pmf = (1 - endpoints.p_image) * double{pmf_light(endpoints.lights, i)};
        all += power;
        if (paths * pmf * hit < few_paths) few += power;
    }
    return all > 0 ? few / all : 0;
}

bool has_own(const RenderOptions& options, const std::string& name, const std::string& value) {
    return std::count(options.own.begin(), options.own.end(), std::pair(name, value)) > 0;
}

}  // namespace

std::vector<std::string> missed_light(const Scene& scene, const RenderOptions& options,
                                      const Film& film) {
    std::vector<std::string> lines;
    double samples = static_cast<double>(film.samples()), error = film.standard_error();
    if (options.search == LightSearch::by_chance) {
        if (has_rare_light(scene, samples)) {
            lines.push_back(
                "this chapter finds lights only by chance, and one is so small that few paths hit "
                "it: the true error may be larger than the reported one");
        }
        return lines;
    }
    if (options.search == LightSearch::from_lights) {
        InView seen = in_view(scene);
        double mean = film.mean(), metal = 0, share = seen.mirrors / seen.pixels;
        for (const auto& [ray, x] : seen.points) metal += is_nearly_mirror(*x.material, samples);
        metal *= seen.receivers / seen.pixels /
                 std::max<double>(1, static_cast<double>(seen.points.size()));
        if (options.paths.empty() && metal * mean > error) {
            lines.push_back(
                percent(metal) +
                " of the picture shows metal that is nearly a mirror: few paths from a light leave "
                "it towards the camera, so the true error may be larger than the reported one");
        }
        if (options.paths.empty() && light_by_few_paths(scene, seen, samples) > 2 * error) {
            lines.push_back(
                "so few paths from a light reach a part of what the camera sees that its light may "
                "be missing: the true error may be larger than the reported one");
        }
        if (share > 0) {
            lines.push_back(percent(share) +
                            " of the picture shows a mirror or glass: this part is black, because "
                            "no vertex on it can be connected to the camera");
        }
        return lines;
    }
    auto any_material = [&](auto is) {
        return std::any_of(scene.shapes.begin(), scene.shapes.end(),
                           [&](const Shape& s) { return is(scene.materials[s.material]); });
    };
    auto is_diffuse = [](const Material& m) { return m.type == MaterialType::diffuse; };
    if (options.search == LightSearch::photons) return lines;  // they find all light, but blur it
    auto any_light = [&](auto is) {
        return std::any_of(scene.lights.begin(), scene.lights.end(),
                           [&](const Light& light) { return is(light.type); });
    };
    if (options.search == LightSearch::light_sampling && any_material(is_receiver)) {
        // By default, chapter 13 samples lights only; later chapters also sample the metal's BSDF.
        bool lights_alone = has_own(options, "strategy", "light");
        // What surfaces in view receive from metal may be ten times its share of all light.
        double hidden = 10 * share_on_smooth_metal(scene, samples, !lights_alone) * film.mean();
        if (hidden > 0 && !(hidden <= error)) {
            lines.push_back(
                "light that reaches a surface via nearly smooth metal is found only by chance: "
                "the true error may be larger than the reported one");
        }
    }
    if (options.search == LightSearch::direct && scene.max_depth > 0) {
        InView seen = in_view(scene);
        if (scene.sky_light >= 0 && any_material(is_receiver))
            lines.push_back(
                "light that surfaces receive from the sky is left out: the sky is seen only "
                "directly and in mirrors");
        if (lamps_are_near(scene, seen))
            lines.push_back(
                "a lamp near a surface lights it as if all came from the lamp's middle: the "
                "error is not reported");
        if (scene.max_depth > 1 && !any_material(is_specular) &&
            surfaces_face_each_other(scene, seen))
            lines.push_back("light that one surface reflects to another is left out");
    }
    bool merges = options.search == LightSearch::merging;
    if ((options.search == LightSearch::both_ends || merges) && any_material(is_receiver) &&
        share_by_few_paths_to_mirrors(scene, samples) > 0.01) {
        lines.push_back(
            "hardly any path from a point or distant light hits a mirror, glass or smooth "
            "metal: the light that these cast on surfaces may be missing");
    }
    bool has_both = any_material(is_specular) && any_material(is_receiver);
    if (!has_both || scene.max_depth < 2) return lines;
    auto is_area = [](LightType type) { return type == LightType::area; };
    auto is_delta = [](LightType type) {
        return type == LightType::point || type == LightType::distant;
    };
    auto is_rough_metal = [&](const Material& m) { return is_receiver(m) && !is_diffuse(m); };
    if (merges && !any_material(is_rough_metal)) return lines;
    if (options.search == LightSearch::both_ends || merges) {
        if (scene.max_depth < 3) return lines;
        const std::string both =
            "light that goes through mirrors or glass to a surface that the camera sees in mirrors "
            "or glass ";
        if (any_light(is_delta)) {
            lines.push_back(
                both + "from a point or distant light is left out: no path can hit such a light");
        } else if (any_light(is_area)) {
            lines.push_back(
                both +
                "is found only by chance: the true error may be larger than the reported one");
        }
        return lines;
    }
    const std::string light = "light that reaches a surface through mirrors or glass ";
    if (options.search == LightSearch::direct) {
        lines.push_back(light +
                        "is left out, and so is light that one surface reflects to another");
    } else if (any_light(is_delta)) {
        lines.push_back(light +
                        "from a point or distant light is left out: no path can hit such a light");
    }
    if (options.search == LightSearch::light_sampling && (any_light(is_area) || scene.sky_image)) {
        lines.push_back(
            light + "is found only by chance: the true error may be larger than the reported one");
    }
    return lines;
}
