#include "common/program/render.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <tuple>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/program/loading_progress.h"
#include "common/scene/camera.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"

namespace {

volatile std::sig_atomic_t stop_requested = 0;

/// While it lives, the first Ctrl-C asks for a stop after the pass; a second one ends the program.
struct StopOnInterrupt {
    StopOnInterrupt() {
        stop_requested = 0;
        std::signal(SIGINT, [](int) {
            stop_requested = 1;
            std::signal(SIGINT, SIG_DFL);
        });
    }
    ~StopOnInterrupt() { std::signal(SIGINT, SIG_DFL); }
};

class Progress {
public:
    explicit Progress(bool quiet) : on_(!quiet && isatty(STDERR_FILENO)) {}
    ~Progress() {
        if (on_) std::fprintf(stderr, "\r\033[K");
    }
    void show(double share, double seconds) {
        if (!on_ || seconds - last_ < 0.1) return;
        last_ = seconds;
        constexpr int width = 30;
        std::string bar(static_cast<size_t>(std::min(1.0, share) * width), '#');
        std::fprintf(stderr, "\r[%-*s] %3.0f %%  %.0f s left\033[K", width, bar.c_str(),
                     100 * share, seconds / share - seconds);
    }

private:
    bool on_;
    double last_ = 0;
};

/// Renders the samples [first, last) of the pixels of one tile.
class TileRenderer {
public:
    static constexpr int side = 16;             // pixels
    static constexpr size_t longest_class = 8;  // letters of a class that has its own film

    TileRenderer(const Scene& scene, const RenderOptions& options, const Trace& trace,
                 Rendering& result)
        : scene_(scene),
          options_(options),
          trace_(trace),
          result_(result),
          view_(camera_view(scene.camera, scene.width, scene.height)),
          tiles_x_((scene.width + side - 1) / side) {}

    int tiles() const { return tiles_x_ * ((scene_.height + side - 1) / side); }

    void render(int tile, int first, int last) {
        int x0 = tile % tiles_x_ * side, y0 = tile / tiles_x_ * side;
        int x1 = std::min(x0 + side, scene_.width), y1 = std::min(y0 + side, scene_.height);
        Sampler sampler(options_.sampler, options_.seed, static_cast<uint32_t>(scene_.spp));
        bool listen = !options_.paths.empty() || !options_.split.empty();
        PathLog log = listen ? PathLog(options_.paths) : PathLog();
        RenderStats stats;
        uint64_t rays_before = rays_traced;
        for (int y = y0; y < y1; y++) {
            for (int x = x0; x < x1; x++) {
                for (int s = first; s < last; s++) add_sample(x, y, s, sampler, log, stats);
            }
        }
        stats.rays = rays_traced - rays_before;
        stats.paths_cut = log.paths_cut();
        merge(stats);
    }

private:
    void add_sample(int x, int y, int s, Sampler& sampler, PathLog& log, RenderStats& stats) {
        size_t pixel =
            static_cast<size_t>(y) * static_cast<size_t>(scene_.width) + static_cast<size_t>(x);
        sampler.start(static_cast<uint32_t>(pixel), static_cast<uint32_t>(s));
        log.start();
        Vec2 u = sampler.u2();
        Ray ray = camera_ray(view_, {static_cast<float>(x) + u.x, static_cast<float>(y) + u.y});
        Rgb L = trace_(scene_, ray, sampler, log);
        if (is_finite(L)) {
            stats.largest = std::max(stats.largest, static_cast<double>(average(L)));
        } else if (stats.not_finite++ == 0) {
            stats.bad_x = x, stats.bad_y = y, stats.bad_sample = s;
        }
        result_.film.add(pixel, static_cast<uint64_t>(s), L);
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
    Rendering& result_;
    CameraView view_;
    int tiles_x_;
    std::mutex mutex_;
};

/// Reads the scene, and prints the notes even when an error follows.
Scene load_and_tell(const std::string& path, const Report& report, LoadingProgress& progress) {
    struct Notes {
        LoadingProgress& progress;
        std::vector<std::string> lines = {};
        ~Notes() {
            progress.clear();
            for (const std::string& line : lines) std::fprintf(stderr, "%s\n", line.c_str());
        }
    } notes{progress};
    return load_scene(path, &notes.lines, report);
}

}  // namespace

Scene load(const RenderOptions& options) {
    constexpr double pause = 10;  // s
    LoadingProgress progress(stderr, isatty(STDERR_FILENO), pause);
    Report report;
    if (!options.quiet) {
        report = [&](const std::string& what, double share) { progress.show(what, share); };
    }
    Scene scene = options.quiet ? load_scene(options.scene, nullptr)
                                : load_and_tell(options.scene, report, progress);
    if (options.width > 0) scene.width = options.width, scene.height = options.height;
    if (options.spp > 0) scene.spp = options.spp;
    if (options.max_depth >= 0) scene.max_depth = options.max_depth;
    prepare(scene, options.threads, report);
    return scene;
}

void refuse_delta_lights(const Scene& scene) {
    for (const Light& light : scene.lights) {
        if (light.type != LightType::point && light.type != LightType::distant) continue;
        throw InputError(scene.file + ":" + std::to_string(light.line) + ":" +
                         std::to_string(light.column) + ": error: a " +
                         (light.type == LightType::point ? "point" : "distant") +
                         " light has no size, so no path finds it by chance; "
                         "chapters from 08 on sample it");
    }
}

void refuse_glossy(const Scene& scene) {
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (!is_rough(m)) continue;
        throw InputError(scene.file + ":" + std::to_string(m.line) + ":" +
                         std::to_string(m.column) +
                         ": error: rough conductors are not supported before chapter 12");
    }
}

Rendering render_film(const Scene& scene, const RenderOptions& options, const Trace& trace) {
    Rendering result{Film(scene.width, scene.height), {}, {}};
    TileRenderer renderer(scene, options, trace, result);
    StopOnInterrupt stop;
    Progress progress(options.quiet);
    auto start = std::chrono::steady_clock::now();
    auto elapsed = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };

    // A pass takes every pixel once, or more often when they are so few that threads would idle.
    int pixels = scene.width * scene.height;  // at most 2^28
    int samples_per_pass = std::max(1, (1 << 18) / pixels);
    int spp = options.time > 0 ? (options.spp > 0 ? options.spp : 1 << 30) : scene.spp;
    int done = 0;
    do {
        int next = std::min(done + samples_per_pass, spp);
        parallel_for(renderer.tiles(), options.threads,
                     [&](int tile) { renderer.render(tile, done, next); });
        done = next;
        double seconds = elapsed();
        if (options.time > 0 && seconds >= options.time) break;
        double by_time = options.time > 0 ? seconds / options.time : 0;
        progress.show(std::max(by_time, done / static_cast<double>(spp)), seconds);
    } while (done < spp && !stop_requested);
    result.film.spp = static_cast<uint64_t>(done);
    for (auto& [path_class, film] : result.classes) film.spp = result.film.spp;
    result.stats.seconds = elapsed();
    result.stats.interrupted = stop_requested != 0;
    return result;
}

int render(const Scene& scene, const RenderOptions& options, const Trace& trace) {
    if (options.explain) return explain(scene, options, trace);
    check_outputs(options);
    return write_results(scene, options, render_film(scene, options, trace));
}
