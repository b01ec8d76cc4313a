#include "common/program/render.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <tuple>

#include "common/base/parallel.h"
#include "common/path/camera_sample.h"
#include "common/program/explain.h"
#include "common/program/progress.h"
#include "common/program/results.h"
#include "common/program/stop.h"

namespace {

/// When the render has to end before it has all samples.
class Limit {
public:
    explicit Limit(double seconds) : seconds_(seconds) {}
    bool reached() const { return signal_.requested() || (seconds_ > 0 && elapsed() >= seconds_); }
    bool interrupted() const { return signal_.requested(); }
    double elapsed() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    double seconds_;  // 0: no limit
    StopOnSignal signal_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Renders the samples [first, last) of the pixels of one tile, or fewer at the limit.
class TileRenderer {
public:
    static constexpr int side = 16;             // pixels
    static constexpr size_t longest_class = 8;  // letters of a class that has its own film
    static constexpr int between_looks = 64;    // samples from one look at the limit to the next

    TileRenderer(const Scene& scene, const RenderOptions& options, const Trace& trace,
                 const Limit& limit, Rendering& result)
        : scene_(scene),
          options_(options),
          trace_(trace),
          limit_(limit),
          result_(result),
          view_(camera_view(scene.camera, scene.width, scene.height)),
          tiles_x_((scene.width + side - 1) / side) {}

    int tiles() const { return tiles_x_ * ((scene_.height + side - 1) / side); }

    void render(int tile, int first, int last) {
        if (limit_.reached()) return;
        Sampler sampler(options_.sampler, options_.seed, static_cast<uint32_t>(scene_.spp));
        bool listen = !options_.paths.empty() || !options_.split.empty();
        PathLog log = listen ? PathLog(options_.paths) : PathLog();
        RenderStats stats;
        uint64_t rays_before = rays_traced;
        int taken = 0;
        for_pixels(tile, [&](int x, int y) {
            for (int s = first; s < last; s++) {
                if (++taken % between_looks == 0 && limit_.reached()) return false;
                add_sample(x, y, s, sampler, log, stats);
            }
            return true;
        });
        stats.rays = rays_traced - rays_before;
        stats.paths_cut = log.paths_cut();
        merge(stats);
    }

private:
    /// Calls work(x, y) for the pixels of the tile, as long as it returns true.
    template <typename Work>
    void for_pixels(int tile, const Work& work) {
        int x0 = tile % tiles_x_ * side, y0 = tile / tiles_x_ * side;
        int x1 = std::min(x0 + side, scene_.width), y1 = std::min(y0 + side, scene_.height);
        for (int y = y0; y < y1; y++) {
            for (int x = x0; x < x1; x++) {
                if (!work(x, y)) return;
            }
        }
    }

    void add_sample(int x, int y, int s, Sampler& sampler, PathLog& log, RenderStats& stats) {
        size_t pixel =
            static_cast<size_t>(y) * static_cast<size_t>(scene_.width) + static_cast<size_t>(x);
        sampler.start(static_cast<uint32_t>(pixel), static_cast<uint32_t>(s));
        log.start();
        Ray ray = camera_sample(view_, x, y, sampler, options_.pixel_centre).ray;
        Rgb L = trace_(scene_, ray, sampler, log);
        if (is_finite(L)) {
            stats.largest = std::max(stats.largest, static_cast<double>(average(L)));
        } else if (stats.not_finite++ == 0) {
            stats.bad_x = x, stats.bad_y = y, stats.bad_sample = s;
        }
        result_.film.add(pixel, L);
        if (!options_.split.empty()) split(pixel, log);
    }

    void split(size_t pixel, const PathLog& log) {
        for (const auto& [path_class, L] : log.contributions()) {
            // Keep all long paths together: their classes double with every letter.
            bool is_long = path_class.size() > longest_class;
            std::lock_guard lock(mutex_);
            auto [film, added] = result_.classes.try_emplace(is_long ? "longer" : path_class,
                                                             scene_.width, scene_.height);
            film->second.add_part(pixel, L);
        }
    }

    void merge(const RenderStats& stats) {
        std::lock_guard lock(mutex_);
        RenderStats& all = result_.stats;
        all.rays += stats.rays;
        all.paths_cut += stats.paths_cut;
        all.largest = std::max(all.largest, stats.largest);
        auto place = [](const RenderStats& s) {
            return std::tuple(s.bad_sample, s.bad_y, s.bad_x);
        };
        if (stats.not_finite > 0 && (all.not_finite == 0 || place(stats) < place(all))) {
            all.bad_x = stats.bad_x, all.bad_y = stats.bad_y, all.bad_sample = stats.bad_sample;
        }
        all.not_finite += stats.not_finite;
    }

    const Scene& scene_;
    const RenderOptions& options_;
    const Trace& trace_;
    const Limit& limit_;
    Rendering& result_;
    CameraView view_;
    int tiles_x_;
    std::mutex mutex_;
};

}  // namespace

Rendering render_film(const Scene& scene, const RenderOptions& options, const Trace& trace) {
    Rendering result{Film(scene.width, scene.height), {}, {}};
    Limit limit(options.time);
    Progress progress(options.quiet);
    TileRenderer renderer(scene, options, trace, limit, result);

    // A pass takes every pixel once, or more often when they are so few that threads would idle;
    // but no more often than all passes before, so that an early end does not leave pixels empty.
    int pixels = scene.width * scene.height;  // at most 2^28
    int most_per_pass = std::max(1, (1 << 18) / pixels);
    int spp = options.time > 0 ? (options.spp > 0 ? options.spp : 1 << 30) : scene.spp;
    for (int first = 0, last; first < spp && !limit.reached(); first = last) {
        last = first + std::min(std::clamp(first, 1, most_per_pass), spp - first);
        std::atomic<int> tiles = 0;
        parallel_for(renderer.tiles(), options.threads, [&](int tile) {
            renderer.render(tile, first, last);
            double of_pass = static_cast<double>(++tiles) / renderer.tiles();
            double seconds = limit.elapsed();
            double by_time = options.time > 0 ? seconds / options.time : 0;
            progress.show(std::max(by_time, (first + (last - first) * of_pass) / spp), seconds);
        });
    }
    for (auto& [path_class, film] : result.classes) film.count_as(result.film);
    result.stats.seconds = limit.elapsed();
    uint64_t all = static_cast<uint64_t>(pixels) * static_cast<uint64_t>(spp);
    result.stats.interrupted = limit.interrupted() && result.film.samples() < all;
    return result;
}

int render(const Scene& scene, const RenderOptions& options, const Trace& trace) {
    if (options.explain) return explain(scene, options, trace);
    check_outputs(options);
    return write_results(scene, options, render_film(scene, options, trace));
}
