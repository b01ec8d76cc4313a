// Whether a solution can be right: its numbers, its balance of energy, and paths in the same room.
#pragma once
#include <cstdio>

#include "chapters/26_radiosity/show.h"
#include "common/base/parallel.h"
#include "common/base/percent.h"
#include "common/base/position.h"
#include "common/base/stats.h"
#include "common/scene/camera.h"

namespace ch26 {

/// Throws InputError for a closed room that absorbs nothing: its light grows for ever.
/// tested by  "input: a closed room that reflects all light is refused, an open one is not"
inline void refuse_no_loss(const Scene& scene, const Patches& patches) {
    if (!patches.closed) return;
    Rgb least = {1, 1, 1};
    for (const Patch& p : patches.patch) {
        least = {std::min(least.r, p.rho.r), std::min(least.g, p.rho.g),
                 std::min(least.b, p.rho.b)};
    }
    if (max_component(least) < 1) return;
    fail({scene.file},
         "a closed room whose surfaces reflect all light has no solution: it would "
         "grow with each bounce");
}

/// Throws InputError for radiosity that is not finite, or negative.
inline void check_numbers(const std::string& file, const std::vector<Patch>& patch,
                          const Solution& s) {
    for (size_t i = 0; i < patch.size(); i++) {
        Rgb B = to_rgb(radiosity_of(patch[i], s.H[i]));
        bool good = is_finite(B) && std::min({B.r, B.g, B.b}) >= 0;
        if (good && (s.unshot.empty() || std::isfinite(largest_of(s.unshot[i])))) continue;
        char text[200];
        std::snprintf(text, sizeof text,
                      "the radiosity of the patch at (%g, %g, %g) is %g %g %g: not a number that a "
                      "picture can show",
                      double{patch[i].centre.x}, double{patch[i].centre.y},
                      double{patch[i].centre.z}, double{B.r}, double{B.g}, double{B.b});
        fail({file}, text);
    }
}

/// Throws InputError when absorbed, escaped and unshot light are not all that lamps emit.
inline void check_balance(const std::string& file, const Balance& b) {
    if (std::abs(b.error()) < 1e-6) return;
    fail({file},
         "the energy of the solution does not balance: absorbed, escaped and unshot light "
         "are " +
             percent(1 + b.error()) + " of what lamps emit");
}

/// The light that surfaces reflect to the camera, W m^-2 sr^-1, mean of the picture: by patches,
/// and by paths. emitted: what the camera sees of lamps.
struct Comparison {
    RunningStats patches, paths, difference, emitted;

    double error() const { return difference.standard_error(); }
    /// Whether the two differ by more than 5 %, than noise explains, and than rounding does.
    bool differ() const {
        return std::abs(patches.mean() - paths.mean()) >
               0.05 * paths.mean() + 2 * error() + 1e-5 * emitted.mean();
    }
    void add(const Scene& scene, const Shown& shown, Ray ray, Sampler& sampler) {
        constexpr int bounces = 16;
        double by_patches = 0, by_paths = 0, Le = 0;
        if (std::optional<Hit> x = intersect(scene, ray)) {
            Recorder recorder;
            Sampler same = sampler;  // a final gather has the first bounce of the path
            Le = double{average(emission(scene, *x))};
            by_patches = double{average(trace(scene, shown, ray, same, recorder))} - Le;
            by_paths = double{average(final_gather(scene, shown, *x, -ray.d, sampler, bounces))};
        }
        patches.add(by_patches), paths.add(by_paths), emitted.add(Le);
        difference.add(by_patches - by_paths);
    }
    void merge(const Comparison& b) {
        patches.merge(b.patches), paths.merge(b.paths), emitted.merge(b.emitted);
        difference.merge(b.difference);
    }
};

/// Compares a picture with paths of up to 16 bounces; what comes after these, patches say.
/// More paths until the error is below 1 %, at most 64 x 64 x 128; the same for any number of
/// threads.
/// tested by  "failure: patches wider than their distance to a light: too bright, and a warning"
inline Comparison compare_with_paths(const Scene& scene, const Shown& shown, int threads,
                                     const Stopped& stopped = {}) {
    constexpr int side = 64, most = 128;
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    float dx = static_cast<float>(scene.width) / side, dy = static_cast<float>(scene.height) / side;
    Comparison all;
    for (uint32_t sample = 0;; sample++) {
        std::vector<Comparison> rows(side);
        parallel_for(side, threads, [&](int y) {
            Sampler sampler(SamplerType::independent, 0, most);
            for (int x = 0; x < side; x++) {
                sampler.start(static_cast<uint32_t>(y * side + x), sample);
                Vec2 u = sampler.u2();
                Vec2 film = {(static_cast<float>(x) + u.x) * dx,
                             (static_cast<float>(y) + u.y) * dy};
                rows[static_cast<size_t>(y)].add(scene, shown, camera_ray(view, film), sampler);
            }
        });
        for (const Comparison& row : rows) all.merge(row);
        bool is_known = all.error() <= 0.01 * all.paths.mean() + 1e-5 * all.emitted.mean();
        bool is_enough = is_known || (stopped && stopped());
        if (sample + 1 == most || (sample > 2 && is_enough)) return all;
    }
}

}  // namespace ch26
