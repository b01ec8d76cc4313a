#include "common/results/warnings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/percent.h"
#include "common/light/light_table.h"
#include "common/material/cosine.h"
#include "common/path/light_paths.h"
#include "common/path/sampler.h"
#include "common/results/black_picture.h"
#include "common/results/metal_light.h"
#include "common/scene/camera.h"
#include "common/scene/intersect.h"

namespace {

constexpr double too_much = 0.01;     // of a picture, in one sample
constexpr double negligible = 0.001;  // standard error, of the mean: no noise to warn of
constexpr double few_samples = 100;   // effective samples: below, intervals are too short
constexpr double few_pixels = 30, few_audits = 16;  // that the error is estimated from
constexpr double few_hits = 50;                     // of a light that is found by random hits
constexpr double few_paths = 10;                    // from lights, to a part of the picture

bool is_receiver(const Material& m) {
    return !is_specular(m) && !(m.type == MaterialType::diffuse && is_black(m.reflectance));
}

/// The approximate probability of hitting a light at random: in a closed room each part of the
/// walls is hit in proportion to its area, at most the area of the scene's bounding sphere.
double chance_of(const Scene& scene, size_t light) {
    double radius = static_cast<double>(scene.radius);
    return static_cast<double>(scene.light_shapes[light].area) /
           (4 * std::numbers::pi * radius * radius);
}
double chance_of_any(const Scene& scene) {
    double sum = 0;
    for (size_t i = 0; i < scene.lights.size(); i++) {
        sum += scene.lights[i].type == LightType::area ? chance_of(scene, i) : 0;
    }
    return scene.sky_light >= 0 || scene.sky_image ? 1 : std::min(sum, 1.0);
}

/// Whether an important light is so small that random hits are too rare.
bool has_rare_light(const Scene& scene, double samples) {
    double all = 0;
    for (size_t i = 0; i < scene.lights.size(); i++) {
        all += static_cast<double>(light_power(scene, i));
    }
    for (size_t i = 0; i < scene.lights.size(); i++) {
        bool matters = static_cast<double>(light_power(scene, i)) > 0.01 * all;
        bool is_area = scene.lights[i].type == LightType::area;
        if (matters && is_area && samples * chance_of(scene, i) < few_hits) return true;
    }
    return false;
}

/// The share of pixels that show a mirror or glass at their centre.
double share_of_mirrors(const Scene& scene) {
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    double seen = 0;
    for (int y = 0; y < scene.height; y++) {
        for (int x = 0; x < scene.width; x++) {
            Vec2 middle = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
            std::optional<Hit> hit = intersect(scene, camera_ray(view, middle));
            seen += hit && is_specular(*hit->material);
        }
    }
    return seen / scene.width / scene.height;
}

/// Whether a visible surface faces another one that reflects light.
bool surfaces_face_each_other(const Scene& scene) {
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Sampler sampler(SamplerType::independent, 1, 1);
    for (uint32_t i = 0; i < 256; i++) {
        sampler.start(0, i);
        Vec2 u = sampler.u2();
        Vec2 point = {u.x * static_cast<float>(scene.width),
                      u.y * static_cast<float>(scene.height)};
        std::optional<Hit> x = intersect(scene, camera_ray(view, point));
        if (!x || !is_receiver(*x->material)) continue;
        Vec3 wi = Frame(x->n).to_world(sample_cosine_hemisphere(sampler.u2()));
        std::optional<Hit> y = intersect(scene, spawn_ray(*x, wi));
        if (y && is_receiver(*y->material)) return true;
    }
    return false;
}

/// The light of those places that the fewest paths reach: together fewer than few_paths.
double light_of_fewest(std::vector<std::pair<double, double>> places) {  // paths, light
    std::sort(places.begin(), places.end());
    double reached = 0, light = 0;
    for (auto [paths, L] : places) {
        reached += paths;
        if (reached < few_paths) light += L;
    }
    return light;
}

/// The part of the picture's mean that hardly any path from a light finds. Only direct light: light
/// samples at visible points tell how many paths reach each of them.
double light_by_few_paths(const Scene& scene, double paths) {
    constexpr uint32_t tried = 1 << 14;
    Endpoints endpoints = endpoints_of(scene);
    double q = endpoints.p_image;
    if (scene.max_depth == 0 || (scene.lights.empty() && q == 0)) return 0;
    std::vector<std::pair<double, double>> places;  // paths that reach it; its light
    Sampler sampler(SamplerType::independent, 1, 1);
    for (uint32_t i = 0; i < tried; i++) {
        sampler.start(0, i);
        Vec2 u = sampler.u2();
        Ray ray = camera_ray(endpoints.camera.view, {u.x * static_cast<float>(scene.width),
                                                     u.y * static_cast<float>(scene.height)});
        std::optional<Hit> x = intersect(scene, ray);
        if (!x || is_specular(*x->material)) continue;
        double v = to_unit_double(sampler.u2());
        float pmf = static_cast<float>(q), power = pi * scene.radius * scene.radius;
        LightSample y;
        if (v < q) {
            y = sample_image(*scene.sky_image, endpoints.image_cdf, v / q, sampler.u2());
            power *= average(y.Le) / y.pdf_w;
        } else {
            size_t light = pick_light(endpoints.lights, (v - q) / (1 - q));
            y = sample_one_light(scene, light, *x, sampler.u2());
            pmf = static_cast<float>(1 - q) * pmf_light(endpoints.lights, light);
            power = light_power(scene, light);
        }
        float cos_x = dot(y.wi, x->n);
        if (y.pdf_w == 0 || cos_x <= 0 || occluded(scene, spawn_ray(*x, y.wi, y.dist))) continue;
        // A path carries power / pmf; this place has this area, and this is its irradiance.
        float pixels = importance_cos(endpoints.camera, ray.d) * std::abs(dot(ray.d, x->ng));
        double area = double{x->t} * double{x->t} / double{pixels} / tried;
        double E = static_cast<double>(average(y.Le) * cos_x / y.pdf_w);
        Rgb L = eval_bsdf(*x, -ray.d, y.wi) * y.Le * (cos_x / y.pdf_w / pmf);
        places.emplace_back(paths * E * area / double{power}, static_cast<double>(average(L)));
    }
    return light_of_fewest(places) / tried;
}

/// The share of the light of point and distant lights to mirrors and glass that few paths carry.
double share_by_few_paths_to_mirrors(const Scene& scene, double paths) {
    if (scene.max_depth < 2) return 0;
    double area = 0, all = 0;  // m^2, of the outlines of mirrors and glass, about; W
    Vec3 middle;               // of them
    auto add = [&](uint32_t shape, float a, Vec3 p) {
        if (!is_specular(scene.materials[scene.shapes[shape].material])) return;
        area += double{a};
        middle += a * p;
    };
    const Geometry& g = scene.geometry;
    for (const Triangle& t : g.triangles) {
        Vec3 p = g.positions[t.v[0]], a = g.positions[t.v[1]] - p, b = g.positions[t.v[2]] - p;
        add(t.shape, length(cross(a, b)) / 8, p);
    }
    for (const Sphere& s : g.spheres) add(s.shape, pi * s.r * s.r, s.c);
    for (const Disk& d : g.disks) add(d.shape, pi * d.r * d.r / 2, d.c);
    middle = middle / static_cast<float>(area);
    Endpoints endpoints = endpoints_of(scene);
    std::vector<std::pair<double, double>> lights;  // paths that reach them; its light
    for (size_t i = 0; i < scene.lights.size(); i++) {
        const Light& light = scene.lights[i];
        bool distant = light.type == LightType::distant;
        if (!distant && light.type != LightType::point) continue;
        float d = distant ? scene.radius / 2 : length(light.p - middle);
        double share = std::min(1.0, area / (4 * std::numbers::pi * double{d} * double{d}));
        double pmf = (1 - endpoints.p_image) * double{pmf_light(endpoints.lights, i)};
        double power = share * double{light_power(scene, i)};
        lights.emplace_back(paths * pmf * share, power);
        all += power;
    }
    return all > 0 ? light_of_fewest(lights) / all : 0;
}

bool has_own(const RenderOptions& options, const std::string& name, const std::string& value) {
    return std::count(options.own.begin(), options.own.end(), std::pair(name, value)) > 0;
}

/// Adds warnings about light that this method leaves out, or finds by random hits.
void add_missed_light(const Scene& scene, const RenderOptions& options, const Film& film,
                      std::vector<std::string>& lines) {
    double samples = static_cast<double>(film.samples()), error = film.standard_error();
    if (options.search == LightSearch::by_chance) {
        if (has_rare_light(scene, samples)) {
            lines.push_back(
                "this chapter finds lights only by chance, and one is so small that few paths hit "
                "it: the true error may be larger than the reported one");
        }
        return;
    }
    if (options.search == LightSearch::from_lights) {
        double share = share_of_mirrors(scene);
        NearlyMirrorsSeen metal = nearly_mirrors_seen(scene, film);
        bool is_off = metal.hits < few_hits ? metal.share * film.mean() > error
                                            : std::abs(metal.found - metal.expected) >
                                                  2 * std::hypot(error, metal.error);
        if (is_off && options.paths.empty()) {
            lines.push_back(
                percent(metal.share) +
                " of the picture shows metal that is nearly a mirror: few paths from a light leave "
                "it towards the camera, so the true error may be larger than the reported one");
        }
        if (options.paths.empty() && light_by_few_paths(scene, samples) > 2 * error) {
            lines.push_back(
                "so few paths from a light reach a part of what the camera sees that its light may "
                "be missing: the true error may be larger than the reported one");
        }
        if (share > 0) {
            lines.push_back(percent(share) +
                            " of the picture shows a mirror or glass: this part is black, because "
                            "no vertex on it can be connected to the camera");
        }
        return;
    }
    auto any_material = [&](auto is) {
        return std::any_of(scene.shapes.begin(), scene.shapes.end(),
                           [&](const Shape& s) { return is(scene.materials[s.material]); });
    };
    auto is_diffuse = [](const Material& m) { return m.type == MaterialType::diffuse; };
    auto gathers_photons = [&](const Material& m) { return is_diffuse(m) && is_receiver(m); };
    const std::string blurred =
        "photons blur light within their radius: the reported error does not include this bias";
    if (options.search == LightSearch::photons) {
        // Light straight from a light is in photons only without final gathering.
        int fewest = has_own(options, "gather", "direct") ? 1 : 2;  // scattering events
        if (scene.max_depth >= fewest && any_material(gathers_photons)) lines.push_back(blurred);
        return;
    }
    auto any_light = [&](auto is) {
        return std::any_of(scene.lights.begin(), scene.lights.end(),
                           [&](const Light& light) { return is(light.type); });
    };
    if (options.search == LightSearch::light_sampling && any_material(is_receiver)) {
        // By default, chapter 13 samples lights only; later chapters also sample the metal's BSDF.
        bool lights_alone = has_own(options, "strategy", "light");
        double hidden = light_by_nearly_mirrors(scene, samples, !lights_alone);
        if (hidden > 0 && !(hidden <= error)) {
            lines.push_back(
                "light that reaches a surface via nearly smooth metal is found only by chance: "
                "the true error may be larger than the reported one");
        }
    }
    bool is_lit_by_sky = scene.sky_light >= 0 && scene.max_depth > 0 && any_material(is_receiver);
    if (options.search == LightSearch::direct && is_lit_by_sky)
        lines.push_back(
            "light that surfaces receive from the sky is left out: the sky is seen only directly "
            "and in mirrors");
    bool leaves_out = options.search == LightSearch::direct && scene.max_depth > 1;
    if (leaves_out && !any_material(is_specular) && surfaces_face_each_other(scene))
        lines.push_back("light that one surface reflects to another is left out");
    bool has_both = any_material(is_specular) && any_material(is_receiver);
    if (!has_both || scene.max_depth < 2) return;
    auto is_area = [](LightType type) { return type == LightType::area; };
    auto is_delta = [](LightType type) {
        return type == LightType::point || type == LightType::distant;
    };
    auto is_rough_metal = [&](const Material& m) { return is_receiver(m) && !is_diffuse(m); };
    bool merges = options.search == LightSearch::merging;
    if ((options.search == LightSearch::both_ends || merges) &&
        share_by_few_paths_to_mirrors(scene, samples) > 0.01) {
        lines.push_back(
            "hardly any path from a point or distant light hits a mirror or glass: the light that "
            "these cast on surfaces may be missing");
    }
    if (merges && any_material(gathers_photons)) lines.push_back(blurred);
    if (merges && !any_material(is_rough_metal)) return;
    if (options.search == LightSearch::both_ends || merges) {
        if (scene.max_depth < 3) return;
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
        return;
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
}

}  // namespace

std::vector<std::string> warnings_of(const Film& film, const SampleCounts& counts) {
    std::vector<std::string> lines;
    double samples = static_cast<double>(film.samples());
    double empty = static_cast<double>(film.empty_pixels());
    if (empty > 0) {
        lines.push_back("rendering ended before " +
                        percent(empty / static_cast<double>(film.pixels().size())) +
                        " of the pixels had a sample: they are black");
    }
    double sum = film.mean() * samples;
    if (samples > 0 && sum == 0) lines.push_back("the picture is black: no sample found light");
    if (sum > 0 && counts.largest > too_much * sum) {
        lines.push_back("one sample contains " + percent(counts.largest / sum) +
                        " of the whole picture");
    }
    double effective = film.effective_samples();
    bool has_noise = !(film.standard_error() < negligible * film.mean());  // or it is unknown
    if (has_noise && effective > 0 && effective < few_samples) {
        lines.push_back(
            "as few as " + std::to_string(std::lround(effective)) +
            " samples determine the picture: the true error is larger than the reported one");
    }
    Film::ErrorBasis basis = film.error_basis();
    double excess = std::max(counts.largest - film.mean(), 0.0);
    bool one_in_many =
        basis.pixels < few_pixels && basis.squares > 0 && excess * excess > 0.05 * basis.squares;
    if (has_noise && one_in_many && effective >= few_samples) {
        lines.push_back(
            "a few bright samples determine the error: the true error is larger than the reported "
            "one");
    }
    if (film.has_batches() && film.spp() > 1 && film.spp() < few_audits) {
        lines.push_back(
            "the error is estimated from few passes: the true one may be half or twice as large");
    }
    bool is_told_by_means = film.has_audits() || film.has_halves();
    if (is_told_by_means && basis.squares > 0 && basis.audits < few_audits) {
        lines.push_back(
            "the error is estimated from few pixels: the true one may be half or twice as large");
    }
    return lines;
}

std::vector<std::string> warnings_of(const Scene& scene, const RenderOptions& options,
                                     const Rendering& r) {
    std::vector<std::string> lines = warnings_of(r.film, r.stats);
    if (r.film.samples() > 0 && r.film.mean() == 0) {
        for (const std::string& cause : causes_of_black(scene, options, chance_of_any(scene))) {
            lines.push_back("possible cause: " + cause);
        }
    }
    add_missed_light(scene, options, r.film, lines);
    lines.insert(lines.end(), r.warnings.begin(), r.warnings.end());
    return lines;
}
