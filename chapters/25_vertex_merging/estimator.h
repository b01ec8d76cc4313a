// Chapter 25: vertex connection and merging. Photons join the bidirectional paths of chapter 22 as
// one more strategy: a path from the eye ends where many paths from lights have arrived nearby.
//
//   p_merge = p_s pdf(v) N pi r^2:    one more term in the sums of chapter 22
#pragma once
#include <memory>

#include "chapters/25_vertex_merging/light_map.h"
#include "common/path/method.h"
#include "common/path/photons.h"
#include "common/path/stored_subpaths.h"

namespace ch25 {

/// Computes what the vertices of a walk store, as in chapter 22, with one more term.
///
///   sum_j = c_j-1 + m_j-1 area pdf_j-1 + r_j-2 sum_j-1
///   m_j     1 if paths may merge at vertex j, else 0;    pdf_j: of vertex j in this walk
inline void add_sums(const Scene& scene, const Merging& merging, Subpath& walk) {
    const Path& path = walk.path;
    walk.terms.resize(path.size());
    if (walk.from_light && !path.empty())
        walk.terms[0] = {.pdf = path[0].pdf, .sum = can_be_hit(path[0].type) ? 1.0 : 0.0};
    for (size_t j = 1; j < path.size(); j++) {
        const Vertex &v = path[j - 1], &x = path[j];
        Vec3 w = direction(v, x);
        float d2 = length_squared(x.x.p - v.x.p);
        float pdf =
            pdf_forward(scene, merging.endpoints, walk, j, w) * std::abs(dot(w, x.x.ng)) / d2;
        walk.terms[j] = {pdf, walk.terms[j - 1].sum, std::abs(dot(w, v.x.ng)) / d2, -w};
        if (j == 1) continue;
        double c = path[j - 2].connectible && v.connectible ? 1 : 0;
        if (can_merge(v, walk.from_light ? path[j - 2] : x))
            c += static_cast<double>(merging.area * walk.terms[j - 1].pdf);
        float pdf_w = pdf_onwards(scene, !walk.from_light, v.x, w, walk.terms[j - 1].back);
        float r = pdf_w * walk.terms[j - 1].to_area / walk.terms[j - 2].pdf;
        walk.terms[j].sum = c + static_cast<double>(r) * walk.terms[j - 1].sum;
    }
}

/// Sum of p_i / p_n-1 over connections with fewer than n vertices of this walk, and merges before
/// its n-th vertex. pdf_w: as in chapter 22.      c_n-1 + r_n-2 sum_n-1
inline double sum_below(const Subpath& walk, size_t n, size_t fewest, float pdf_w) {
    double c = n == 1 || walk.path[n - 2].connectible ? 1 : 0;
    if (n <= fewest + 1) return c;
    const MisTerms& last = walk.terms[n - 1];
    float r = pdf_w * last.to_area / walk.terms[n - 2].pdf;
    return c + static_cast<double>(r) * last.sum;
}

/// Sum of p_i / p_s over strategies with fewer than n vertices of this walk, as in chapter 22,
/// and over merges at the n-th and before it.
///   r_n-1 (c_n-1 + m_n-1 area pdf_n-1 + r_n-2 sum_n-1)
inline double sum_of_fewer(const Merging& merging, const Subpath& walk, size_t n, size_t fewest,
                           float pdf, float pdf_w) {
    if (n <= fewest) return 0;
    double sum = sum_below(walk, n, fewest, pdf_w);
    float own_pdf = walk.terms[n - 1].pdf;
    if (walk.from_light && n > 1 && can_merge(walk.path[n - 1], walk.path[n - 2]))
        sum += static_cast<double>(merging.area * own_pdf);
    return static_cast<double>(pdf / own_pdf) * sum;
}

/// The weight of connection (s, t):      mis_s = p_s / sum over all connections and merges of p_i
/// tested by  "identity: weights of connections and merges are ...", within 5e-3, on average 2e-5
inline float mis_weight(const Scene& scene, const Merging& merging, const Subpath& light, size_t s,
                        const Subpath& eye, size_t t) {
    const Endpoints& endpoints = merging.endpoints;
    const Vertex& z = eye.path[t - 1];
    size_t fewest_t = s + t < 4 ? 2 : 1;  // 2: as in chapter 21, no splats of direct light
    if (s == 0) {
        float pdf_w = pdf_emission(z, eye.terms[t - 1].back);
        return static_cast<float>(1 / (1 + sum_of_fewer(merging, eye, t, fewest_t, z.pdf, pdf_w)));
    }
    const Vertex& y = light.path[s - 1];
    size_t fewest_s = can_be_hit(light.path[0].type) ? 0 : 1;
    Vec3 w = direction(y, z);
    float d2 = length_squared(z.x.p - y.x.p);
    float pdf_y = pdf_forward(scene, endpoints, eye, t, -w) * std::abs(dot(w, y.x.ng)) / d2;
    float pdf_z = pdf_forward(scene, endpoints, light, s, w) * std::abs(dot(w, z.x.ng)) / d2;
    float back_y = s > 1 ? pdf_onwards(scene, false, y.x, w, light.terms[s - 1].back) : 0;
    float back_z = t > 1 ? pdf_onwards(scene, true, z.x, -w, eye.terms[t - 1].back) : 0;
    double sum = 1 + sum_of_fewer(merging, light, s, fewest_s, pdf_y, back_y) +
                 sum_of_fewer(merging, eye, t, fewest_t, pdf_z, back_z);
    return sum > 0 ? static_cast<float>(1 / sum) : 0;  // 0 if vertices coincide (0 / 0)
}

/// Merges the t-th vertex from the eye with the light paths that have arrived near it.
///
///   L = beta rho / pi  sum over photons nearer than r of  mis_merge K(d / r) flux / (pi r^2)
///   K = 2 (1 - d^2 / r^2), as in chapter 23; in mis_merge, p_merge is for a disk with K = 1
///   mis_merge = 1 / (1 + sum of p_i / p_merge on the light's side + the same on the eye's side)
///
/// Biased, as in chapter 23.      source  Georgiev et al. 2012; Hachisuka et al. 2012
inline Rgb merge(const Scene& scene, const Merging& merging, const Subpath& eye, size_t t,
                 Recorder& recorder) {
    const Vertex& z = eye.path[t - 1];
    if (!z.connectible || !is_diffuse(*z.x.material)) return {};
    recorder.back_to(static_cast<int>(t));
    const MisTerms& terms = eye.terms[t - 1];
    float r = merging.map.radius();
    int depth = scene.max_depth + 2 - static_cast<int>(t);  // scattering events that are left
    float pdf_w = pdf_onwards(scene, true, z.x, terms.back, terms.back);
    double from_eye = sum_below(eye, t, 1, pdf_w) / static_cast<double>(merging.area * terms.pdf);
    Rgb sum;
    merging.map.for_each_near(z.x.p, [&](const Photon& photon, Vec3 v) {
        bool same_surface = dot(photon.ng, z.x.ng) > std::numbers::sqrt2_v<float> / 2;
        if (!same_surface || std::abs(dot(v, z.x.ng)) > r / 8 || photon.depth > depth) return;
        const LightVertex& y = merging.paths.vertices[photon.vertex];
        float back_w = pdf_cosine_hemisphere(std::max(0.0f, dot(y.wi, z.x.n)));
        double from_light = static_cast<double>(back_w) * y.others;
        float mis = static_cast<float>(1 / (1 + from_light + from_eye));
        float q = dot(v, v) / (r * r);
        Rgb flux = mis * 2 * (1 - q) * photon.flux_at(z.x);
        sum += flux;
        recorder.photon(flux, q, merging.paths.vertices, photon);
    });
    Rgb scale = z.x.material->reflectance / (pi * pi * r * r);
    recorder.gathered(scale);
    return z.beta * scale * sum;
}

/// A path from a light, and its sums.
inline Subpath walk_from_light(const Scene& scene, const Merging& merging, Sampler& sampler,
                               Recorder& recorder) {
    Subpath walk = {true, light_subpath(scene, merging.endpoints, sampler, recorder)};
    if (walk.path.size() > 1) place_light(scene, walk.path[0], walk.path[1]);
    add_sums(scene, merging, walk);
    return walk;
}

/// Estimates Li along the ray; splats the light path's contributions to other pixels.
///
///   L = sum over s, t of  mis_s,t (path of s vertices from the light, t from the eye)
///     + sum over t of     mis_merge (photons near the t-th vertex from the eye)
///
/// Biased where paths merge; consistent, as the radius shrinks from pass to pass.
/// tested by  "ch25 vertex merging", within 5 standard errors; no mirror or glass: exactly as 22
inline Rgb trace(const Scene& scene, const Merging& merging, Ray ray, Splats& splats,
                 Sampler& sampler, Recorder& recorder) {
    // Walk from a light and from the eye as in chapter 22.
    if (scene.camera.lens_radius > 0) ray = through_lens(scene.camera, ray, sampler.u2());
    sampler.jump(1 << 12);
    Subpath light = walk_from_light(scene, merging, sampler, recorder);
    sampler.jump(8);
    recorder.start_at_eye();
    Subpath eye = {false, random_walk(scene, merging.endpoints, false, ray, sampler, recorder)};
    eye.path[0].x.p = ray.o, eye.path[0].connectible = scene.camera.lens_radius == 0;
    place_light(scene, eye.path.back(), *(eye.path.end() - 2));
    add_sums(scene, merging, eye);

    // Connect every vertex of one path to every vertex of the other.
    Rgb sum;
    bool direct = scene.max_depth > 0 && !scene.sky_image && eye.path[1].connectible;
    size_t longest = static_cast<size_t>(scene.max_depth) + 2;
    for (size_t t = 1; t <= eye.path.size(); t++) {
        for (size_t s = t == 1 ? 3 : 0; s <= light.path.size() && s + t <= longest; s++) {
            if (direct && s + t == 3) continue;
            if (s == 1) place_light(scene, light.path[0], eye.path[t - 1]);
            Splat splat = unweighted(scene, merging.endpoints, light.path, s, eye.path, t);
            if (is_black(splat.L)) continue;
            float mis = mis_weight(scene, merging, light, s, eye, t);
            splat.L *= mis;
            recorder.connected(splat.L, static_cast<int>(s), static_cast<int>(t), mis, splat.pixel);
            if (t == 1) splats.push_back(splat);
            if (t > 1) sum += splat.L;
        }
    }

    // Merge every vertex of the path from the eye with the photons around it.
    for (size_t t = eye.path.size(); t > 1 && merging.area > 0; t--)
        sum += merge(scene, merging, eye, t, recorder);
    return direct ? sum + direct_light(scene, merging.lights, eye.path, sampler, recorder) : sum;
}

/// Before each pass: traces the light paths that may merge, and sorts their photons into a map.
inline void trace_light_paths(const Scene& scene, const PhotonSettings& settings, uint32_t pass,
                              int threads, const Stopped& stopped, Merging& merging) {
    float r = radius_of(settings.radius, pass);
    int N = settings.light_paths, at_once = 256, parts = (N + at_once - 1) / at_once;
    merging.area = static_cast<float>(N) * pi * r * r;
    std::vector<LightPaths> of_part(static_cast<size_t>(parts));
    parallel_for(parts, threads, [&](int part) {
        if (stopped()) return;
        Sampler sampler(settings.sampler, settings.seed, static_cast<uint32_t>(N));
        Recorder nobody;
        for (int i = part * at_once; i < std::min((part + 1) * at_once, N); i++) {
            start_sample(sampler, pass, 1, static_cast<uint32_t>(i));
            Subpath walk = walk_from_light(scene, merging, sampler, nobody);
            add_light_path(scene, walk, merging.area, N, of_part[static_cast<size_t>(part)]);
        }
    });
    merging.paths = {};
    for (const LightPaths& some : of_part) merging.paths.add(some);
    merging.map = PhotonMap(merging.paths.photons, r);
}

/// The first radius, as in chapter 23, by light paths of a trial. A photon counts as much as
/// merging does beside the strategies on the light's side; on the eye's side they hardly matter.
///
///   mis_merge ~ 1 / (1 + sum of p_i / p_merge on the light's side)
inline float choose_radius(const Scene& scene, const PhotonSettings& settings, Merging merging) {
    std::vector<SeenPoint> points = seen_points(scene);
    if (points.empty()) return scene.radius / 100;
    PhotonSettings trial = {.light_paths = std::min(settings.light_paths, 1 << 15)};
    Stopped never = [] { return false; };
    auto vertices = ::trace_light_paths(scene, merging.endpoints, trial, 0, 1, never);
    PhotonMaps maps = build_maps(std::move(vertices), 4 * pixel_width(points), false);

    // The weights are those of a pass with a radius of two pixels: N pi r^2 is the same.
    trial.light_paths *= 4;
    double share = static_cast<double>(trial.light_paths) / settings.light_paths;
    trial.radius = 2 * pixel_width(points) / static_cast<float>(std::sqrt(share));
    trace_light_paths(scene, trial, 0, 1, never, merging);
    weigh(merging.paths);
    return first_radius(points, maps.global, merging.paths.photons, share);
}

/// The settings, where the user leaves them open: two light paths for each pixel, at most a
/// million, and a first radius. No light paths where nothing is a mirror or glass.
inline PhotonSettings settings_for(const Scene& scene, PhotonSettings settings,
                                   const Merging& merging) {
    auto any = std::find_if(scene.materials.begin(), scene.materials.end(), is_specular);
    if (any == scene.materials.end()) return {.light_paths = 0};
    double most = 2.0 * scene.width * scene.height;
    if (settings.light_paths == 0) settings.light_paths = static_cast<int>(std::min(most, 1e6));
    if (settings.radius == 0) settings.radius = choose_radius(scene, settings, merging);
    return settings;
}

/// The chapter's passes: new light paths and a smaller radius for each sample of all pixels.
inline Method merging_passes(const Scene& scene, PhotonSettings settings) {
    auto merging =
        std::make_shared<Merging>(Merging{endpoints_of(scene), many_lights::prepare(scene)});
    settings = settings_for(scene, settings, *merging);
    Method method = method_of<trace>(merging);
    method.prepare = [=, &scene](uint32_t pass, int threads, const Stopped& stopped) {
        trace_light_paths(scene, settings, pass, threads, stopped, *merging);
    };
    method.first_radius = settings.radius;
    return method;
}

}  // namespace ch25
