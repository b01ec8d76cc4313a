// The loop that every chapter's trace() runs in, and what comes out of it.
#pragma once
#include <map>
#include <string>

#include "common/path/trace.h"
#include "common/picture/film.h"
#include "common/program/options.h"
#include "common/scene/prepare.h"
#include "common/scene/scene.h"

/// What happened while a picture was rendered.
struct RenderStats {
    double seconds = 0;  // without loading
    uint64_t rays = 0;
    uint64_t paths_cut = 0;   // ended by the depth limit
    uint64_t not_finite = 0;  // samples that were NaN or infinite, as their pixels are then
    int bad_x = 0, bad_y = 0, bad_sample = 0;  // one of them
    double largest = 0;                        // the largest sample (average of the channels)
    bool interrupted = false;                  // by Ctrl-C
};

struct Rendering {
    Film film;
    RenderStats stats;
    std::map<std::string, Film> classes;  // with --split: one film for each class of path, and one
                                          // for all that are longer than 8 letters
};

/// Reads the scene that the options name, makes it ready to trace, and puts the options' size,
/// samples and depth in place of the scene's own.
Scene load(const RenderOptions& options);

/// Throws InputError when the scene has a point or distant light: a path that only looks for light
/// by chance never finds one.
void refuse_delta_lights(const Scene& scene);

/// Throws InputError when a surface of the scene is a rough conductor, which chapters before 12
/// have not got.
void refuse_glossy(const Scene& scene);

/// Renders in passes over the whole picture, until scene.spp samples a pixel, or options.time, or
/// Ctrl-C. The same pixels for any number of threads.
Rendering render_film(const Scene& scene, const RenderOptions& options, const Trace& trace);

/// All that a chapter's program does with its scene: renders it, or explains one path of it, and
/// writes what the options ask for. Returns the exit code.
int render(const Scene& scene, const RenderOptions& options, const Trace& trace);

/// Throws now what writing the results would throw later; see files.h. Makes the folder of --split.
void check_outputs(const RenderOptions& options);

/// Writes pictures and statistics, and prints a summary; 1 when a sample was not finite.
int write_results(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

/// Prints the path that makes sample options.explain_sample of one pixel, and draws it as an SVG
/// beside the first picture.
int explain(const Scene& scene, const RenderOptions& options, const Trace& trace);
