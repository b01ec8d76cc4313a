#include "common/program/film_keeping.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/position.h"

namespace {

/// All that decides what the samples are, but for their seeds and numbers.
std::vector<std::pair<std::string, std::string>> film_options(const Scene& scene,
                                                              const RenderOptions& o) {
    constexpr const char* samplers[] = {"independent", "stratified", "sobol"};
    char scene_bytes[17];
    std::snprintf(scene_bytes, sizeof scene_bytes, "%016llx",
                  static_cast<unsigned long long>(scene.files_checksum));
    bool has_strata = o.sampler == SamplerType::stratified;  // as many as samples
    std::vector<std::pair<std::string, std::string>> options = {
        {"chapter", o.name},
        {"file", printable(std::filesystem::path(scene.file).filename().string())},
        {"scene", scene_bytes},
        {"size", std::to_string(scene.width) + "x" + std::to_string(scene.height)},
        {"max-depth", std::to_string(scene.max_depth)},
        {"sampler", samplers[static_cast<size_t>(o.sampler)]},
        {"spp", has_strata ? std::to_string(scene.spp) : "any"},
        {"paths", o.paths}};
    options.insert(options.end(), o.own.begin(), o.own.end());
    return options;
}

std::string text_of(const SampleRange& r) {
    return "samples " + std::to_string(r.first) + " to " + std::to_string(r.last - 1) +
           " of seed " + std::to_string(r.seed);
}

}  // namespace

SampleRange wanted_samples(const Scene& scene, const RenderOptions& o) {
    if (o.parts > scene.spp) {
        throw UsageError("error: --part: there are " + std::to_string(scene.spp) +
                         " samples, too few for " + std::to_string(o.parts) + " parts");
    }
    bool fits = o.film.empty() || scene.spp <= static_cast<int>(PixelSum::most);
    if (!fits) throw UsageError("error: --film: a film holds at most 2^28 samples of a pixel");
    bool endless = o.time > 0 && o.spp == 0 && o.parts == 1;
    if (endless) return {o.seed, 0, PixelSum::most};
    int spp = o.time > 0 && o.spp > 0 ? o.spp : scene.spp;
    auto first_of = [&](int part) { return static_cast<uint32_t>(int64_t{spp} * part / o.parts); };
    return {o.seed, first_of(o.part - 1), first_of(o.part)};
}

void continue_film(const Scene& scene, const RenderOptions& options, Rendering& rendering) {
    std::error_code none;
    if (options.film.empty() || !std::filesystem::exists(options.film, none)) return;
    LabeledFilm found = read_film(options.film);
    check_options(options.film, found.label, film_options(scene, options));
    if (found.label.samples.empty()) return;  // stopped before it had any
    SampleRange wanted = wanted_samples(scene, options);
    for (const SampleRange& r : found.label.samples) {
        bool goes_on = r.seed == wanted.seed && r.first == wanted.first && r.last <= wanted.last;
        if (goes_on && found.label.samples.size() == 1) continue;
        fail({options.film}, "it holds " + text_of(r) +
                                 (found.label.samples.size() > 1 ? " and others" : "") +
                                 ", which do not begin what is asked for: " + text_of(wanted));
    }
    rendering.film = std::move(found.film);
    for (const SampleRange& r : found.label.samples) rendering.begun = r.last - r.first;
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
    uint32_t most = 0, first = label.samples[0].first;
    for (const PixelSum& p : rendering.film.pixels()) most = std::max(most, p.n);
    if (rendering.film.has_halves() && most > 0) most = rendering.begun;
    label.samples.clear();
    if (most > 0) label.samples = {{options.seed, first, first + most}};
    return label;
}

void save_film(const Scene& scene, const RenderOptions& options, const Rendering& rendering) {
    if (options.film.empty()) return;
    write_film(options.film, label_of(scene, options, rendering), rendering.film);
}
