// A solution made ready for the picture: --show.
#pragma once
#include "chapters/26_radiosity/estimator.h"
#include "common/picture/smooth_corners.h"

namespace ch26 {

enum class Show : uint8_t { constant, smooth };

/// Whether one surface goes on from p to q: alike, about in one plane, and no wall in between.
inline bool goes_on(const Scene& scene, const Patch& p, const Patch& q) {
    if (!(p.rho == q.rho && p.E == q.E) || dot(p.n, q.n) < 0.9f) return false;
    return sees(scene, p.centre + 0.1f * std::sqrt(p.area) * p.n,
                q.centre + 0.1f * std::sqrt(q.area) * q.n);
}

/// Shows one radiosity for each patch, W m^-2: the same at all of its corners, or smooth.
inline Shown make_shown(const Scene& scene, const std::shared_ptr<const Patches>& patches,
                        const std::vector<Rgb>& B, Show how, int threads) {
    Shown shown{patches, {}};
    const std::vector<Patch>& patch = patches->patch;
    if (how == Show::constant) {
        for (Rgb b : B) shown.B.push_back({b, b, b});
    } else {
        Triangles triangles;
        for (const Patch& p : patch) triangles.push_back(p.p);
        shown.B = smooth_corners(
            triangles, B, 4e-5f * scene.radius,
            [&](uint32_t i, uint32_t j) { return goes_on(scene, patch[i], patch[j]); }, threads);
    }
    return shown;
}

/// What is shown of a solution: B of each patch, with an estimate of the light still to come.
inline Shown show(const Scene& scene, const std::shared_ptr<const Patches>& patches,
                  const Solution& s, Show how, int threads) {
    const std::vector<Patch>& patch = patches->patch;
    Radiosity more = ambient(patch, s);
    std::vector<Rgb> B;
    for (size_t i = 0; i < patch.size(); i++)
        B.push_back(to_rgb(radiosity_of(patch[i], s.H[i] + more)));
    return make_shown(scene, patches, B, how, threads);
}

}  // namespace ch26
