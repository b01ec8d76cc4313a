#include "common/program/metal_light.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "common/path/light_paths.h"
#include "common/path/sampler.h"

namespace {

/// What the camera sees of flux that arrives at x from wi; see chapter 17.
Rgb shown(const Scene& scene, const Pinhole& camera, const Hit& x, Vec3 wi, Rgb flux) {
    Vec3 away = x.p - camera.view.o;
    std::optional<Sight> sight = sight_of(camera, away);
    if (!sight) return {};
    float d = length(away);
    Vec3 wo = -1 / d * away;
    Rgb L = flux * carry(scene, x, wi, wo) * (sight->We_cos / (d * d));
    return is_black(L) || occluded(scene, spawn_ray(x, wo, d)) ? Rgb{} : L;
}

/// What one path from a light brings to the picture by way of nearly mirrors.
Rgb path_by_nearly_mirrors(const Scene& scene, const Ends& ends, double paths, bool meets_lights,
                           Sampler& sampler) {
    double u = join(sampler.u2());
    Vec2 u_y = sampler.u2();
    Emission e = sample_emission(scene, ends, u, u_y, sampler.u2());
    if (e.type == LightType::infinite) return {};  // no light is larger
    const LightShape& shape = scene.light_shapes[pick_light(ends.lights, u)];
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
            return depth == 1 ? Rgb{} : shown(scene, ends.camera, *x, wi, flux);
        }
        float u1 = sampler.u1();
        BsdfSample s = sample_light_bsdf(scene, *x, wi, u1, sampler.u2());
        if (s.pdf_w == 0) return {};
        flux *= s.f / s.pdf_w;
        ray = spawn_ray(*x, s.wi);
    }
    return {};
}

/// Which share of the sphere the sky's light comes from, about: 1 where it is even.
double size_of_sky(const SkyImage& sky) {
    double sum = 0, squares = 0;
    for (size_t i = 0; i < sky.pixels.size(); i++) {
        double light = static_cast<double>(average(sky.pixels[i]) *
                                           solid_angle_per_area(sky, sky.middle_of(i)));
        sum += light, squares += light * light;
    }
    return squares > 0 ? sum * sum / squares / static_cast<double>(sky.pixels.size()) : 1;
}

}  // namespace

double light_by_nearly_mirrors(const Scene& scene, double paths, bool meets_lights) {
    constexpr uint32_t tried = 1 << 14;
    auto has_any = [&](double size) {
        return std::any_of(scene.shapes.begin(), scene.shapes.end(), [&](const Shape& s) {
            return is_nearly_mirror(scene.materials[s.material], paths, size);
        });
    };
    if (!has_any(0)) return 0;
    if (scene.sky_image && has_any(size_of_sky(*scene.sky_image)))
        return std::numeric_limits<double>::infinity();
    if (scene.lights.empty()) return 0;
    Ends ends = ends_of(scene);
    Sampler sampler(SamplerType::independent, 1, 1);
    double sum = 0;
    for (uint32_t i = 0; i < tried; i++) {
        sampler.start(0, i);
        Rgb L = path_by_nearly_mirrors(scene, ends, paths, meets_lights, sampler);
        if (is_finite(L)) sum += static_cast<double>(average(L));
    }
    return sum / tried;
}
