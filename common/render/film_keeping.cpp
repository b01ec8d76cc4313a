#include <cinttypes>
#include <cstdio>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/base/system.h"
#include "common/render/render.h"
#include "common/scene/prepare.h"

namespace {

/// The options that decide the samples, except seeds and sample numbers.
Notes film_options(const Scene& scene, const RenderOptions& o) {
    constexpr const char* samplers[] = {"independent", "stratified", "sobol"};
    char checksum[17];
    std::snprintf(checksum, sizeof checksum, "%016" PRIx64, scene.origin->checksum);
    bool has_strata = o.sampler == SamplerType::stratified;  // as many strata as samples
    Notes options = {{"chapter", o.name},
                     {"code", code_hash(o.name)},
                     {"scene", printable(file_name(file_path(scene.origin->file).filename()))},
                     {"checksum", checksum},
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

}  // namespace

SampleRange wanted_samples(const Scene& scene, const RenderOptions& o) {
    if (o.parts > scene.spp) {
        throw UsageError("error: --part: there are " + std::to_string(scene.spp) +
                         " samples, too few for " + std::to_string(o.parts) + " parts");
    }
    bool is_endless = o.time > 0 && o.spp == 0 && o.parts == 1;  // until the time is up
    if (is_endless) return {o.seed, 0, PixelSum::most};
    int spp = o.time > 0 && o.spp > 0 ? o.spp : scene.spp;
    Goal goal = {static_cast<uint32_t>(spp), static_cast<uint32_t>(o.parts)};
    return {o.seed, goal.first_of(o.part), goal.first_of(o.part + 1), goal};
}

void continue_film(const Scene& scene, const RenderOptions& options, Rendering& rendering) {
    if (options.film.empty()) return;
    rendering.film_lock = std::make_shared<FileLock>(options.film);
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

FilmLabel label_of(const Scene& scene, const RenderOptions& options) {
    return {film_options(scene, options), {wanted_samples(scene, options)}, {}};
}

FilmLabel label_of(const Scene& scene, const RenderOptions& options, const Rendering& rendering) {
    FilmLabel label = label_of(scene, options);
    label.counts = rendering.stats;
    const Film& film = rendering.film;
    uint32_t most = 0;
    for (const PixelSum& p : film.pixels()) most = std::max(most, p.n);
    if (film.has_halves()) most = film.samples() > 0 ? rendering.begun : 0;
    label.samples[0].last = label.samples[0].first + most;
    if (most == 0) label.samples.clear();
    return label;
}

void save_film(const Scene& scene, const RenderOptions& options, const Rendering& rendering) {
    if (options.film.empty()) return;
    write_film(options.film, label_of(scene, options, rendering), rendering.film);
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
