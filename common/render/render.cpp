#include "common/render/render.h"

#include <algorithm>
#include <atomic>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/render/film_keeping.h"
#include "common/render/tile_renderer.h"
#include "common/scene/intersect.h"

namespace {

Film empty_film(const Scene& scene, bool takes_splats) {
    uint64_t pixels = static_cast<uint64_t>(scene.width) * static_cast<uint64_t>(scene.height);
    std::string what =
        "a film of " + std::to_string(scene.width) + "x" + std::to_string(scene.height) + " pixels";
    return needing_memory(what, (takes_splats ? 3 : 1) * pixels * sizeof(PixelSum),
                          [&] { return Film(scene.width, scene.height, takes_splats); });
}

uint32_t fewest_samples(const Film& film) {
    uint32_t fewest = film.pixels()[0].n;
    for (const PixelSum& p : film.pixels()) fewest = std::min(fewest, p.n);
    return fewest;
}

/// Takes samples `wanted.first` to `wanted.last` - 1 of each pixel, except those already in the
/// film.
///
/// A pass takes each pixel once, or more often if there are too few pixels to keep all threads
/// busy; but not more often than all passes before it, so that an early end leaves no pixel empty.
void take_samples(const Scene& scene, const RenderOptions& options, const Method& method,
                  const Limit& limit, SampleRange wanted, Rendering& result) {
    const Allocation& allocation = method.allocation;
    bool goes_on = !options.film.empty() && allocation.pilot == 0;
    uint32_t done = goes_on ? fewest_samples(result.film) : 0;
    FilmClock clock(scene, options);
    Progress progress(60);
    TileRenderer renderer{scene, options, method, limit, clock, result, wanted.first};
    uint32_t pixels = static_cast<uint32_t>(scene.width) * static_cast<uint32_t>(scene.height);
    uint32_t most_per_pass = std::max(1u, (1u << 20) / pixels), spp = wanted.last - wanted.first;
    while (done < spp && !limit.reached()) {
        uint32_t next = done + std::min(std::clamp(done, 1u, most_per_pass), spp - done);
        bool in_pilot = wanted.first == 0 && done < allocation.pilot;
        if (in_pilot) next = std::min(next, allocation.pilot);
        uint64_t rays_before = rays_traced, rays_of_preparing = 0;
        if (method.prepare) {
            next = done + 1;
            if (!prepare_pass(method, wanted.first + done, options.threads, limit)) break;
            rays_of_preparing = rays_traced - rays_before;
        }
        result.begun = std::max(result.begun, next);
        renderer.set_goal(wanted.first + next);
        std::atomic<int> tiles = 0;
        parallel_for(renderer.tiles, options.threads, [&](int tile) {
            renderer.render(tile);
            double of_pass = static_cast<double>(++tiles) / renderer.tiles;
            double seconds = limit.elapsed();
            double by_time = options.time > 0 ? seconds / options.time : 0;
            double by_samples = (done + (next - done) * of_pass) / spp;
            if (!options.quiet) progress.show("rendering", std::max(by_time, by_samples), seconds);
        });
        if (clock.due()) {
            clock.save(result);  // then continue the same pass
            continue;
        }
        done = next;
        result.stats.rays += rays_of_preparing;
        bool decides = in_pilot && done == allocation.pilot && !limit.reached();
        if (decides && !renderer.pilot.half[0].empty())
            allocation.choose_densities(renderer.pilot, options.threads);
    }
}

}  // namespace

void mark_lamp_edges(const Scene& scene, int threads, Film& film) {
    CameraView view = camera_view(scene.camera, film.width, film.height);
    size_t width = static_cast<size_t>(film.width), height = static_cast<size_t>(film.height);
    std::vector<float> seen(width * height);
    parallel_for(film.height, threads, [&](int y) {
        for (size_t x = 0; x < width; x++) {
            Vec2 middle = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
            std::optional<Hit> hit = intersect(scene, camera_ray(view, middle));
            Rgb Le = hit ? emission(scene, *hit) : scene.sky;
            seen[static_cast<size_t>(y) * width + x] = average(Le);
        }
    });
    auto compare = [&](size_t a, size_t b) {
        if (std::abs(seen[a] - seen[b]) <= 0.01f * std::max(seen[a], seen[b])) return;
        film.mark_edge(a);
        film.mark_edge(b);
    };
    for (size_t i = 0; i < seen.size(); i++) {
        if (i % width + 1 < width) compare(i, i + 1);
        if (i + width < seen.size()) compare(i, i + width);
    }
}

bool prepare_pass(const Method& method, uint32_t pass, int threads, const Limit& limit) {
    try {
        method.prepare(pass, threads, [&] { return limit.reached(); });
    } catch (const TracingEnds&) {
    }
    return !limit.reached();
}

Rendering render_film(const Scene& scene, const RenderOptions& options, const Method& method) {
    uint32_t pilot = method.allocation.pilot;
    Rendering result{empty_film(scene, method.splats), {}, {}};
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
        take_samples(scene, alone, method, limit, {options.seed, 0, pilot}, again);
    }
    // The samples that there are outlive what goes wrong.
    auto keep = [&](const std::string& error) {
        if (result.film.samples() == 0) throw;
        result.error = error;
    };
    try {
        take_samples(scene, options, method, limit, wanted, result);
    } catch (const InputError& error) {
        keep(error.what());
    } catch (const std::bad_alloc&) {
        keep("error: out of memory");
    }
    for (auto& [path_class, film] : result.classes) film.count_as(result.film);
    result.stats.seconds = limit.elapsed();
    uint64_t all = uint64_t{static_cast<uint32_t>(scene.width)} *
                   static_cast<uint32_t>(scene.height) * (wanted.last - wanted.first);
    result.stats.interrupted =
        (limit.interrupted() || !result.error.empty()) && result.film.samples() < all;
    return result;
}

int render(const Scene& scene, const RenderOptions& options, const Method& method) {
    StopOnSignal until_all_is_written;
    check_outputs(scene, options);
    if (options.explain) return explain(scene, options, method);
    return write_results(scene, options, render_film(scene, options, method));
}
