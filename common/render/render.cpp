#include "common/render/render.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/picture/drawing.h"
#include "common/recording/class_filter.h"
#include "common/scene/intersect.h"

namespace {

/// Takes the wanted samples of each pixel tile by tile, except those already in the film.
struct TileRenderer {
    static constexpr int side = 16;             // pixels
    static constexpr size_t longest_class = 8;  // letters of a class that has its own film
    static constexpr int between_looks = 64;    // samples without rays, which check the limit

    const Scene& scene;
    const RenderOptions& options;
    const Method& method;
    const Limit& limit;
    const SampleRange wanted;
    Rendering& result;
    double interval = options.film.empty() ? HUGE_VAL : options.film_every;  // s
    double next_save = limit.elapsed() + interval;

    const bool chooses = !options.paths.empty() || !options.strategy.empty();
    const bool splits = !options.split.empty();
    const int halves = method.allocation.pilot > 0 ? 2 : 1;
    const CameraView view = camera_view(scene.camera, scene.width, scene.height);
    const int tiles_x = (scene.width + side - 1) / side;
    const int tiles = tiles_x * ((scene.height + side - 1) / side);
    Pilot pilot = start_pilot();  // what was seen of its samples; empty if they were taken before
    uint32_t end = wanted.first;  // the number after the last sample that render() takes
    std::array<SamplesOf, 2> from = samples_to(end), to = from;  // the same for halves of pixels
    std::mutex mutex = {};
    std::array<std::mutex, 1024> splat_mutexes = {};  // each for some of the pixels

    Pilot start_pilot() const {
        bool is_first = method.allocation.choose_densities && wanted.first == 0;
        if (!is_first || result.film.samples() > 0) return {};
        std::vector<PilotPixel> half(result.film.pixels().size());
        return {scene.width, {half, half}};
    }
    std::array<SamplesOf, 2> samples_to(uint32_t number) const {
        if (halves == 1) return {};
        return {method.allocation.samples(0, number), method.allocation.samples(1, number)};
    }
    bool film_is_due() const { return limit.elapsed() >= next_save; }

    /// A pass takes each pixel once, or more often if there are too few pixels to keep all threads
    /// busy; but not more often than all passes before it, so that an early end leaves no pixel
    /// empty.
    void run() {
        const Allocation& allocation = method.allocation;
        const std::vector<PixelSum>& pixels = result.film.pixels();
        auto has_fewer = [](const PixelSum& a, const PixelSum& b) { return a.n < b.n; };
        bool goes_on = !options.film.empty() && allocation.pilot == 0;
        uint32_t done = goes_on ? std::min_element(pixels.begin(), pixels.end(), has_fewer)->n : 0;
        uint32_t most_per_pass = std::max(1u, (1u << 20) / static_cast<uint32_t>(pixels.size()));
        uint32_t spp = wanted.last - wanted.first;
        Progress progress(60);
        while (done < spp && !limit.reached()) {
            uint32_t next = done + std::min(std::clamp(done, 1u, most_per_pass), spp - done);
            bool in_pilot = wanted.first == 0 && done < allocation.pilot;
            if (in_pilot) next = std::min(next, allocation.pilot);
            uint64_t rays_before = rays_traced;
            if (method.prepare) {
                next = done + 1;
                prepare(wanted.first + done);
                if (limit.reached()) break;
            }
            uint64_t rays_of_preparing = rays_traced - rays_before;
            result.begun = std::max(result.begun, next);
            end = wanted.first + next;
            to = samples_to(end);
            std::atomic<int> rendered = 0;
            parallel_for(tiles, options.threads, [&](int tile) {
                render(tile);
                double of_pass = static_cast<double>(++rendered) / tiles;
                double seconds = limit.elapsed();
                double by_time = options.time > 0 ? seconds / options.time : 0;
                double by_samples = (done + (next - done) * of_pass) / spp;
                if (!options.quiet)
                    progress.show("rendering", std::max(by_time, by_samples), seconds);
            });
            if (film_is_due()) {  // then continue the same pass
                interval = save_meanwhile(scene, options, result, interval);
                next_save = limit.elapsed() + interval;
                continue;
            }
            done = next;
            result.stats.rays += rays_of_preparing;
            bool is_seen = !pilot.half[0].empty() && done == allocation.pilot;
            if (is_seen && !limit.reached()) allocation.choose_densities(pilot, options.threads);
        }
    }

    /// Prepares what the method shares in a pass.
    void prepare(uint32_t pass) const {
        try {
            method.prepare(pass, options.threads, [&] { return limit.reached(); });
        } catch (const TracingEnds&) {
        }
    }

    /// Takes the samples of a tile's pixels; none while the film waits to be saved.
    void render(int tile) {
        if (limit.reached() || film_is_due()) return;
        Tile now;
        try {
            render_pixels(tile, now);
        } catch (const TracingEnds&) {
            // A sample that was given up is not counted: a continued render takes it again.
        }
        std::lock_guard lock(mutex);
        result.stats.add(now.stats);
        if (method.prepare) result.film.add_to_batch(end - 1, now.of_pass);
    }

    /// What the samples of a tile add up to besides its pixels.
    struct Tile {
        RenderStats stats;
        PixelSum of_pass;
    };
    struct Place {
        int x, y;
        size_t pixel;
        int half;
        uint32_t sample;  // of the half
    };
    /// What traces samples, one after the other, and the last of them.
    struct Tracer {
        explicit Tracer(const TileRenderer& r)
            : sampler(r.options.sampler, r.options.seed, static_cast<uint32_t>(r.scene.spp)),
              recorder(r.chooses || r.splits),
              chosen(r.options.paths) {}

        Sampler sampler;
        Recorder recorder;
        ClassFilter chosen;
        Rgb L = {}, total = {};  // what the sample adds to its own pixel, and to all
        Splats splats = {};
        std::vector<Contribution> parts = {};  // those selected, if they are of use
    };

    void render_pixels(int tile, Tile& now) {
        int x0 = tile % tiles_x * side, y0 = tile / tiles_x * side;
        int x1 = std::min(x0 + side, scene.width), y1 = std::min(y0 + side, scene.height);
        Tracer own(*this), again(*this);
        uint64_t rays_before = rays_traced;
        bool in_pilot = !pilot.half[0].empty() && end <= method.allocation.pilot;
        int taken = 0;
        for (int y = y0; y < y1; y++) {
            for (int i = halves * x0; i < halves * x1; i++) {
                int x = i / halves, half = i % halves;
                size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(scene.width) +
                               static_cast<size_t>(x);
                auto [s, last] = samples(pixel, half);
                PilotPixel* seen = in_pilot ? &pilot.half[half][pixel] : nullptr;
                uint64_t rays_of_others = rays_traced;
                for (; s < last; s++) {
                    bool over = limit.seen() || (++taken % between_looks == 0 && limit.reached());
                    if (over) return;
                    Place at = {x, y, pixel, half, s};
                    // For the audit the same sample again, with numbers of another key.
                    bool audited = result.film.is_audited(pixel);
                    if (audited) trace(at, 1, again);
                    add_sample(at, own, now.stats);
                    if (audited) result.film.add(pixel, again.total, 1);
                    if (method.prepare) now.of_pass.add(own.total);
                    if (seen) seen->add(own.L);
                    now.stats.rays = rays_traced - rays_before;  // of whole samples
                    now.stats.paths_cut = own.recorder.paths_cut();
                    now.stats.photons = own.recorder.photons();
                    now.stats.inner_photons = own.recorder.inner_photons();
                }
                if (seen) seen->rays += static_cast<uint32_t>(rays_traced - rays_of_others);
            }
        }
    }

    /// The number of the next sample of a pixel's half, and the end: one more than the last to
    /// take.
    std::pair<uint32_t, uint32_t> samples(size_t pixel, int half) const {
        uint32_t done = result.film.half(half)[pixel].n;
        if (halves == 1) return {wanted.first + done, end};
        size_t of = static_cast<size_t>(half);
        return {from[of](pixel) + done, to[of](pixel)};
    }

    [[gnu::always_inline]] void trace(const Place& at, int half, Tracer& t) {
        start_sample(t.sampler, at.pixel, half, at.sample);
        t.recorder.start();
        bool centre = scene.camera.pixel_centre;
        Ray ray = camera_ray(view, film_point(at.x, at.y, t.sampler, centre));
        t.splats.clear();
        t.L = method.trace(scene, ray, t.splats, t.sampler, t.recorder);
        if (chooses || splits) choose(t);
        t.total = t.L;
        for (const Splat& splat : t.splats) t.total += splat.L;
    }

    /// Reduces a sample and its splats to the selected contributions.
    void choose(Tracer& t) {
        t.parts = t.recorder.contributions();
        std::erase_if(t.parts, [&](const Contribution& part) {
            bool other = !options.strategy.empty() && part.way != options.strategy;
            return other || !t.chosen.matches(part.path_class);
        });
        for (Contribution& part : t.parts)
            if (options.unweighted) part.L = part.L / part.mis;
        if (!chooses) return;
        t.L = {};
        t.splats.clear();
        for (const Contribution& part : t.parts) {
            bool own = part.pixel == Contribution::own_pixel;
            if (own) t.L += part.L;
            if (!own) t.splats.push_back({part.pixel, part.L});
        }
    }

    void add_sample(const Place& at, Tracer& t, RenderStats& stats) {
        trace(at, at.half, t);
        int number = static_cast<int>(at.sample) * halves + at.half;
        SampleAt sample = {options.seed, at.y, at.x, number};
        double value = static_cast<double>(average(t.total));
        if (!is_finite(t.total)) stats.add_not_finite(sample);
        if (is_finite(t.total) && value >= stats.largest) stats.add_largest(value, sample);
        result.film.add(at.pixel, t.L, at.half);
        if (method.splats) {
            result.film.add_total(at.pixel, t.total);
            for (const Splat& splat : t.splats) {
                std::lock_guard lock(splat_mutexes[splat.pixel % splat_mutexes.size()]);
                result.film.splat(splat.pixel, splat.L);
            }
        }
        if (splits)
            for (const Contribution& part : t.parts) add_to_class(part, at);
    }

    /// Adds to the film of the contribution's class. All long paths share one: the number of
    /// classes doubles with every letter.
    void add_to_class(const Contribution& part, const Place& at) {
        bool is_long = part.path_class.size() > longest_class;
        std::lock_guard lock(mutex);
        auto [film, is_new] = result.classes.try_emplace(is_long ? "longer" : part.path_class,
                                                         scene.width, scene.height, method.splats);
        if (is_new && result.film.has_halves()) film->second.start_halves();
        bool own = part.pixel == Contribution::own_pixel;
        if (own) film->second.add_part(at.pixel, part.L, at.half);
        if (!own) film->second.splat(part.pixel, part.L);
    }
};

}  // namespace

void mark_lamp_edges(const Scene& scene, int threads, Film& film) {
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    std::vector<float> seen(film.pixels().size());
    parallel_for(scene.height, threads, [&](int y) {
        for (int i = y * scene.width; i < (y + 1) * scene.width; i++) {
            std::optional<Hit> hit = intersect(scene, pixel_ray(scene, view, i));
            seen[static_cast<size_t>(i)] = average(hit ? emission(scene, *hit) : scene.sky);
        }
    });
    auto compare = [&](size_t a, size_t b) {
        if (std::abs(seen[a] - seen[b]) <= 0.01f * std::max(seen[a], seen[b])) return;
        film.mark_edge(a);
        film.mark_edge(b);
    };
    size_t width = static_cast<size_t>(scene.width);
    for (size_t i = 0; i < seen.size(); i++) {
        if (i % width + 1 < width) compare(i, i + 1);
        if (i + width < seen.size()) compare(i, i + width);
    }
}

Rendering render_film(const Scene& scene, const RenderOptions& options, const Method& method) {
    uint32_t pilot = method.allocation.pilot;
    Rendering result{Film(scene.width, scene.height, method.splats), {}, {}};
    Limit limit(options.time);
    TracingLimit tracing([&] { return limit.overdue(); });
    if (pilot > 0) {
        result.film.start_halves();
    } else if (options.sampler != SamplerType::independent) {
        try {
            mark_lamp_edges(scene, options.threads, result.film);
        } catch (const TracingEnds&) {
        }
        result.film.start_audit();
    }
    if (method.prepare) {
        result.film.start_batches();
        result.stats.first_radius = double{method.first_radius};
    }
    continue_film(scene, options, result);
    SampleRange wanted = wanted_samples(scene, options);

    // Render the pilot again if this render does not start with it.
    if (pilot > 0 && (wanted.first > 0 || result.film.samples() > 0)) {
        RenderOptions alone = options;
        alone.film.clear();
        alone.split.clear();
        Rendering again{Film(scene.width, scene.height), {}, {}};
        again.film.start_halves();
        TileRenderer{scene, alone, method, limit, {options.seed, 0, pilot}, again}.run();
    }
    TileRenderer{scene, options, method, limit, wanted, result}.run();
    for (auto& [path_class, film] : result.classes) film.count_as(result.film);
    result.stats.seconds = limit.elapsed();
    result.stats.interrupted = limit.interrupted();
    return result;
}

int render(const Scene& scene, const RenderOptions& options, const Method& method) {
    check_outputs(scene, options);
    if (options.explain) return explain(scene, options, method);
    Limit until_all_is_written;
    return write_results(scene, options, render_film(scene, options, method));
}
