// Renders the samples of the picture tile by tile, until the render has to end.
#pragma once
#include <array>
#include <mutex>

#include "common/base/error.h"
#include "common/path/camera_sample.h"
#include "common/recording/class_filter.h"
#include "common/render/film_keeping.h"
#include "common/render/render.h"
#include "common/render/stop.h"

/// Renders the samples of the pixels of one tile, or fewer at the limit.
class TileRenderer {
public:
    static constexpr int side = 16;             // pixels
    static constexpr size_t longest_class = 8;  // letters of a class that has its own film
    static constexpr int between_looks =
        64;  // samples without rays; rays check the limit themselves

    TileRenderer(const Scene& scene, const RenderOptions& options, const Method& method,
                 const Limit& limit, const FilmClock& clock, Rendering& result, uint32_t first)
        : scene_(scene),
          options_(options),
          method_(method),
          limit_(limit),
          clock_(clock),
          result_(result),
          first_(first),
          view_(camera_view(scene.camera, scene.width, scene.height)),
          tiles_x_((scene.width + side - 1) / side),
          pilot_{scene.width} {
        bool has_pilot =
            method.allocation.choose_densities && first == 0 && result.film.samples() == 0;
        for (auto& half : pilot_.half)
            if (has_pilot) half.resize(result.film.pixels().size());
        set_goal(first);
        from_ = to_;
    }

    /// What was seen of the samples of the pilot; empty if they were taken before.
    Pilot& pilot() { return pilot_; }

    int tiles() const { return tiles_x_ * ((scene_.height + side - 1) / side); }

    /// From here on, render() takes samples up to `end`, the number of a sample.
    void set_goal(uint32_t end) {
        end_ = end;
        for (size_t half : {0u, 1u})
            if (halves() == 2) to_[half] = method_.allocation.samples(static_cast<int>(half), end);
    }

    /// Takes the samples of a tile's pixels; none while the film waits to be saved.
    void render(int tile) {
        if (limit_.reached() || clock_.due()) return;
        Tile now;
        std::exception_ptr thrown;
        try {
            render_pixels(tile, now);
        } catch (const TracingEnds&) {
            // A sample that was given up is not counted: a continued render takes it again.
        } catch (...) {
            thrown = std::current_exception();
        }
        std::lock_guard lock(mutex_);
        result_.stats.add(now.stats);
        if (method_.prepare) result_.film.add_to_batch(end_ - 1, now.of_pass);
        if (thrown) std::rethrow_exception(thrown);
    }

private:
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
            : sampler(r.options_.sampler, r.options_.seed, static_cast<uint32_t>(r.scene_.spp)),
              recorder(r.chooses_ || r.splits_),
              chosen(r.options_.paths) {}

        Sampler sampler;
        Recorder recorder;
        ClassFilter chosen;
        Rgb L = {}, total = {};  // what the sample adds to its own pixel, and to all
        Splats splats = {};
        std::vector<Contribution> parts = {};  // those selected, if they are of use
    };

    int halves() const { return method_.allocation.pilot > 0 ? 2 : 1; }

    void render_pixels(int tile, Tile& now) {
        int x0 = tile % tiles_x_ * side, y0 = tile / tiles_x_ * side;
        int x1 = std::min(x0 + side, scene_.width), y1 = std::min(y0 + side, scene_.height);
        Tracer own(*this), again(*this);
        uint64_t rays_before = rays_traced;
        bool in_pilot = !pilot_.half[0].empty() && end_ <= method_.allocation.pilot;
        int taken = 0;
        for (int y = y0; y < y1; y++) {
            for (int i = halves() * x0; i < halves() * x1; i++) {
                int x = i / halves(), half = i % halves();
                size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(scene_.width) +
                               static_cast<size_t>(x);
                auto [s, last] = samples(pixel, half);
                PilotPixel* seen = in_pilot ? &pilot_.half[half][pixel] : nullptr;
                uint64_t rays_of_others = rays_traced;
                for (; s < last; s++) {
                    bool over = limit_.seen() || (++taken % between_looks == 0 && limit_.reached());
                    if (over) return;
                    Place at = {x, y, pixel, half, s};
                    // For the audit the same sample again, with numbers of another key.
                    bool audited = result_.film.is_audited(pixel);
                    if (audited) trace(at, 1, again);
                    add_sample(at, own, now.stats);
                    if (audited) result_.film.audit(pixel, again.total);
                    if (method_.prepare) now.of_pass.add(own.total);
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
        uint32_t done = result_.film.half(half)[pixel].n;
        if (halves() == 1) return {first_ + done, end_};
        size_t of = static_cast<size_t>(half);
        return {from_[of](pixel) + done, to_[of](pixel)};
    }

    [[gnu::always_inline]] void trace(const Place& at, int half, Tracer& t) {
        start_sample(t.sampler, at.pixel, half, at.sample);
        t.recorder.start();
        bool centre = scene_.camera.pixel_centre;
        Ray ray = camera_sample(view_, at.x, at.y, t.sampler, centre).ray;
        t.splats.clear();
        t.L = method_.trace(scene_, ray, t.splats, t.sampler, t.recorder);
        if (chooses_ || splits_) choose(t);
        t.total = t.L;
        for (const Splat& splat : t.splats) t.total += splat.L;
    }

    /// Reduces a sample and its splats to the selected contributions.
    void choose(Tracer& t) {
        t.parts = t.recorder.contributions();
        std::erase_if(t.parts, [&](const Contribution& part) {
            bool other = !options_.strategy.empty() && part.way != options_.strategy;
            return other || !t.chosen.matches(part.path_class);
        });
        for (Contribution& part : t.parts)
            if (options_.unweighted) part.L = part.L / part.mis;
        if (!chooses_) return;
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
        if (!splits_) t.parts.clear();
        for (const Contribution& part : t.parts) film_of(part);
        int number = static_cast<int>(at.sample) * halves() + at.half;
        double value = static_cast<double>(average(t.total));
        if (!is_finite(t.total)) {
            stats.add_not_finite(options_.seed, number, at.y, at.x);
        } else if (value >= stats.largest) {
            stats.add_largest(value, at.x, at.y, number);
        }
        result_.film.add(at.pixel, t.L, at.half);
        if (method_.splats) {
            result_.film.add_total(at.pixel, t.total);
            for (const Splat& splat : t.splats) {
                std::lock_guard lock(splat_mutexes_[splat.pixel % splat_mutexes_.size()]);
                result_.film.splat(splat.pixel, splat.L);
            }
        }
        for (const Contribution& part : t.parts) {
            Film& film = film_of(part);
            std::lock_guard lock(mutex_);
            bool own = part.pixel == Contribution::own_pixel;
            if (own) film.add_part(at.pixel, part.L, at.half);
            if (!own) film.splat(part.pixel, part.L);
        }
    }

    /// The film of the contribution's class. All long paths share one: the number of classes
    /// doubles with every letter.
    Film& film_of(const Contribution& part) {
        bool is_long = part.path_class.size() > longest_class;
        std::lock_guard lock(mutex_);
        size_t films = result_.classes.size() + 1;
        uint64_t bytes = (method_.splats ? 3 : 1) * result_.film.pixels().size() * sizeof(PixelSum);
        return needing_memory(
            "--split: " + std::to_string(films) + " classes of paths, a film each,", films * bytes,
            [&]() -> Film& {
                auto [film, is_new] =
                    result_.classes.try_emplace(is_long ? "longer" : part.path_class, scene_.width,
                                                scene_.height, method_.splats);
                if (is_new && result_.film.has_halves()) film->second.start_halves();
                return film->second;
            });
    }

    const Scene& scene_;
    const RenderOptions& options_;
    const Method& method_;
    const bool chooses_ = !options_.paths.empty() || !options_.strategy.empty();
    const bool splits_ = !options_.split.empty();
    const Limit& limit_;
    const FilmClock& clock_;
    Rendering& result_;
    uint32_t first_, end_ = 0;            // numbers of the first sample, and after the last
    std::array<SamplesOf, 2> from_, to_;  // the same for the halves of each pixel
    CameraView view_;
    int tiles_x_;
    Pilot pilot_;
    std::mutex mutex_;
    std::array<std::mutex, 1024> splat_mutexes_;  // each for some of the pixels that splats go to
};
