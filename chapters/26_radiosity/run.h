// What surrounds the lesson: the order of the work, its costs, pictures on the way, and the report.
#pragma once
#include <cstdio>

#include "chapters/26_radiosity/check.h"
#include "chapters/26_radiosity/settings.h"
#include "chapters/26_radiosity/tessellate.h"
#include "chapters/26_radiosity/variants.h"
#include "common/base/report.h"
#include "common/path/trace.h"
#include "common/picture/notes.h"
#include "common/program/render.h"
#include "common/radiosity/files.h"
#include "common/radiosity/refuse.h"
#include "common/rendering/code_hash.h"
#include "common/rendering/film_keeping.h"
#include "common/rendering/progress.h"
#include "common/rendering/tile_renderer.h"
#include "common/results/results.h"

namespace ch26 {

/// What a film of radiosity is of: all that decides the solution, but not how far it is.
inline std::string film_label(const Scene& scene, const RenderOptions& options,
                              const Settings& settings, size_t patches) {
    const char* ways[] = {"point", "chance", "contour"};
    char checksum[17];
    std::snprintf(checksum, sizeof checksum, "%016llx",
                  static_cast<unsigned long long>(scene.files_checksum));
    return "radiosity of path-by-path, version 2\ncode " + code_hash(options.name) + "\nscene " +
           checksum + "\npatches " + std::to_string(patches) + "\nform-factors " +
           ways[static_cast<size_t>(settings.way)] + "\nseed " + std::to_string(options.seed) +
           "\n\n";
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

/// The numbers of a solution, for its film.
inline Pieces numbers_of(Solution& s) {
    return {std::as_writable_bytes(std::span(&s.steps, 1)),
            std::as_writable_bytes(std::span(&s.escaped, 1)),
            std::as_writable_bytes(std::span(s.H)), std::as_writable_bytes(std::span(s.unshot))};
}

/// What leaves the room, W, by the rows of a matrix.
inline Radiosity escaped_by(const Matrix& m, const std::vector<Patch>& patch, const Solution& s) {
    Radiosity escaped;
    for (size_t i = 0; i < m.size(); i++) {
        double sum = 0;
        for (float G : m[i]) sum += double{G};
        escaped += (double{patch[i].area} - sum) * radiosity_of(patch[i], s.H[i]);
    }
    return escaped;
}

/// One run of the program: patches, solution, pictures.
class Run {
public:
    Run(const Scene& scene, const RenderOptions& options, const Settings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          limit_(options.time),
          patches_(std::make_shared<Patches>(make_patches(scene, settings.patches, options.threads,
                                                          [&] { return limit_.reached(); }))),
          rows_(form_factors(scene, *patches_, settings.way, options.seed, options.threads)) {
        refuse_no_loss(scene, *patches_);
        options_.film.clear();  // it is of the solution, not of a picture
        film_ = options.film;
    }

    int run() {
        tell_costs();
        settings_.solver == Solver::southwell ? refine() : sweep();
        check_numbers(scene_.file, patches_->patch, solution_);
        tell_result();
        double seconds = limit_.elapsed();
        bool over = limit_.reached(), stopped = limit_.take_interruption();
        // More patches are as small as pixels, and to smooth them takes long.
        bool quickly = over && n() > 50000;
        Shown shown = shown_now(quickly ? Show::constant : settings_.show);
        if (!stopped && n() > 0) compare_paths(shown, [&] { return over || limit_.interrupted(); });
        if (n() == 0) warnings_.push_back("rendering ended before there were patches");
        double missing = n() > 0 ? -balance_of(patches_->patch, solution_).error() : 0;
        if (missing > 0.001) {
            warnings_.push_back("sweeps ended before " + percent(missing) +
                                " of the light had arrived");
        }
        stopped |= limit_.take_interruption();
        if (stopped || options_.time > 0) {  // a picture soon
            options_.time = stopped ? 0.5 : std::max(0.5, options_.time - limit_.elapsed());
            options_.spp = scene_.spp;  // else as many as there is time for
        }
        Rendering picture = render_film(scene_, options_, trace_with<trace>(shown));
        picture.stats.seconds += seconds;
        if (stopped) picture.stats.interrupted = true;
        picture.warnings = warnings_;
        if (!film_.empty() && n() > 0) picture.files.push_back({film_, [&] { save_film(); }});
        if (!settings_.mesh.empty()) {
            picture.files.push_back(
                {settings_.mesh,
                 [&] { write_mesh(settings_.mesh, triangles_of(patches_->patch), shown.B); }});
        }
        int code = write_results(scene_, options_, picture);
        return code == 0 && failed_ ? 1 : code;
    }

private:
    size_t n() const { return patches_->patch.size(); }
    Shown shown_now(Show how) const {
        return show(scene_, patches_, solution_, how, options_.threads);
    }

    /// Says what memory and time all form factors take, before they are worked out.
    void tell_costs() {
        if (n() == 0) return;
        auto begin = limit_.elapsed();
        constexpr size_t tried = 3;
        for (size_t i = 0; i < tried && (i == 0 || !limit_.reached()); i++)
            rows_.row(i * (n() - 1) / tried);
        double seconds = (limit_.elapsed() - begin) / tried * static_cast<double>(n());
        if (rows_.keeps()) seconds /= 2;  // each pair once
        double size = static_cast<double>(n());
        if (settings_.solver != Solver::southwell && !rows_.keeps()) {
            throw UsageError("error: --solver: the matrix of " + std::to_string(n()) +
                             " patches has more than 1 GiB; southwell needs none");
        }
        if (options_.quiet) return;
        std::printf(
            "%zu patches in %s room: %.3g million form factors, %.3g MB%s, about %.2g s for all\n",
            n(), patches_->closed ? "a closed" : "an open", size * size / 1e6,
            static_cast<double>(rows_.bytes()) / 1e6,
            rows_.keeps() ? "" : " (too many to keep: rows are worked out again)", seconds);
        std::fflush(stdout);
    }

    /// Progressive refinement, from the film if there is one.
    void refine() {
        if (n() == 0) return;  // interrupted before there were patches
        const std::vector<Patch>& patch = patches_->patch;
        start(patch, solution_);
        check_numbers(scene_.file, patch, solution_);
        if (finds_film()) {
            read_numbers(film_, label(), numbers_of(solution_));
            check_numbers(film_, patch, solution_);
            check_balance(film_, balance_of(patch, solution_));
        }
        Progress progress(options_.quiet);
        double saved = limit_.elapsed(), first = share_to_come(patch, solution_), last = 1;
        double shots = static_cast<double>(settings_.shots);  // 0: no limit
        while (!limit_.reached() && (settings_.shots == 0 || solution_.steps < settings_.shots)) {
            // Asked after the same shots in whatever runs they are done.
            if (solution_.steps % 16 == 0) last = share_to_come(patch, solution_);
            if (settings_.shots == 0 && last < enough) break;
            std::optional<size_t> i = brightest(patch, solution_);
            if (!i) break;
            shoot(*patches_, *i, rows_.row(*i), solution_);
            double by_share = std::log(last / first) / std::log(enough / first);
            double by_shots = shots == 0 ? 0 : static_cast<double>(solution_.steps) / shots;
            progress.show(std::max(by_share, by_shots), limit_.elapsed());
            if (settings_.every > 0 && solution_.steps % settings_.every == 0)
                failed_ |= !done([&] { write_picture(); });
            if (!film_.empty() && limit_.elapsed() - saved > options_.film_every) {
                done([&] { save_film(); });
                saved = limit_.elapsed();
            }
        }
        check_balance(scene_.file, balance_of(patch, solution_));
    }

    /// Whether it could be done; when a file cannot be written, says so, and the work goes on.
    template <class Write>
    static bool done(const Write& write) {
        try {
            write();
            return true;
        } catch (const InputError& error) {
            tell(error.what() + std::string("\n"));
            return false;
        }
    }
    std::string label() const { return film_label(scene_, options_, settings_, n()); }
    void save_film() { save_numbers(film_, label(), numbers_of(solution_), film_lock_.get()); }
    /// Whether there is a film to continue; else makes one.
    bool finds_film() {
        if (film_.empty()) return false;
        film_lock_ = std::make_shared<FileLock>(film_);
        bool is_new = size_of(film_) == 0;
        uint64_t bytes = label().size() + sizeof(uint64_t);
        for (auto piece : numbers_of(solution_)) bytes += piece.size();
        check_space({{film_, (is_new ? 2 : 1) * bytes}});  // each is written beside the one before
        if (is_new) done([&] { save_film(); });
        return !is_new;
    }
    void write_picture() {
        RenderOptions quiet = options_;
        quiet.quiet = true, quiet.time = 0;
        Rendering r = render_film(scene_, quiet, trace_with<trace>(shown_now(Show::smooth)));
        Notes notes = notes_of(label_of(scene_, quiet, r), r.film.spp());
        write_image(numbered(options_.out[0], solution_.steps), r.film.image(),
                    comment_of(with(notes, "shots", std::to_string(solution_.steps))));
    }

    /// The whole matrix, repaired, and sweeps over it.
    void sweep() {
        const std::vector<Patch>& patch = patches_->patch;
        Progress progress(options_.quiet);
        for (size_t i = 0; i < n() && !limit_.reached(); i++) {
            rows_.row(i);
            double left = 1 - static_cast<double>(i + 1) / static_cast<double>(n());
            progress.show(1 - left * left, limit_.elapsed());
        }
        solution_.H.resize(n());
        if (limit_.reached()) return;
        Matrix G = rows_.take_all();
        Stopped stopped = [&] { return limit_.reached(); };
        repair(G, patch, patches_->closed, stopped);
        Sweep kind = settings_.solver == Solver::jacobi ? Sweep::jacobi : Sweep::gauss_seidel;
        solve(G, patch, kind, 1e-10, solution_, stopped);
        solution_.escaped = escaped_by(G, patch, solution_);
    }

    /// Says what paths find in the place of patches, and warns where that is something else.
    void compare_paths(const Shown& shown, const Stopped& stopped) {
        Comparison c = compare_with_paths(scene_, shown, options_.threads, stopped);
        char text[100];
        std::snprintf(text, sizeof text, "%.4g by patches, %.4g +- %.2g by paths", c.patches.mean(),
                      c.paths.mean(), c.error());
        if (!options_.quiet) std::printf("surfaces reflect %s\n", text);
        if (!c.differ()) return;
        warnings_.push_back("the light that surfaces reflect is wrong: " + std::string(text) +
                            ": take more patches, or chapter 15");
    }

    void tell_result() const {
        if (options_.quiet || n() == 0) return;
        const RowSums& sums = rows_.sums();
        std::printf("row sums %.4f to %.4f before their repair\n", sums.lowest, sums.highest);
        Balance b = balance_of(patches_->patch, solution_);
        auto share = [&](double x) { return percent(std::max(0.0, x / b.emitted)); };  // not -0
        std::printf("%llu %s: of %.4g W %s absorbed, %s out of the room, %s unshot (off by %.1g)\n",
                    static_cast<unsigned long long>(solution_.steps),
                    settings_.solver == Solver::southwell ? "shots" : "sweeps", b.emitted,
                    share(b.absorbed).c_str(), share(b.escaped).c_str(), share(b.unshot).c_str(),
                    std::abs(b.error()));
    }

    static constexpr double enough = 1e-3;  // of the light: may be unshot at the end

    const Scene& scene_;
    RenderOptions options_;
    Settings settings_;
    std::string film_;
    std::shared_ptr<FileLock> film_lock_;
    Limit limit_;
    std::shared_ptr<Patches> patches_;
    Rows rows_;
    Solution solution_;
    std::vector<std::string> warnings_;
    bool failed_ = false;  // to write a picture on the way
};

}  // namespace ch26
