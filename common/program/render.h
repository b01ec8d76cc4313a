// The loop that every chapter's trace() runs in: tiles, passes, threads, and when to end.
#pragma once
#include <map>
#include <string>
#include <tuple>

#include "common/path/trace.h"
#include "common/picture/allocation.h"
#include "common/picture/film_file.h"
#include "common/program/loading.h"
#include "common/program/options.h"
#include "common/scene/scene.h"

/// What happened while a picture was rendered.
struct RenderStats : SampleCounts {
    double seconds = 0;                            // without loading
    uint64_t samples_before = 0, rays_before = 0;  // of the film that it went on from
    bool interrupted = false;                      // by a signal, before all samples were taken
    int largest_x = 0, largest_y = 0, largest_sample = 0;  // where the largest sample is

    /// Notes a sample if it is the largest so far; of equal ones, that of the first pixel.
    void add_largest(double value, int x, int y, int sample) {
        if (value < largest || value == 0) return;
        bool first = value > largest ||
                     std::tie(y, x, sample) < std::tie(largest_y, largest_x, largest_sample);
        if (first) largest = value, largest_x = x, largest_y = y, largest_sample = sample;
    }
    void add(const RenderStats& other) {
        add_largest(other.largest, other.largest_x, other.largest_y, other.largest_sample);
        SampleCounts::add(other);
    }
};

struct Rendering {
    Film film;
    RenderStats stats;
    std::map<std::string, Film> classes;  // with --split: one film for each class of path, and one
                                          // for all that are longer than 8 letters
    uint32_t begun = 0;                   // samples a pixel that passes have begun to take
    std::vector<std::string> warnings = {};  // of the chapter's own
    /// What the chapter writes beside pictures and statistics: its name, and what writes it.
    std::vector<std::pair<std::string, std::function<void()>>> files = {};
};

/// Renders in passes over the whole picture, until scene.spp samples a pixel, or options.time, or
/// a signal (stop.h). These two end it at once: then some pixels have more samples than others,
/// none where the first pass did not come. The same pixels for any number of threads. Goes on from
/// options.film, and writes it now and then.
///
/// With an allocation, a render that goes on, or is not the first part, makes the pilot again to
/// share the samples out as the whole does.
Rendering render_film(const Scene& scene, const RenderOptions& options, const Trace& trace,
                      const Allocation& allocation = {});
/// Renders a chapter that also splats into other pixels, and one that prepares something for each
/// pass.
Rendering render_film(const Scene& scene, const RenderOptions& options, const SplatTrace& trace);
Rendering render_film(const Scene& scene, const RenderOptions& options, const PassTrace& trace);

/// All that a chapter's program does with its scene: renders it, or explains one path of it, and
/// writes what the options ask for. Returns the exit code.
int render(const Scene& scene, const RenderOptions& options, const Trace& trace,
           const Allocation& allocation = {});
int render(const Scene& scene, const RenderOptions& options, const SplatTrace& trace);
int render(const Scene& scene, const RenderOptions& options, const PassTrace& trace);
