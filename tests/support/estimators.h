// What the chapters that sample lights (09 to 13) are compared with: a floor under lights whose
// irradiance is known, and paths of one chapter against those of another, class by class.
#pragma once
#include <functional>

#include "tests/support/gates.h"
#include "tests/support/scenes.h"

inline constexpr double pi_exact = std::numbers::pi;

/// Black area lights of radiance 1 from here on.
inline const std::string shining =
    "AreaLightSource \"diffuse\" Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";

/// A floor y = 0 that reflects all, under this light: its radiance is irradiance / pi.
inline Scene floor_under(const std::string& light) {
    Scene scene = world_of(
        "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [1 1 1] Scale 500 1 500 " +
        square(0, true) + "AttributeEnd\n" + light);
    scene.max_depth = 1;
    return scene;
}
/// Sees the floor at the origin, from so near that nothing comes in between.
inline const Ray onto_origin = {{0, 1e-4f, 0}, {0, -1, 0}};

/// The floor at the origin.
inline Hit origin_of(const Scene& scene) { return *intersect(scene, onto_origin); }

/// The unit square at height h, facing down; x, z: where its middle is.
inline std::string unit_square(double h, double x = 0, double z = 0) {
    return "Translate " + std::to_string(x) + " " + std::to_string(h) + " " + std::to_string(z) +
           " Scale 0.5 1 0.5 " + square(0, false);
}
/// The disk of radius R at height h, facing down; x: where its middle is.
inline std::string disk(double R, double h, double x = 0) {
    return "Translate " + std::to_string(x) + " " + std::to_string(h) +
           " 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" " + std::to_string(R) + "\n";
}

/// The green channel of one ray, over and over.
inline RunningStats repeat(const Scene& scene, const Ray& ray, const Trace& trace, int paths,
                           uint32_t seed = 1, double scale = 1) {
    return in_blocks<RunningStats>(paths, [&](int first, int last) {
        RunningStats stats;
        Sampler sampler(SamplerType::independent, seed, 1);
        Recorder recorder;
        for (int i = first; i < last; i++) {
            sampler.start(0, static_cast<uint32_t>(i));
            stats.add(scale * static_cast<double>(trace(scene, ray, sampler, recorder).g));
        }
        return stats;
    });
}

/// Samples of the irradiance at the origin of floor_under().
inline RunningStats irradiance(const Scene& scene, const Trace& trace, int paths,
                               uint32_t seed = 1) {
    return repeat(scene, onto_origin, trace, paths, seed, pi_exact);
}

/// The mean is within 5 of its own standard errors, and those are at most a share `relative_se`:
/// for estimators whose samples are bounded by a few times their mean.
inline void check_bounded(const RunningStats& s, double truth, double relative_se) {
    CAPTURE(s.mean());
    CAPTURE(truth);
    CAPTURE(s.standard_error());
    CHECK(std::isfinite(s.mean()));
    CHECK(std::abs(s.mean() - truth) <= 5 * s.standard_error() + 2e-6 * truth);
    CHECK(s.standard_error() <= relative_se * truth);
}

/// Mean, variance and kurtosis of f over the unit square, by the midpoint rule.
struct SquareMoments {
    double mean = 0, variance = 0, kurtosis = 0;
};
inline SquareMoments moments_of(const std::function<double(double, double)>& f, int n = 1000) {
    double m[5] = {};
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double x = f((i + 0.5) / n, (j + 0.5) / n), power = 1;
            for (double& moment : m) moment += power, power *= x;
        }
    for (double& moment : m) moment /= static_cast<double>(n) * n;
    double variance = m[2] - m[1] * m[1];
    double fourth = m[4] - 4 * m[1] * m[3] + 6 * m[1] * m[1] * m[2] - 3 * std::pow(m[1], 4);
    return {m[1], variance, fourth / (variance * variance)};
}

/// Two chapters bring the same: in all, by length of path, and by class (those that both saw 100
/// times); of the classes that the filter matches. The log's parts make up the whole. Returns how
/// many parts were compared. Who knows a part to no better than 30 % may have too little of it:
/// a few bright paths are then most of the light, and most runs miss them. Too much is wrong.
template <class TraceA, class TraceB>
int check_classes(const Scene& scene_a, const TraceA& trace_a, const Scene& scene_b,
                  const TraceB& trace_b, int paths, uint32_t seed = 1,
                  const std::string& filter = "") {
    PathCensus a = census_of(scene_a, trace_a, paths, seed, filter);
    PathCensus b = census_of(scene_b, trace_b, paths, seed + 1, filter);
    CHECK(b.worst_sum < 1e-5);
    CHECK(z_between(a.all.measured(a.paths), b.all.measured(b.paths)) < 5);
    int compared = 0;
    auto compare = [&](const auto& parts_a, auto& parts_b) {
        for (const auto& [name_here, part] : parts_a) {
            const auto& name = name_here;
            if (part.not_zero < 100 || parts_b[name].not_zero < 100) continue;
            Measured in_a = part.measured(a.paths), in_b = parts_b[name].measured(b.paths);
            auto misses = [](Measured m, Measured other) {
                return m.se > 0.3 * m.mean && m.mean < other.mean;
            };
            if (misses(in_a, in_b) || misses(in_b, in_a)) continue;
            CAPTURE(name);
            CHECK(z_between(in_a, in_b) < 5);
            compared++;
        }
    };
    compare(a.by_length, b.by_length);
    compare(a.by_class, b.by_class);
    return compared;
}

/// relMSE of one sample for each pixel: the mean over the film of variance / (mean^2 + 0.01), with
/// the means of blocks of 8 x 8 pixels: those of single pixels are too noisy to be divided by.
inline double rel_mse(const Film& film) {
    double sum = 0, n = film.spp();
    for (int y = 0; y < film.height; y += 8)
        for (int x = 0; x < film.width; x += 8) {
            Measured block = block_of(film, x, y, 8);
            sum += 64 * n * block.se * block.se / (block.mean * block.mean + 0.01);
        }
    return sum / (film.width * film.height / 64);
}
