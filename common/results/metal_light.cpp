#include "common/results/metal_light.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "common/path/light_paths.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/scene/intersect.h"

namespace {

constexpr uint32_t tried = 1 << 14, tried_from_camera = 1 << 16;

/// The light that the camera sees of flux arriving at x from wi; see chapter 20.
Rgb shown(const Scene& scene, const Pinhole& camera, const Hit& x, Vec3 wi, Rgb flux) {
    Vec3 away = x.p - camera.view.o;
    std::optional<CameraImportance> importance = camera_importance(camera, away);
    if (!importance) return {};
    float d = length(away);
    Vec3 wo = -1 / d * away;
    Rgb L = flux * adjoint_bsdf(scene, x, wi, wo) * (importance->We_cos / (d * d));
    return is_black(L) || occluded(scene, spawn_ray(x, wo, d)) ? Rgb{} : L;
}

/// The contribution of one path from a light to the picture via near mirrors.
Rgb path_by_nearly_mirrors(const Scene& scene, const Endpoints& endpoints, double paths,
                           bool meets_lights, Sampler& sampler) {
    double u = to_unit_double(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, endpoints, u, u_y, sampler.u2());
    if (e.type == LightType::infinite) return {};  // no light is larger
    u = (u - endpoints.p_image) / (1 - endpoints.p_image);
    const LightShape& shape = scene.light_shapes[pick_light(endpoints.lights, u)];
    double area = meets_lights && e.type == LightType::area ? double{shape.area} : 0;
    float cos_y = e.type == LightType::point ? 1 : dot(e.d, e.y.n);
    Rgb flux = e.Le * (cos_y / (e.pmf * e.y.pdf * e.pdf_w));
    Ray ray = {e.y.p + e.y.eps * e.y.n, e.d};
    double d = 0;
    for (int depth = 1; depth <= std::min(scene.max_depth, 8); depth++) {
        std::optional<Hit> x = intersect(scene, ray);
        if (!x || is_specular(*x->material)) return {};
        d += double{x->t};
        Vec3 wi = -ray.d;
        if (!is_nearly_mirror(*x->material, paths, area / (4 * std::numbers::pi * d * d))) {
            return depth == 1 ? Rgb{} : shown(scene, endpoints.camera, *x, wi, flux);
        }
        float u1 = sampler.u1();
        BsdfSample s = sample_light_bsdf(scene, *x, wi, u1, sampler.u2());
        if (s.pdf_w == 0) return {};
        flux *= s.f / s.pdf_w;
        ray = spawn_ray(*x, s.wi);
    }
    return {};
}

/// The approximate share of the sphere that the sky's light comes from: 1 if it is even.
double size_of_sky(const SkyImage& sky) {
    double sum = 0, squares = 0;
    for (size_t i = 0; i < sky.pixels.size(); i++) {
        double light = static_cast<double>(average(sky.pixels[i]) *
                                           solid_angle_per_area(sky, sky.middle_of(i)));
        sum += light, squares += light * light;
    }
    return squares > 0 ? sum * sum / squares / static_cast<double>(sky.pixels.size()) : 1;
}

/// Samples a light from x.
Rgb light_sampling(const Scene& scene, const LightTable& lights, const Hit& x, Vec3 wo,
                   Sampler& sampler) {
    double u = to_unit_double(sampler.u2());
    LightSample y = sample_light(scene, lights, x, u, sampler.u2());
    if (y.pdf_w == 0) return {};
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (dot(y.wi, x.n) / y.pdf_w);
    return is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist)) ? Rgb{} : Ld;
}

/// Light along a ray from the camera, from one path, as in chapter 13: near mirrors sample the
/// BSDF, other surfaces sample lights. Adds to `hits` if the path hits a light via a near mirror.
Rgb light_along(const Scene& scene, const LightTable& lights, double paths, Ray ray,
                Sampler& sampler, double& hits) {
    Rgb L, beta = {1, 1, 1};
    bool by_nearly_mirror = false, count_emission = true;
    for (int depth = 0;; depth++) {
        std::optional<Hit> x = intersect(scene, ray);
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (count_emission) L += beta * Le;
        hits += by_nearly_mirror && !is_black(Le);
        if (!x || depth == scene.max_depth) return L;
        by_nearly_mirror = is_nearly_mirror(*x->material, paths);
        count_emission = by_nearly_mirror || is_specular(*x->material);
        if (!count_emission) L += beta * light_sampling(scene, lights, *x, -ray.d, sampler);
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, -ray.d, u1, sampler.u2());
        if (s.pdf_w == 0) return L;
        float q = survival_probability(beta, depth);
        if (sampler.u1() >= q) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w / q);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace

double light_by_nearly_mirrors(const Scene& scene, double paths, bool meets_lights) {
    auto has_any = [&](double size) {
        return std::any_of(scene.shapes.begin(), scene.shapes.end(), [&](const Shape& s) {
            return is_nearly_mirror(scene.materials[s.material], paths, size);
        });
    };
    if (!has_any(0)) return 0;
    if (scene.sky_image && has_any(size_of_sky(*scene.sky_image)))
        return std::numeric_limits<double>::infinity();
    if (scene.lights.empty()) return 0;
    Endpoints endpoints = endpoints_of(scene);
    Sampler sampler(SamplerType::independent, 1, 1);
    double sum = 0;
    for (uint32_t i = 0; i < tried; i++) {
        sampler.start(0, i);
        Rgb L = path_by_nearly_mirrors(scene, endpoints, paths, meets_lights, sampler);
        if (is_finite(L)) sum += static_cast<double>(average(L));
    }
    return sum / tried;
}

NearlyMirrorsSeen nearly_mirrors_seen(const Scene& scene, const Film& film) {
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    double paths = static_cast<double>(film.samples());
    auto ray_of = [&](size_t pixel, Vec2 u) {
        size_t width = static_cast<size_t>(scene.width);
        return camera_ray(view, {static_cast<float>(pixel % width) + u.x,
                                 static_cast<float>(pixel / width) + u.y});
    };
    Image image = film.image();
    std::vector<size_t> seen;
    NearlyMirrorsSeen result;
    for (size_t i = 0; i < image.pixels.size(); i++) {
        std::optional<Hit> hit = intersect(scene, ray_of(i, {0.5f, 0.5f}));
        if (!hit || !is_nearly_mirror(*hit->material, paths)) continue;
        seen.push_back(i);
        result.found += static_cast<double>(average(image.pixels[i]));
    }
    if (seen.empty()) return {};
    double pixels = static_cast<double>(image.pixels.size());
    result.found /= pixels;
    result.share = static_cast<double>(seen.size()) / pixels;
    LightTable lights = build_light_table(light_pmf(scene, 0.25));
    Sampler sampler(SamplerType::independent, 1, 1);
    double sum = 0, squares = 0, n = tried_from_camera;
    for (uint32_t i = 0; i < tried_from_camera; i++) {
        sampler.start(0, i);
        Ray ray = ray_of(seen[i * seen.size() / tried_from_camera], sampler.u2());
        double L = static_cast<double>(
            average(light_along(scene, lights, paths, ray, sampler, result.hits)));
        sum += L, squares += L * L;
    }
    result.expected = result.share * sum / n;
    result.error = result.share * std::sqrt((squares - sum * sum / n) / n / n);
    return result;
}
