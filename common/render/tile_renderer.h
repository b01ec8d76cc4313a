// Renders the samples of the picture tile by tile, until the render has to end.
#pragma once
#include <array>
#include <mutex>

#include "common/path/camera_sample.h"
#include "common/recording/class_filter.h"
#include "common/render/film_keeping.h"
#include "common/render/render.h"
#include "common/render/stop.h"

/// Renders the samples of the pixels of one tile, or fewer at the limit.
struct TileRenderer {
    static constexpr int side = 16;             // pixels
    static constexpr size_t longest_class = 8;  // letters of a class that has its own film
    static constexpr int between_looks = 64;    // samples without rays, which check the limit

    const Scene& scene;
    const RenderOptions& options;
    const Method& method;
    const Limit& limit;
    const FilmClock& clock;
    Rendering& result;
    const uint32_t first;  // number of a pixel's first sample

    const bool chooses = !options.paths.empty() || !options.strategy.empty();
    const bool splits = !options.split.empty();
    const int halves = method.allocation.pilot > 0 ? 2 : 1;
    const CameraView view = camera_view(scene.camera, scene.width, scene.height);
    const int tiles_x = (scene.width + side - 1) / side;
    const int tiles = tiles_x * ((scene.height + side - 1) / side);
    Pilot pilot = start_pilot();  // what was seen of its samples; empty if they were taken before
    uint32_t end = first;         // the number after the last sample
    std::array<SamplesOf, 2> from = samples_to(first), to = from;  // the same for halves of pixels
    std::mutex mutex = {};
    std::array<std::mutex, 1024> splat_mutexes = {};  // each for some of the pixels

    Pilot start_pilot() const {
        Pilot start{scene.width};
        bool is_first = method.allocation.choose_densities && first == 0;
        for (auto& half : start.half)
            if (is_first && result.film.samples() == 0) half.resize(result.film.pixels().size());
        return start;
    }
    std::array<SamplesOf, 2> samples_to(uint32_t number) const {
        if (halves == 1) return {};
        return {method.allocation.samples(0, number), method.allocation.samples(1, number)};
    }
    /// From here on, render() takes samples up to this number.
    void set_goal(uint32_t number) {
        end = number;
        to = samples_to(number);
    }

    /// Takes the samples of a tile's pixels; none while the film waits to be saved.
    void render(int tile) {
        if (limit.reached() || clock.due()) return;
        Tile now;
        std::exception_ptr thrown;
        try {
            render_pixels(tile, now);
        } catch (const TracingEnds&) {
            // A sample that was given up is not counted: a continued render takes it again.
        } catch (...) {
            thrown = std::current_exception();
        }
        std::lock_guard lock(mutex);
        result.stats.add(now.stats);
        if (method.prepare) result.film.add_to_batch(end - 1, now.of_pass);
        if (thrown) std::rethrow_exception(thrown);
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
                    if (audited) result.film.audit(pixel, again.total);
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
        if (halves == 1) return {first + done, end};
        size_t of = static_cast<size_t>(half);
        return {from[of](pixel) + done, to[of](pixel)};
    }

    [[gnu::always_inline]] void trace(const Place& at, int half, Tracer& t) {
        start_sample(t.sampler, at.pixel, half, at.sample);
        t.recorder.start();
        bool centre = scene.camera.pixel_centre;
        Ray ray = camera_sample(view, at.x, at.y, t.sampler, centre).ray;
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
        // All that may fail comes first, so that no sample is in some of the films only.
        if (!splits) t.parts.clear();
        for (const Contribution& part : t.parts) film_of(part);
        int number = static_cast<int>(at.sample) * halves + at.half;
        double value = static_cast<double>(average(t.total));
        if (!is_finite(t.total)) {
            stats.add_not_finite(options.seed, number, at.y, at.x);
        } else if (value >= stats.largest) {
            stats.add_largest(value, at.x, at.y, number);
        }
        result.film.add(at.pixel, t.L, at.half);
        if (method.splats) {
            result.film.add_total(at.pixel, t.total);
            for (const Splat& splat : t.splats) {
                std::lock_guard lock(splat_mutexes[splat.pixel % splat_mutexes.size()]);
                result.film.splat(splat.pixel, splat.L);
            }
        }
        for (const Contribution& part : t.parts) {
            Film& film = film_of(part);
            std::lock_guard lock(mutex);
            bool own = part.pixel == Contribution::own_pixel;
            if (own) film.add_part(at.pixel, part.L, at.half);
            if (!own) film.splat(part.pixel, part.L);
        }
    }

    /// The film of the contribution's class. All long paths share one: the number of classes
    /// doubles with every letter.
    Film& film_of(const Contribution& part) {
        bool is_long = part.path_class.size() > longest_class;
        std::lock_guard lock(mutex);
        auto [film, is_new] = result.classes.try_emplace(is_long ? "longer" : part.path_class,
                                                         scene.width, scene.height, method.splats);
        if (is_new && result.film.has_halves()) film->second.start_halves();
        return film->second;
    }
};
