// The other way to the pictures of chapters 16 to 18: a path tracer that never samples a light,
// written anew.
#pragma once
#include "common/material/bsdf.h"
#include "common/material/ggx.h"
#include "common/material/observer.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"

/// One path that meets light by chance: through a point of the lens that is found by throwing
/// darts, at a moment and of a wavelength of which all are equally likely, and without roulette.
inline Rgb trace_by_chance(const Scene& scene, const std::vector<Rgb>& white, Ray ray,
                           Sampler& sampler, Recorder& recorder) {
    const Camera& camera = scene.camera;
    float time = sampler.u1();
    ray.time = camera.shutter_open * (1 - time) + camera.shutter_close * time;
    if (camera.lens_radius > 0) {
        float px = 2, py = 2;
        while (px * px + py * py > 1) px = 2 * sampler.u1() - 1, py = 2 * sampler.u1() - 1;
        Vec3 axis = normalize(cross(camera.right, camera.up));
        Vec3 sharp = ray.o + ray.d * (camera.focal_distance / std::abs(dot(ray.d, axis)));
        ray.o += camera.lens_radius * (px * camera.right + py * camera.up);
        ray.d = normalize(sharp - ray.o);
    }
    Rgb L, beta = {1, 1, 1};
    double micrometres = 0;
    for (int depth = 0;; depth++) {
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) {
            Rgb sky = scene.sky;
            if (scene.sky_image) sky += scene.sky_image->at(point_of(*scene.sky_image, ray.d));
            recorder.emitted(sky);
            return L + beta * sky;
        }
        recorder.vertex(*x);
        Rgb Le = emission(scene, *x);
        L += beta * Le;
        recorder.emitted(Le);
        if (depth == scene.max_depth) return L;
        Material glass = *x->material;
        if (glass.glass != nullptr) {
            if (micrometres == 0) {
                double bins = static_cast<double>(white.size()), at = double{sampler.u1()} * bins;
                size_t bin = std::min(static_cast<size_t>(at), white.size() - 1);
                micrometres = (observer_first_nm + observer_step_nm * (at - 0.5)) / 1000;
                beta *= white[bin] * static_cast<float>(bins);
            }
            glass.ior = index_of_refraction(*glass.glass, micrometres);
            x->material = &glass;
        }
        float u1 = sampler.u1();
        BsdfSample s = glossy_bsdf::sample_bsdf(*x, -ray.d, u1, sampler.u2());
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s.wi, s.f, s.pdf_w, s.specular, beta);
        ray = spawn_ray(*x, s.wi);
    }
}
