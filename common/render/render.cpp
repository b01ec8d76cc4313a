#include "common/render/render.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cinttypes>
#include <filesystem>
#include <mutex>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/base/ray_count.h"
#include "common/base/system.h"
#include "common/picture/drawing.h"
#include "common/recording/class_filter.h"
#include "common/scene/intersect.h"
#include "common/scene/prepare.h"

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
    // s; if it were shorter, nothing would be rendered in between
    double interval = options.film.empty() ? HUGE_VAL : std::max(options.film_every, 0.01);
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
                method.prepare(wanted.first + done, options.threads,
                               [&] { return limit.reached(); });
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

/// The options that decide the samples, except seeds and sample numbers.
Notes film_options(const Scene& scene, const RenderOptions& o) {
    constexpr const char* samplers[] = {"independent", "stratified", "sobol"};
    bool has_strata = o.sampler == SamplerType::stratified;  // as many strata as samples
    Notes options = {{"chapter", o.name},
                     {"code", code_hash(o.name)},
                     {"scene", printable(file_name(file_path(scene.origin->file).filename()))},
                     {"checksum", format("%016" PRIx64, scene.origin->checksum)},
                     {"size", std::to_string(scene.width) + "x" + std::to_string(scene.height)},
                     {"max-depth", std::to_string(scene.max_depth)},
                     {"sampler", samplers[static_cast<size_t>(o.sampler)]},
                     {"strata", has_strata ? std::to_string(scene.spp) : ""},
                     {"paths", o.paths}};
    options.insert(options.end(), o.own.begin(), o.own.end());
    // Without folders: the same on every machine.
    std::string stand_ins;
    for (UsedStandIn used : scene.origin->stand_ins) {
        used.first.file = file_name(file_path(used.first.file).filename());
        stand_ins += (stand_ins.empty() ? "" : "; ") + used.text();
    }
    if (!stand_ins.empty()) options.push_back({"stand-ins", stand_ins});
    return options;
}

/// The samples of a pixel that the options ask for: all, or those of a part. Their number is not
/// limited with --time but without --spp. Throws UsageError if there are more parts than samples.
SampleRange wanted_samples(const Scene& scene, const RenderOptions& o) {
    if (o.parts > scene.spp)
        throw UsageError(format("error: --part: there are %d samples, too few for %d parts",
                                scene.spp, o.parts));
    bool is_endless = o.time > 0 && o.spp == 0 && o.parts == 1;  // until the time is up
    if (is_endless) return {o.seed, 0, PixelSum::most};
    int spp = o.time > 0 && o.spp > 0 ? o.spp : scene.spp;
    Goal goal = {static_cast<uint32_t>(spp), static_cast<uint32_t>(o.parts)};
    return {o.seed, goal.first_of(o.part), goal.first_of(o.part + 1), goal};
}

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

void continue_film(const Scene& scene, const RenderOptions& options, Rendering& rendering) {
    if (options.film.empty()) return;
    rendering.film_lock = lock_of(options.film);
    std::error_code none;
    bool is_there = std::filesystem::file_size(file_path(options.film), none) > 0 && !none;
    if (!is_there) return save_film(scene, options, rendering);
    LabeledFilm found = read_film(options.film);
    check_fits(options.film, found, film_options(scene, options), rendering.film);
    if (found.label.samples.empty()) return;  // it was stopped before it had samples
    SampleRange wanted = wanted_samples(scene, options);
    SampleRange r = found.label.samples[0];
    bool is_one = found.label.samples.size() == 1;
    if (!is_one || r.seed != wanted.seed || r.first != wanted.first || r.last > wanted.last)
        fail({options.film}, "it holds " + text_of(r) + (is_one ? "" : " and others") +
                                 ", which do not begin what is asked for: " + text_of(wanted));
    rendering.film = std::move(found.film);
    rendering.begun = r.last - r.first;
    static_cast<SampleCounts&>(rendering.stats) = found.label.counts;
    rendering.stats.rays_before = rendering.stats.rays;
    rendering.stats.samples_before = rendering.film.samples();
}

FilmLabel label_of(const Scene& scene, const RenderOptions& options, const Rendering* rendering) {
    FilmLabel label = {film_options(scene, options), {wanted_samples(scene, options)}, {}};
    if (!rendering) return label;
    label.counts = rendering->stats;
    const Film& film = rendering->film;
    uint32_t most = 0;
    for (const PixelSum& p : film.pixels()) most = std::max(most, p.n);
    if (film.has_halves()) most = film.samples() > 0 ? rendering->begun : 0;
    label.samples[0].last = label.samples[0].first + most;
    if (most == 0) label.samples.clear();
    return label;
}

void save_film(const Scene& scene, const RenderOptions& options, const Rendering& rendering) {
    if (options.film.empty()) return;
    write_film(options.film, label_of(scene, options, &rendering), rendering.film);
}

#ifndef __EMSCRIPTEN__  // in the book, the page gets a picture instead: common/book/live.cpp
double save_meanwhile(const Scene& scene, const RenderOptions& options, const Rendering& rendering,
                      double interval) {
    try {
        save_film(scene, options, rendering);
    } catch (const InputError& error) {
        tell(error.what() + std::string("\n"));
    }
    return interval;
}
#endif

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
    if (method.prepare) result.film.start_batches();
    result.stats.first_radius = double{method.first_radius};
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
    try {
        TileRenderer{scene, options, method, limit, wanted, result}.run();
    } catch (const TracingEnds&) {
        // There was no time to prepare another pass.
    }
    for (auto& [path_class, film] : result.classes) film.count_as(result.film);
    result.stats.seconds = limit.elapsed();
    result.stats.interrupted = stop_requested;
    return result;
}

int render(const Scene& scene, const RenderOptions& options, const Method& method) {
    if (options.explain) return explain(scene, options, method);
    Limit until_all_is_written;
    return write_results(scene, options, render_film(scene, options, method));
}
