// Chapter 23: photon mapping. Light is sent out first, and stays where it falls; then the eye
// counts what has arrived around each point that it sees:
//
//   Lo = rho / pi  sum over photons nearer than r of  K(d / r) flux / (pi r^2)
#pragma once
#include <memory>

#include "chapters/23_photon_mapping/photons.h"
#include "common/light/pdf_one_light.h"
#include "common/path/mis.h"
#include "common/path/trace.h"

namespace ch23 {

using glossy_bsdf::pdf_bsdf;

/// Prepares the radii: those that hold k photons of a map that has no other use.
///
/// A radius from the same photons that are counted needs care (see kth_radius); one from others
/// does not: however it is chosen, the mean is right where light is even.
inline Prepared prepare(const Scene& scene, const Settings& settings, int threads,
                        const Stopped& stopped) {
    constexpr uint32_t pilot = 1u << 29;  // no pass has this number
    Prepared prepared = {settings, ends_of(scene), {}, {}};
    float& r = prepared.settings.r;
    if (r == 0) r = scene.radius / 20;
    for (Maps which : {all, caustics}) {
        PhotonMap map = send_photons(scene, prepared, which, pilot, threads, stopped).photons;
        prepared.radii[which] = map.kth_distances(settings.k, r, threads);
        prepared.pilot[which] = std::move(map);
    }
    return prepared;
}

/// How the radius shrinks: slowly enough that all passes together have ever more photons in it, so
/// that noise goes to 0 as well as blur.
///
///   (r_i+1 / r_i)^2 = (i + alpha) / (i + 1),  alpha = 2/3,  i = 1, 2, ...:      r_i ~ i^(-1/6)
///
/// source  Hachisuka et al. 2008; Knaus, Zwicker 2011      tested by  "truth: radii shrink"
inline float shrink_of(uint32_t pass) {
    double r2 = 1;
    for (double i = 1; i <= pass; i++) r2 *= (i + 2.0 / 3) / (i + 1);
    return static_cast<float>(std::sqrt(r2));
}

/// How far to look around x: up to the k-th photon of the map itself, or as far as the pilot says.
///
/// In the first case k - 1 photons are nearer than r, and those are counted: (k - 1) / (pi r^2) is
/// the density, on the mean; k / (pi r^2) is too much by k / (k - 1).
/// source  Loftsgaarden, Quesenberry 1965      tested by  "truth: k - 1 photons are counted up to
/// the k-th, not k"
inline float radius_at(const Prepared& prepared, const Pass& pass, Maps which, const Hit& x) {
    const Settings& s = prepared.settings;
    if (s.gather == Gather::nearest) return pass.paths[which].photons.kth_distance(x.p, s.k, s.r);
    if (prepared.radii[which].empty()) return s.r * pass.shrink;
    return prepared.radii[which][prepared.pilot[which].leaf_at(x.p)] * pass.shrink;
}

/// How much a photon counts at distance d; on the mean over the disk 1.
inline float kernel(Kernel type, float d2_over_r2) {
    switch (type) {
        case Kernel::box: return 1;
        case Kernel::cone: return 3 * (1 - std::sqrt(d2_over_r2));
        case Kernel::epanechnikov: return 2 * (1 - d2_over_r2);
    }
    return 0;
}

/// Estimates what x reflects, from the photons around it.
///
///   Lo = rho / pi  sum over photons nearer than r of  K(d / r) flux / (pi r^2)
///
/// Only those count that lie on the same surface: their normal is within 45 degrees, and they are
/// in a disk that is an eighth as thick as it is wide. `depth`: scattering events that are left.
/// Biased: what it finds is the mean over the disk. At the edge of a surface half of that is empty.
/// source  Jensen 1996      tested by  "truth: light at an edge and in a corner"
inline Rgb gather(const Prepared& prepared, const Pass& pass, Maps which, const Hit& x, int depth,
                  Recorder& recorder) {
    float r = radius_at(prepared, pass, which, x);
    if (!(r > 0)) return {};
    Rgb sum;
    const LightPaths& paths = pass.paths[which];
    paths.photons.for_each_near(x.p, r, [&](const Arrival& photon, Vec3 v) {
        Vec3 n = from_bits(photon.normal);
        float cosine = dot(n, x.ng);
        bool same_surface = cosine > 0 && cosine * cosine > 0.5f * dot(n, n);
        if (!same_surface || std::abs(dot(v, x.ng)) > r / 8) return;
        if (photon.depth > depth) return;
        Rgb counts = kernel(prepared.settings.kernel, dot(v, v) / (r * r)) * photon.flux;
        sum += counts;
        recorder.photon(counts, paths, photon);
    });
    Rgb f = x.material->reflectance / pi, scale = f / (pi * r * r);
    recorder.gathered(scale);
    return scale * sum;
}

/// Estimates what lights send straight by way of x to wo. Where x is rough metal, its BSDF may find
/// them as well.      Ld = mis_l f Le V cos / pdf_l
inline Rgb direct_light(const Scene& scene, const Prepared& prepared, const Hit& x, Vec3 wo,
                        LightNumbers u, Recorder& recorder) {
    if (is_specular(*x.material)) return {};
    LightSample y = sample_light(scene, prepared.ends.lights, x, u.light, u.point);
    if (y.pdf_w == 0) return {};
    float pdf_b = is_diffuse(*x.material) || y.delta ? 0 : pdf_bsdf(x, wo, y.wi);
    float mis_l = power_heuristic(y.pdf_w, pdf_b);
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (mis_l * dot(y.wi, x.n) / y.pdf_w);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, y.pdf_w, pdf_b, mis_l);
    return Ld;
}

/// The weight of light that a direction from `last` has met, the last vertex that is no mirror.
/// Where that is diffuse, its own light and caustics are found by other means: 0.
inline float mis_emission(const Scene& scene, const Prepared& prepared, const Hit& last, Vec3 wi,
                          float pdf_b, const std::optional<Hit>& y) {
    if (is_diffuse(*last.material)) return 0;
    size_t light = static_cast<size_t>(y ? y->light : scene.sky_light);
    float pdf_one = y ? pdf_one_light(scene, light, last, *y) : pdf_sky(last, wi);
    return power_heuristic(pdf_b, pmf_light(prepared.ends.lights, light) * pdf_one);
}

/// Estimates Li along the ray: follows it over mirrors, glass and rough metal to a diffuse point,
/// and counts photons there, or (final gathering) at the next one.
///
/// Biased, as photons are counted near a point and not at it; without end of passes, right.
/// source  Jensen 1996; Knaus, Zwicker 2011      tested by  "ch23 photon mapping"
inline Rgb trace(const Scene& scene, const Prepared& prepared, const Pass& pass, Ray ray,
                 Sampler& sampler, Recorder& recorder) {
    Rgb L, beta = {1, 1, 1};
    std::optional<Hit> last;  // the last vertex that is no mirror
    float pdf_b = 0;          // of the direction that was drawn there
    bool only_way = true;     // nothing but this path could find what shines next
    bool final = prepared.settings.gather == Gather::final, gathers = !final;
    for (int depth = 0;; depth++) {
        // Find the next vertex, and what shines there.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le)) {
            float mis_b = only_way ? 1 : mis_emission(scene, prepared, *last, ray.d, pdf_b, x);
            L += beta * Le * mis_b;
            recorder.emitted(Le, mis_b);
        }
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Count photons: of all light, and there the path ends; or only those of caustics.
        if (is_diffuse(*x->material)) {
            Maps which = gathers ? all : caustics;
            L += beta * gather(prepared, pass, which, *x, scene.max_depth - depth, recorder);
            if (gathers) return L;
            gathers = true;
        }

        // Aim at a light.
        Vec3 wo = -ray.d;
        LightNumbers u = {join(sampler.u2()), sampler.u2()};
        L += beta * direct_light(scene, prepared, *x, wo, u, recorder);

        // Go on.
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        float u_q = sampler.u1();
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s, beta);
        float q = survival_probability(beta, depth);
        if (u_q >= q) return L;
        beta /= q;
        recorder.roulette(q, beta);
        if (!s.specular) last = *x, pdf_b = s.pdf_w;
        only_way = s.specular && !(last && is_diffuse(*last->material));
        ray = spawn_ray(*x, s.wi);
    }
}

/// The chapter's passes: photons anew for each, then all pixels once.
inline PassTrace photon_passes(const Scene& scene, const Settings& settings) {
    struct State {
        Prepared prepared;
        Pass pass;
        uint32_t number = ~0u;
    };
    auto state = std::make_shared<State>();
    auto begin = [=, &scene](uint32_t number, int threads, const Stopped& stopped) {
        if (state->number == number) return;
        if (state->number == ~0u) state->prepared = prepare(scene, settings, threads, stopped);
        for (Maps which : {all, caustics}) {
            state->pass.paths[which] =
                send_photons(scene, state->prepared, which, number, threads, stopped);
        }
        state->pass.shrink = shrink_of(number);
        state->number = number;
    };
    auto trace_pass = [=](const Scene& s, Ray ray, Sampler& sampler, Recorder& recorder)
        __attribute__((flatten)) {
        return trace(s, state->prepared, state->pass, ray, sampler, recorder);
    };
    return {begin, trace_pass};
}

}  // namespace ch23
