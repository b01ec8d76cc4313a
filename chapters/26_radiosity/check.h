// Whether a solution can be right: its numbers, its balance of energy, and paths in the same room.
#pragma once
#include <cstdio>

#include "chapters/26_radiosity/estimator.h"
#include "common/base/parallel.h"
#include "common/base/percent.h"
#include "common/base/position.h"
#include "common/base/stats.h"
#include "common/scene/camera.h"

namespace ch26 {

/// Throws InputError for radiosity that is not finite, or negative.
inline void check_numbers(const Scene& scene, const std::vector<Patch>& patch, const Solution& s) {
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
        fail({scene.file}, text);
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
/// and by paths. error: standard error of their difference; emitted: what the camera sees of lamps.
struct Comparison {
    double patches = 0, paths = 0, error = 0, emitted = 0;
    /// Whether the two differ by more than 5 %, than noise explains, and than rounding does.
    bool differ() const {
        return std::abs(patches - paths) > 0.05 * paths + 2 * error + 1e-5 * emitted;
    }
};

/// Sums over camera rays.
struct RaySums {
    RunningStats patches, paths, difference, emitted;

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
    void merge(const RaySums& b) {
        patches.merge(b.patches), paths.merge(b.paths), emitted.merge(b.emitted);
        difference.merge(b.difference);
    }
};

/// Compares a picture with paths of up to 16 bounces; what comes after these, patches say.
/// More paths until the error is below 1 %, at most 64 x 64 x 128; the same for any number of
/// threads.
/// tested by  "failure: patches wider than a light is far show too much light, and a warning"
inline Comparison compare_with_paths(const Scene& scene, const Shown& shown, int threads) {
    constexpr int side = 64, most = 128;
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    float dx = static_cast<float>(scene.width) / side, dy = static_cast<float>(scene.height) / side;
    RaySums all;
    for (uint32_t sample = 0;; sample++) {
        std::vector<RaySums> rows(side);
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
        for (const RaySums& row : rows) all.merge(row);
        Comparison c = {all.patches.mean(), all.paths.mean(), all.difference.standard_error(),
                        all.emitted.mean()};
        bool is_known = c.error <= 0.01 * c.paths + 1e-5 * c.emitted;
        if (sample + 1 == most || (sample > 2 && is_known)) return c;
    }
}

/// A patch that is wide compared with its distance to a light, both m.
struct NearLight {
    double width = 0, distance = infinity;
};

/// The patch that is widest compared with its distance to a lamp's patch before it.
inline NearLight nearest_to_light(const std::vector<Patch>& patch) {
    NearLight worst;
    for (const Patch& lamp : patch) {
        if (is_black(lamp.E)) continue;
        for (const Patch& p : patch) {
            if (!faces(p, lamp) || !faces(lamp, p)) continue;
            // From the middle of the lamp's patch to the plane of p, and beyond the edge of p.
            Vec3 d = lamp.centre - p.centre;
            float up = dot(d, p.n), along = length(d - up * p.n);
            float width = std::sqrt(longest_edge2(p.p));
            double distance = std::hypot(double{up}, double{std::max(0.0f, along - width / 2)});
            if (double{width} * worst.distance > worst.width * distance)
                worst = {double{width}, distance};
        }
    }
    return worst;
}

/// What to say of a picture that is not what paths find.
inline std::string warning_of(const Comparison& c, const std::vector<Patch>& patch) {
    NearLight near = nearest_to_light(patch);
    char text[300], where[120] = "";
    if (near.width > 0.5 * near.distance) {
        std::snprintf(where, sizeof where, "; a patch is %.3g wide, and a light is %.3g from it",
                      near.width, near.distance);
    }
    std::snprintf(text, sizeof text,
                  "the light that surfaces reflect is wrong: %.4g by patches, %.4g +- %.2g by "
                  "paths%s: take more patches, or chapter 15",
                  c.patches, c.paths, c.error, where);
    return text;
}

}  // namespace ch26
