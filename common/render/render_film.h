// The render loop that calls a chapter's trace(): tiles, passes, threads, and stopping.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "common/base/files.h"
#include "common/path/allocation.h"
#include "common/path/method.h"
#include "common/picture/film_file.h"
#include "common/render/options.h"
#include "common/render/stop.h"
#include "common/scene/scene.h"

/// Statistics of rendering a picture.
struct RenderStats : SampleCounts {
    double seconds = 0;                            // without loading
    double first_radius = 0;                       // m, of photons; 0: there are none
    uint64_t samples_before = 0, rays_before = 0;  // of the film that it continued
    bool interrupted = false;                      // by a signal, before all samples were taken
    int largest_x = 0, largest_y = 0, largest_sample = 0;  // where the largest sample is

    /// Stores a sample if it is the largest so far; of equal samples, that of the first pixel.
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
                                          // for all classes longer than 8 letters
    uint32_t begun = 0;                   // samples a pixel that passes have begun to take
    std::vector<std::string> warnings = {};  // of the chapter's own
    std::shared_ptr<FileLock> film_lock = {};
    std::string error = {};  // that ended it before all samples were taken
};

/// Renders in passes over the whole picture, until scene.spp samples per pixel, options.time or a
/// signal (stop.h). Time and signals end it at once: then some pixels have more samples than
/// others, or none, if the first pass was not complete. The picture does not depend on the number
/// of threads. Continues from options.film, and saves it at intervals.
///
/// With an allocation of the method, a render that continues, or is not the first part, repeats the
/// pilot, so that samples are distributed as in the whole render.
Rendering render_film(const Scene& scene, const RenderOptions& options, const Method& method);

/// Prepares what the method shares in a pass. Returns whether there is time for the pass.
bool prepare_pass(const Method& method, uint32_t pass, int threads, const Limit& limit);
