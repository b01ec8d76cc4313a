// What surrounds the lesson: the order of the work, the report, and what is shown.
#pragma once
#include <cstdio>

#include "chapters/26_radiosity/estimator.h"
#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/base/text.h"
#include "common/path/method.h"
#include "common/picture/drawing.h"
#include "common/render/render.h"
#include "common/scene/prepare.h"

namespace ch26 {

enum class Solver : uint8_t { southwell, gauss_seidel, jacobi };
enum class Show : uint8_t { constant, smooth };

/// What the user asks for beside what all programs know.
struct Settings {
    size_t patches = 5000;
    Solver solver = Solver::southwell;
    Show show = Show::smooth;
    uint64_t shots = 0;  // at most; 0: until little is unshot
};

/// Throws InputError for more patches than there is room for.
inline void refuse_many(const Scene& scene, size_t patches) {
    constexpr size_t most = 16384;
    if (patches <= most) return;
    fail({scene.origin->file},
         std::to_string(patches) +
             " patches have a matrix of more than 1 GiB: radiosity takes at most " +
             std::to_string(most));
}

/// Which share of its light a patch still waits for, by the ambient estimate: the mean over all
/// areas, so that a dim room counts as much as a bright one. Light below a millionth of the mean
/// counts as none. As if a bounce kept 99 % at most: where it keeps more, what is unshot after so
/// many bounces is even, and the estimate of it is shown.
inline double share_to_come(const std::vector<Patch>& patch, const Solution& s) {
    double received = 0, area = 0, waits = 0, more = sum_of(ambient(patch, s, 0.99));
    for (size_t i = 0; i < patch.size(); i++) {
        received += double{patch[i].area} * sum_of(s.H[i]), area += double{patch[i].area};
    }
    if (more == 0) return 0;
    double none = 1e-6 * received / area;
    for (size_t i = 0; i < patch.size(); i++)
        waits += double{patch[i].area} * (more / (sum_of(s.H[i]) + more + none));
    return waits / area;
}

/// How far the shots are: what a bar shows, and what ends them.
struct Shots {
    const Patches& patches;
    const Limit& limit;
    bool quiet;
    Progress progress{60};
    double first = 0, last = 1;  // share to come, at the first shot and at the last look

    bool are_enough(const Solution& s) {
        constexpr double enough = 1e-3;  // of the light: may be unshot at the end
        if (s.steps % 16 == 0) {
            last = share_to_come(patches.patch, s);
            if (s.steps == 0) first = last;
            double share = std::log(last / first) / std::log(enough / first);
            if (!quiet && last > enough) progress.show("shooting", share, limit.elapsed());
        }
        return last < enough;
    }
};

/// Progressive refinement.
///
/// most_shots    0: until they are enough
inline Solution refine(const Patches& patches, Matrix& G, const ExchangeOf& exchange,
                       uint64_t most_shots, const Limit& limit, const RenderOptions& o) {
    Solution s;
    start(patches.patch, s);
    Shots shots{patches, limit, o.quiet};
    while (!limit.reached()) {
        if (most_shots > 0 ? s.steps == most_shots : shots.are_enough(s)) break;
        std::optional<size_t> i = brightest(patches.patch, s);
        if (!i) break;
        shoot(patches, *i, row_of(G, *i, o.threads, exchange), s);
    }
    return s;
}

/// The whole matrix, repaired, and sweeps over it.
inline Solution sweep_all(const Patches& patches, Matrix& G, const ExchangeOf& exchange, Sweep kind,
                          int threads, const Limit& limit) {
    Solution s;
    s.H.resize(G.size());
    Stopped stopped = [&] { return limit.reached(); };
    for (size_t i = 0; i < G.size() && !stopped(); i++) row_of(G, i, threads, exchange);
    if (stopped()) return s;
    Matrix repaired = G;
    repair(repaired, patches.patch, patches.closed, stopped);
    solve(repaired, patches.patch, kind, 1e-10, s, stopped);
    for (size_t i = 0; i < G.size(); i++) {
        double out = double{patches.patch[i].area} * (1 - row_sum(repaired[i], patches.patch[i]));
        s.escaped += out * radiosity_of(patches.patch[i], s.H[i]);
    }
    return s;
}

/// Says how good the form factors are, and where the light went.
inline void report(const Patches& patches, const Matrix& G, const Solution& s, const char* steps) {
    double lowest = infinity, highest = 0;
    for (size_t i = 0; i < G.size(); i++) {
        if (G[i].empty()) continue;
        double sum = row_sum(G[i], patches.patch[i]);
        lowest = std::min(lowest, sum), highest = std::max(highest, sum);
    }
    std::printf("%zu patches in %s room\nrow sums %.4f to %.4f before their repair\n", G.size(),
                patches.closed ? "a closed" : "an open", lowest, highest);
    Balance b = balance_of(patches.patch, s);
    auto share = [&](double x) { return percent(std::max(0.0, x / b.emitted)); };  // not -0
    std::printf("%llu %s: of %.4g W %s absorbed, %s out of the room, %s unshot (off by %.1g)\n",
                static_cast<unsigned long long>(s.steps), steps, b.emitted,
                share(b.absorbed).c_str(), share(b.escaped).c_str(), share(b.unshot).c_str(),
                std::abs(b.error()));
}

/// The share of the light that lamps send to patches larger than they are, and wider than their
/// distance from the lamp: there the light of a patch is not even.
/// tested by  "failure: patches wider than their distance to a light: too bright, and a warning"
inline double share_on_wide_patches(const std::vector<Patch>& patch, const Matrix& G) {
    double wide = 0, all = 0;
    for (size_t i = 0; i < patch.size(); i++) {
        for (size_t j = 0; j < G[i].size() && !is_black(patch[i].E); j++) {
            double power = double{G[i][j]} * double{average(patch[i].E)};
            Vec3 d = patch[j].centre - patch[i].centre;
            all += power;
            bool is_larger = patch[j].area > 4 * patch[i].area;
            if (is_larger && longest_edge2(patch[j].p) > length_squared(d)) wide += power;
        }
    }
    return all > 0 ? wide / all : 0;
}

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

/// One run of the program: patches, solution, picture. Time and signals end the solution, and then
/// the picture, soon.
inline int run(const Scene& scene, RenderOptions options, const Settings& settings) {
    Limit limit(options.time);
    refuse_many(scene, 2 * scene.geometry.triangles.size());
    auto patches =
        std::make_shared<Patches>(make_patches(scene, settings.patches, options.threads));
    refuse_many(scene, patches->patch.size());

    // Solve.
    Matrix G(patches->patch.size());
    ExchangeOf exchange = form_factors(scene, *patches, options.seed);
    bool shoots = settings.solver == Solver::southwell;
    Sweep kind = settings.solver == Solver::jacobi ? Sweep::jacobi : Sweep::gauss_seidel;
    Solution s = shoots ? refine(*patches, G, exchange, settings.shots, limit, options)
                        : sweep_all(*patches, G, exchange, kind, options.threads, limit);
    if (!options.quiet) report(*patches, G, s, shoots ? "shots" : "sweeps");
    std::vector<std::string> warnings;
    double error = balance_of(patches->patch, s).error();
    double wide = share_on_wide_patches(patches->patch, G);
    if (error < -0.001)
        warnings.push_back("sweeps ended before " + percent(-error) + " of the light had arrived");
    if (wide > 0.05) {
        warnings.push_back(
            percent(wide) +
            " of the lamps' light falls on patches wider than their distance from "
            "the lamp: the picture is wrong there; take more patches, or chapter 15");
    }

    // Render.
    Shown shown = show(scene, patches, s, settings.show, options.threads);
    double seconds = limit.elapsed();
    bool stopped = stop_requested.exchange(false);
    if (options.time > 0) options.time = std::max(0.5, options.time - seconds);
    if (stopped) options.time = 0.5;                // a picture soon
    if (options.time > 0) options.spp = scene.spp;  // else as many as there is time for
    Rendering rendering = render_film(scene, options, method_of<trace>(shown));
    rendering.stats.seconds += seconds;
    if (stopped) rendering.stats.interrupted = true;
    rendering.warnings = warnings;
    return write_results(scene, options, rendering);
}

}  // namespace ch26
