// Renders the samples of the picture tile by tile, until the render has to end.
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <type_traits>

#include "common/base/error.h"
#include "common/path/camera_sample.h"
#include "common/recording/class_filter.h"
#include "common/rendering/film_clock.h"
#include "common/rendering/render_film.h"
#include "common/rendering/stop.h"

/// Renders the samples of the pixels of one tile, or fewer at the limit.
class TileRenderer {
public:
    static constexpr int side = 16;             // pixels
    static constexpr size_t longest_class = 8;  // letters of a class that has its own film
    static constexpr int between_looks =
        64;  // samples without rays; rays check the limit themselves

    TileRenderer(const Scene& scene, const RenderOptions& options, const Method& method,
                 const Allocation& allocation, const Limit& limit, const FilmClock& clock,
                 Rendering& result, uint32_t first)
        : scene_(scene),
          options_(options),
          method_(method),
          chooses_(chooses(options)),
          splits_(!options.split.empty()),
          allocation_(allocation),
          limit_(limit),
          clock_(clock),
          result_(result),
          first_(first),
          view_(camera_view(scene.camera, scene.width, scene.height)),
          tiles_x_((scene.width + side - 1) / side),
          pilot_{scene.width} {
        for (int half = 0; allocation.pilot > 0 && half < halves(); half++) {
            if (has_pilot()) pilot_.half[half].resize(result.film.pixels().size());
            from_[half] = allocation.samples(half, first);
        }
    }

    /// Returns the statistics of the pilot, and removes them here.
    Pilot take_pilot() { return std::move(pilot_); }

    int tiles() const { return tiles_x_ * ((scene_.height + side - 1) / side); }

    /// From here on, render() takes samples up to `end`, the number of a sample.
    void set_goal(uint32_t end) {
        end_ = end;
        for (int half = 0; allocation_.pilot > 0 && half < halves(); half++)
            to_[half] = allocation_.samples(half, end);
    }

    /// Takes the samples of a tile's pixels; none while the film waits to be saved.
    void render(int tile) {
        if (limit_.reached() || clock_.due()) return;
        Tools own(scene_, options_), audit = own;
        RenderStats stats;
        PixelSum of_pass;
        uint64_t rays_before = rays_traced, rays = rays_before, paths_cut = 0;  // of whole samples
        int taken = 0;
        std::exception_ptr thrown;
        bool in_pilot = has_pilot() && end_ <= allocation_.pilot;
        auto render_pixel = [&](int x, int y) {
            size_t pixel =
                static_cast<size_t>(y) * static_cast<size_t>(scene_.width) + static_cast<size_t>(x);
            bool audited = result_.film.is_audited(pixel);
            for (int half = 0; half < halves(); half++) {
                auto [s, last] = samples(pixel, half);
                PilotPixel* seen = in_pilot ? &pilot_.half[half][pixel] : nullptr;
                uint64_t rays_of_others = rays_traced;
                for (; s < last; s++) {
                    bool over = limit_.seen() || (++taken % between_looks == 0 && limit_.reached());
                    if (over) return false;
                    Place at = {x, y, pixel, half, s};
                    // For the audit the same sample again, with numbers of another key.
                    Rgb again;
                    if (audited) again = trace(at, 1, audit).total;
                    auto [L, total] = add_sample(at, own, stats);
                    if (audited) result_.film.audit(pixel, again);
                    if (method_.prepare) of_pass.add(total);
                    if (seen) seen->add(L);
                    rays = rays_traced, paths_cut = own.recorder.paths_cut();
                }
                if (seen) seen->rays += static_cast<uint32_t>(rays_traced - rays_of_others);
            }
            return true;
        };
        try {
            for_pixels(tile, render_pixel);
        } catch (const TracingEnds&) {
            // A sample that was given up is not counted: a continued render takes it again.
        } catch (...) {
            thrown = std::current_exception();
        }
        stats.rays = rays - rays_before, stats.paths_cut = paths_cut;
        std::lock_guard lock(mutex_);
        result_.stats.add(stats);
        if (method_.prepare) result_.film.add_to_batch(end_ - 1, of_pass);
        if (thrown) std::rethrow_exception(thrown);
    }

private:
    int halves() const { return allocation_.pilot > 0 ? 2 : 1; }
    bool has_pilot() const { return allocation_.choose_densities && first_ == 0; }

    /// The number of the next sample of a pixel's half, and the end: one more than the last to
    /// take.
    std::pair<uint32_t, uint32_t> samples(size_t pixel, int half) const {
        uint32_t done = result_.film.half(half)[pixel].n;
        if (allocation_.pilot == 0) return {first_ + done, end_};
        return {from_[half](pixel) + done, to_[half](pixel)};
    }

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

    struct Place {
        int x, y;
        size_t pixel;
        int half;
        uint32_t sample;  // of the half
    };

    /// The tools that trace samples, reused from one sample to the next.
    struct Tools {
        Tools(const Scene& scene, const RenderOptions& options)
            : sampler(options.sampler, options.seed, static_cast<uint32_t>(scene.spp)),
              recorder(chooses(options) || !options.split.empty()),
              chosen(options.paths) {}

        Sampler sampler;
        Recorder recorder;
        ClassSelection chosen;
        Splats splats = {};
    };

    /// The contribution of a sample to its own pixel, and its total with all splats.
    struct Sample {
        Rgb L, total;
    };
    [[gnu::always_inline]] Sample trace(const Place& at, int half, Tools& with) {
        start_sample(with.sampler, at.pixel, half, at.sample);
        with.recorder.start();
        bool centre = scene_.camera.pixel_centre;
        Ray ray = camera_sample(view_, at.x, at.y, with.sampler, centre).ray;
        with.splats.clear();
        Rgb L = method_.trace(scene_, ray, with.splats, with.sampler, with.recorder);
        if (chooses_) L = choose(with);
        Rgb total = L;
        for (const Splat& splat : with.splats) total += splat.L;
        return {L, total};
    }

    static bool chooses(const RenderOptions& options) {
        return !options.paths.empty() || !options.strategy.empty();
    }

    /// The recorded contributions of the selected classes and strategy.
    std::vector<Contribution> chosen_parts(Tools& with) const {
        std::vector<Contribution> parts = with.recorder.contributions();
        std::erase_if(parts, [&](const Contribution& part) {
            bool other = !options_.strategy.empty() && part.way != options_.strategy;
            return other || !with.chosen.contains(part.path_class);
        });
        for (Contribution& part : parts) {
            if (options_.unweighted) part.L = part.L / part.mis;
        }
        return parts;
    }

    /// Reduces the sample and its splats to the selected contributions.
    Rgb choose(Tools& with) {
        Rgb L;
        with.splats.clear();
        for (const Contribution& part : chosen_parts(with)) {
            if (part.pixel == Contribution::own_pixel) {
                L += part.L;
            } else {
                with.splats.push_back({part.pixel, part.L});
            }
        }
        return L;
    }

    Sample add_sample(const Place& at, Tools& with, RenderStats& stats) {
        auto [L, total] = trace(at, at.half, with);
        // All that may fail comes first, so that no sample is in some of the films only.
        std::vector<Contribution> parts;
        if (splits_) parts = chosen_parts(with);
        for (const Contribution& part : parts) film_of(part);
        int number = static_cast<int>(at.sample) * halves() + at.half;
        double value = static_cast<double>(average(total));
        if (!is_finite(total)) {
            stats.add_not_finite(options_.seed, number, at.y, at.x);
        } else if (value >= stats.largest) {
            stats.add_largest(value, at.x, at.y, number);
        }
        result_.film.add(at.pixel, L, at.half);
        if (method_.splats) {
            result_.film.add_total(at.pixel, total);
            for (const Splat& splat : with.splats) {
                std::lock_guard lock(splat_mutexes_[splat.pixel % splat_mutexes_.size()]);
                result_.film.splat(splat.pixel, splat.L);
            }
        }
        for (const Contribution& part : parts) split(at, part);
        return {L, total};
    }

    void split(const Place& at, const Contribution& part) {
        Film& film = film_of(part);
        std::lock_guard lock(mutex_);
        if (part.pixel == Contribution::own_pixel) {
            film.add_part(at.pixel, part.L, at.half);
        } else {
            film.splat(part.pixel, part.L);
        }
    }

    /// The film of the contribution's class.
    Film& film_of(const Contribution& part) {
        // Keep all long paths together: the number of classes doubles with every letter.
        const std::string name =
            part.path_class.size() > longest_class ? "longer" : part.path_class;
        std::lock_guard lock(mutex_);
        size_t films = result_.classes.size() + 1;
        uint64_t bytes = (method_.splats ? 3 : 1) * result_.film.pixels().size() * sizeof(PixelSum);
        return needing_memory(
            "--split: " + std::to_string(films) + " classes of paths, a film each,", films * bytes,
            [&]() -> Film& {
                auto found = result_.classes.find(name);
                if (found != result_.classes.end()) return found->second;
                Film empty(scene_.width, scene_.height, method_.splats);
                if (result_.film.has_halves()) empty.start_halves();
                return result_.classes.emplace(name, std::move(empty)).first->second;
            });
    }

    const Scene& scene_;
    const RenderOptions& options_;
    const Method& method_;
    const bool chooses_, splits_;
    const Allocation& allocation_;
    const Limit& limit_;
    const FilmClock& clock_;
    Rendering& result_;
    uint32_t first_, end_ = 0;   // numbers of the first sample, and of the one after the last
    SamplesOf from_[2], to_[2];  // the same for the halves of each pixel
    CameraView view_;
    int tiles_x_;
    Pilot pilot_;
    std::mutex mutex_;
    std::array<std::mutex, 1024> splat_mutexes_;  // each for some of the pixels that splats go to
};
