#include "common/radiosity/display.h"

#include <map>

#include "common/base/parallel.h"
#include "common/material/basic_bsdf.h"

namespace {

/// The patches around each corner, found by where it is.
using Corner = std::array<int64_t, 3>;
Corner corner_at(Vec3 p, float size) {
    return {std::llround(p.x / size), std::llround(p.y / size), std::llround(p.z / size)};
}
std::map<Corner, std::vector<uint32_t>> find_corners(const std::vector<Patch>& patch, float size) {
    std::map<Corner, std::vector<uint32_t>> corners;
    for (uint32_t i = 0; i < patch.size(); i++)
        for (Vec3 p : patch[i].p) corners[corner_at(p, size)].push_back(i);
    return corners;
}

/// Whether one surface goes on from p to q: alike, about in one plane, and no wall in between.
bool goes_on(const Scene& scene, const Patch& p, const Patch& q) {
    if (!(p.rho == q.rho && p.E == q.E) || dot(p.n, q.n) < 0.9f) return false;
    return sees(scene, p.centre + 0.1f * std::sqrt(p.area) * p.n,
                q.centre + 0.1f * std::sqrt(q.area) * q.n);
}

/// Of each corner of each patch: the patches around it that its surface goes on to, and itself.
using Around = std::vector<std::array<std::vector<uint32_t>, 3>>;
Around find_around(const Scene& scene, const std::vector<Patch>& patch, int threads) {
    float size = 4e-5f * scene.radius;
    auto corners = find_corners(patch, size);
    Around around(patch.size());
    parallel_for(static_cast<int>(patch.size()), threads, [&](int index) {
        uint32_t i = static_cast<uint32_t>(index);
        for (size_t c = 0; c < 3; c++) {
            for (uint32_t j : corners.find(corner_at(patch[i].p[c], size))->second)
                if (j == i || goes_on(scene, patch[i], patch[j])) around[i][c].push_back(j);
        }
    });
    return around;
}

/// Where one of the corners is negative: brings them all nearer to the patch's own radiosity B, so
/// that none is, and their mean is B. (To put 0 in place of the negative would add light.)
void keep_positive(std::array<Rgb, 3>& corner, float Rgb::*channel, float B) {
    float mean = 0, least = infinity;
    for (Rgb b : corner) mean += b.*channel / 3, least = std::min(least, b.*channel);
    if (least >= 0) return;
    float keep = mean - least > B ? B / (mean - least) : 1;
    for (Rgb& b : corner) b.*channel = std::max(0.0f, B + keep * (b.*channel - mean));
}

/// The corners of --show smooth.
CornerB smooth_corners(const Scene& scene, const std::vector<Patch>& patch,
                       const std::vector<Rgb>& B, int threads) {
    constexpr int rounds = 4;
    Around around = find_around(scene, patch, threads);
    CornerB corner(patch.size());
    std::vector<Rgb> missing = B;
    for (int round = 0; round < rounds; round++) {
        std::vector<Rgb> left = missing;
        for (size_t i = 0; i < patch.size(); i++) {
            for (size_t c = 0; c < 3; c++) {
                float area = 0;
                Rgb sum;
                for (uint32_t j : around[i][c]) {
                    area += patch[j].area;
                    sum += patch[j].area * missing[j];
                }
                corner[i][c] += sum / area;
                left[i] = left[i] - sum / (3 * area);
            }
        }
        missing = left;
    }
    for (size_t i = 0; i < patch.size(); i++)
        for (float Rgb::*channel : {&Rgb::r, &Rgb::g, &Rgb::b})
            keep_positive(corner[i], channel, B[i].*channel);
    return corner;
}

}  // namespace

Shown make_shown(const Scene& scene, std::shared_ptr<const Patches> patches,
                 const std::vector<Rgb>& B, Show how, int threads) {
    Shown shown{patches, {}, how, {}};
    if (how == Show::constant) {
        for (Rgb b : B) shown.B.push_back({b, b, b});
    } else {
        shown.B = smooth_corners(scene, patches->patch, B, threads);
    }
    shown.lights = build_light_table(light_pmf(scene, 0.25));
    return shown;
}

Rgb radiosity_at(const Shown& shown, const Hit& x) {
    Place at = place_of(*shown.patches, x);
    if (at.patch == Piece::none) return {};
    const auto& b = shown.B[at.patch];
    return at.b[0] * b[0] + at.b[1] * b[1] + at.b[2] * b[2];
}

Rgb final_gather(const Scene& scene, const Shown& shown, Hit x, Vec3 wo, Sampler& sampler,
                 int bounces) {
    Rgb L, beta = {1, 1, 1};
    while (true) {
        x.n = x.ng;
        double u = to_unit_double(sampler.u2());
        LightSample y = sample_light(scene, shown.lights, x, u, sampler.u2());
        BsdfSample s = basic_bsdf::sample_bsdf(x, wo, 0, sampler.u2());
        if (y.pdf_w > 0 && !occluded(scene, spawn_ray(x, y.wi, y.dist)))
            L += beta * (basic_bsdf::eval_bsdf(x, wo, y.wi) * y.Le * (dot(y.wi, x.n) / y.pdf_w));
        if (s.pdf_w == 0) return L;
        auto z = intersect(scene, spawn_ray(x, s.wi));
        if (!z) return L;
        float cos_over_pdf = dot(s.wi, x.n) / s.pdf_w;
        if (--bounces == 0) {
            Rgb reflected = radiosity_at(shown, *z) / pi - emission(scene, *z);
            return L + beta * (s.f * reflected * cos_over_pdf);
        }
        beta = beta * s.f * cos_over_pdf;
        x = *z, wo = -s.wi;
    }
}
