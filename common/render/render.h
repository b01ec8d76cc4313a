// How a scene is loaded and rendered, or one path of it explained, and the results written.
#pragma once
#include <atomic>
#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "common/base/files.h"
#include "common/base/system.h"
#include "common/render/program.h"

/// Throws InputError if the scene has a lens, moving shapes, a sky image, dispersive glass or rough
/// conductors, and the chapter's `features` do not support it. stand_ins: what has a stand-in is
/// replaced by it, and told in the scene's origin.
void fit_features(Scene& scene, Features features, bool stand_ins = false);

/// When work has to end before all of it is done: after some seconds, or on a signal.
///
/// While it exists, the first SIGINT (Ctrl-C), SIGTERM or other signal that would end the program
/// (stop_signals) asks for a stop. The same signal ends the program if it comes again at least half
/// a second later (timeout and others send it twice at once). Signals that the program was started
/// to ignore, as by nohup, stay ignored. If several objects exist, a signal stops them all.
class Limit {
public:
    explicit Limit(double seconds = 0) : seconds_(seconds) {  // 0: signals alone
        if (alive++ == 0) catch_stop_signals();
    }
    ~Limit() {
        if (--alive == 0) release_stop_signals();
    }

    bool reached() const { return stop_requested || (seconds_ > 0 && elapsed() >= seconds_); }
    /// Whether overdue() has found the limit reached; at most a few rays late.
    bool seen() const { return reached_at_ != 0; }
    /// Whether it was reached some time ago. Until then, samples that have started are finished:
    /// giving up samples would leave out the long ones, a bias.
    bool overdue() const {
        if (!reached()) return false;
        double now = elapsed();
        if (!seen()) reached_at_ = now;
        return now - reached_at_ > 0.25;
    }
    double elapsed() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    static inline int alive = 0;

    double seconds_;
    mutable std::atomic<double> reached_at_ = 0;  // s, when a thread first noticed it; 0: not yet
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Statistics of rendering a picture.
struct RenderStats : SampleCounts {
    double seconds = 0;                            // without loading
    double first_radius = 0;                       // m, of photons; 0: there are none
    uint64_t samples_before = 0, rays_before = 0;  // of the film that it continued
    bool interrupted = false;                      // by a signal, before all samples were taken
    std::optional<SampleAt> largest_at;            // the largest sample, if this run took it

    /// Stores a sample if it is the largest so far; of equal samples, that of the first pixel.
    void add_largest(double value, SampleAt at) {
        bool first = value > largest || (value == largest && largest_at && at < *largest_at);
        if (first) largest = value, largest_at = at;
    }
    void add(const RenderStats& other) {
        if (other.largest_at) add_largest(other.largest, *other.largest_at);
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
    FileLock film_lock = {};
};

/// Renders in passes over the whole picture, until scene.spp samples per pixel, options.time or a
/// signal. Time and signals end it at once: then some pixels have more samples than others, or
/// none, if the first pass was not complete. The picture does not depend on the number of threads.
/// Continues from options.film, and saves it at intervals.
///
/// With an allocation of the method, a render that continues, or is not the first part, repeats the
/// pilot, so that samples are distributed as in the whole render.
Rendering render_film(const Scene& scene, const RenderOptions& options, const Method& method);

/// Continues from the film that the options name, or makes one without samples; it is this
/// program's alone then. Throws InputError if another program writes it, its options differ, or it
/// has other samples than the wanted ones.
void continue_film(const Scene& scene, const RenderOptions& options, Rendering& rendering);

/// The label of a film with the samples of a rendering, or with all samples.
FilmLabel label_of(const Scene& scene, const RenderOptions& options,
                   const Rendering* rendering = nullptr);

/// A hash of the files in the chapter's folder and in common/: the same on all machines, and
/// different after any change. Empty if there is no such chapter. tested by  "teeth: the hash of a
/// chapter's code changes with any file of it, and of no other chapter"
std::string code_hash(const std::string& chapter);

/// Writes the film that the options name, if any. Throws InputError.
void save_film(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

/// Does so during a render, for which no thread may add to the film; if it fails, prints a message.
/// Returns how many seconds later to save it again; `interval`: what it returned the last time.
double save_meanwhile(const Scene& scene, const RenderOptions& options, const Rendering& rendering,
                      double interval);

/// Marks the film's pixels whose centre emits different light than that of a neighbour. Their error
/// is large, and stratified samples reduce it much more than that of other pixels.
void mark_lamp_edges(const Scene& scene, int threads, Film& film);

/// One line for each reason why the error of the picture may exceed its standard error: most light
/// comes from a few samples, the error is unknown, or this method misses light or rarely finds it.
/// Empty if there is none.
/// tested by  "truth: what a film says of its own error"
/// tested by  "truth: what each search for light leaves out, scene by scene"
std::vector<std::string> warnings_of(const Scene& scene, const RenderOptions& options,
                                     const Rendering& rendering);

/// Only the warnings that follow from the samples. place: where the largest of them is, in words.
std::vector<std::string> warnings_of(const Film& film, const SampleCounts& counts,
                                     const std::string& place = "");

/// The causes that may make a picture of this scene black, one line each, as far as the surfaces in
/// view and the lights tell them; nothing is rendered. Not empty.
/// tested by  "truth: the causes of a black picture, all of them, and no others"
std::vector<std::string> causes_of_black(const Scene& scene, const RenderOptions& options);

/// Writes pictures and statistics, and prints a summary. Returns the exit code: 1 if a sample was
/// not finite, 3 if a signal stopped the render before its end.
int write_results(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

/// "mean 0.150432 +- 0.000102", or with "standard error unknown".
std::string mean_and_error(const Film& film);

/// The file name of the picture that --explain draws.
std::string drawing_path(const RenderOptions& options);

/// Throws early the errors that writing the results would throw later (see files.h), and refuses to
/// overwrite a file that the scene was read from. Makes the folder of --split.
void check_outputs(const Scene& scene, const RenderOptions& options);

/// Prints the path of the sample options.explain and the sum of its contributions,
/// and draws it as an SVG beside the first picture. Returns the exit code.
int explain(const Scene& scene, const RenderOptions& options, const Method& method);
