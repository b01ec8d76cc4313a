#include "common/results/black_picture.h"

#include <algorithm>
#include <cstdio>

#include "common/base/position.h"
#include "common/light/lights.h"
#include "common/material/optics.h"
#include "common/path/sampler.h"
#include "common/scene/camera.h"
#include "common/scene/intersect.h"

namespace {

/// How far light gets on its way to a point that the camera sees: the best case over all rays.
enum class Reach : uint8_t {
    faces_away,     // the light emits in the other direction
    behind,         // the surface faces away from the light
    blocked,        // an object is in between
    through_glass,  // only glass is in between
    arrives
};

/// The statistics of a few hundred rays in a scene.
struct Survey {
    int rays = 0, hits = 0, backs = 0;  // from the camera; that hit something; from behind
    int receivers = 0, reflecting = 0;  // points in view that are neither mirror nor glass; those
                                        // of them that are not black
    Reach reach = Reach::faces_away;
};

/// The first point along the ray that is neither mirror nor glass.
std::optional<Hit> first_receiver(const Scene& scene, Ray ray) {
    for (int i = 0; i < 16; i++) {
        std::optional<Hit> x = intersect(scene, ray);
        if (!x || !is_specular(*x->material)) return x;
        Vec3 wo = -ray.d, wi = reflect(wo, x->n);
        if (x->material->type == MaterialType::dielectric) {
            float eta = x->front ? x->material->ior : 1 / x->material->ior;
            wi = refract(wo, x->n, eta).value_or(wi);
        }
        ray = spawn_ray(*x, wi);
    }
    return {};
}

/// Whether the segment from x along wi is free, or only glass is in between.
Reach reach_along(const Scene& scene, const Hit& x, Vec3 wi, float dist) {
    Hit from = x;
    for (int i = 0; i < 16; i++) {
        std::optional<Hit> y = intersect(scene, spawn_ray(from, wi, dist));
        if (!y) return i == 0 ? Reach::arrives : Reach::through_glass;
        if (y->material->type != MaterialType::dielectric) return Reach::blocked;
        from = *y, dist -= y->t;
    }
    return Reach::blocked;
}

Reach reach_of_light(const Scene& scene, size_t i, const Hit& x, Vec2 u) {
    LightSample y = sample_one_light(scene, i, x, u);
    if (y.pdf_w == 0) return Reach::faces_away;
    if (dot(y.wi, x.n) <= 0 || dot(y.wi, x.ng) <= 0) return Reach::behind;
    return reach_along(scene, x, y.wi, y.dist);
}
Reach reach_of_sky_image(const Scene& scene, const Hit& x, Vec2 u) {
    return reach_along(scene, x, Frame(x.n).to_world(sample_cosine_hemisphere(u)), infinity);
}

Survey survey(const Scene& scene) {
    constexpr int across = 16, points = 4;
    constexpr size_t most_lights = 64;
    Survey s;
    Sampler sampler(SamplerType::independent, 1, 1);
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    for (int i = 0; i < across * across; i++) {
        sampler.start(0, static_cast<uint32_t>(i));
        float x = (static_cast<float>(i % across) + sampler.u1()) / across;
        float y = (static_cast<float>(i / across) + sampler.u1()) / across;
        Ray ray = camera_ray(
            view, {x * static_cast<float>(scene.width), y * static_cast<float>(scene.height)});
        s.rays++;
        std::optional<Hit> seen = intersect(scene, ray);
        if (!seen) continue;
        s.hits++;
        s.backs += !seen->front;
        std::optional<Hit> receiver = first_receiver(scene, ray);
        if (!receiver) continue;
        s.receivers++;
        const Material& m = *receiver->material;
        if (m.type == MaterialType::diffuse && is_black(m.reflectance)) continue;
        s.reflecting++;
        for (int point = 0; point < points; point++) {
            for (size_t l = 0; l < std::min(scene.lights.size(), most_lights); l++) {
                s.reach = std::max(s.reach, reach_of_light(scene, l, *receiver, sampler.u2()));
            }
            if (scene.sky_image)
                s.reach = std::max(s.reach, reach_of_sky_image(scene, *receiver, sampler.u2()));
        }
    }
    return s;
}

/// The place in the scene file that defines the first area light, in brackets.
std::string first_place(const Scene& scene) {
    for (const Light& light : scene.lights) {
        if (light.type != LightType::area || !light.at) continue;
        return " (" + printable(light.at->file) + ":" + std::to_string(light.at->line) + ":" +
               std::to_string(light.at->column) + ")";
    }
    return "";
}

/// Why the chapter's way of finding light misses light that could arrive.
std::string of_search(LightSearch search, double chance) {
    char text[200];
    switch (search) {
        case LightSearch::by_chance:
            std::snprintf(
                text, sizeof text,
                "this chapter finds lights only by chance, by about one path in %.2g: more "
                "samples find them, or a chapter that samples lights (from 09 on)",
                1 / chance);
            return text;
        case LightSearch::from_lights:
            return "paths begin at the lights, and few of them come to what the camera sees: more "
                   "samples, or a chapter whose paths begin at the camera";
        case LightSearch::photons:
            return "photons begin at the lights, and few of them come to what the camera sees: "
                   "more photons, or a chapter whose paths begin at the camera";
        case LightSearch::light_sampling:
        case LightSearch::direct:
        case LightSearch::both_ends:
        case LightSearch::merging: break;
    }
    return "light takes ways here that too few paths find: more samples, or another chapter";
}

}  // namespace

std::vector<std::string> causes_of_black(const Scene& scene, const RenderOptions& options,
                                         double chance) {
    std::vector<std::string> causes;
    if (!options.paths.empty())
        causes.push_back("--paths keeps no class of path that brings light");
    Survey s = survey(scene);
    if (s.hits == 0) {
        causes.push_back("the camera sees no surface: see its LookAt, fov and Scale");
        return causes;
    }
    if (scene.max_depth == 0) {
        causes.push_back("with a depth of 0 only lights themselves are seen, and none is in view");
        return causes;
    }
    if (s.backs == s.hits) {
        causes.push_back(
            "all that the camera sees it sees from behind: it may be inside something");
    }
    if (s.receivers == 0) {
        causes.push_back("the camera sees mirrors and glass alone, and nothing in or behind them");
        return causes;
    }
    if (s.reflecting == 0) {
        causes.push_back("all surfaces in view are black: they reflect nothing");
        return causes;
    }
    if (s.reach == Reach::faces_away) {
        causes.push_back("the lights face away from all that is in view" + first_place(scene) +
                         ": ReverseOrientation turns a light, \"bool twosided\" true lights both "
                         "sides");
    } else if (s.reach == Reach::behind) {
        causes.push_back("all surfaces in view face away from the lights");
    } else if (s.reach == Reach::blocked) {
        causes.push_back("something stands between the lights and all that is in view");
    } else if (s.reach == Reach::through_glass) {
        causes.push_back(
            "light comes to what is in view only through glass, where light sampling does not "
            "find it: chapters 20 to 25 do");
    }
    if (s.reach != Reach::arrives && scene.max_depth == 1) {
        causes.push_back("with a depth of 1 light comes straight from the lights alone");
    }
    if (s.reach >= Reach::through_glass || causes.empty() ||
        options.search == LightSearch::by_chance) {
        causes.push_back(of_search(options.search, chance));
    }
    return causes;
}
