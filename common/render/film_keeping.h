// The film of a render on disk: saved at intervals, and continued later.
#pragma once
#include <chrono>

#include "common/picture/film_file.h"
#include "common/render/render.h"

/// The samples of a pixel that the options ask for: all, or those of a part. Their number is not
/// limited with --time but without --spp. Throws UsageError if there are more parts than samples.
SampleRange wanted_samples(const Scene& scene, const RenderOptions& options);

/// Continues from the film that the options name, or makes one without samples; it is this
/// program's alone then. Throws InputError if another program writes it, its options differ, or it
/// has other samples than the wanted ones.
void continue_film(const Scene& scene, const RenderOptions& options, Rendering& rendering);

/// The label of a film with all samples; and (below) with the given ones.
FilmLabel label_of(const Scene& scene, const RenderOptions& options);
FilmLabel label_of(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

/// A hash of the files in the chapter's folder and in common/: the same on all machines, and
/// different after any change. Empty if there is no such chapter. tested by  "teeth: the hash of a
/// chapter's code changes with any file of it, and of no other chapter"
std::string code_hash(const std::string& chapter);

/// Writes the film that the options name, if any. Throws InputError.
void save_film(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

/// Writes the film at regular intervals.
class FilmClock {
public:
    FilmClock(const Scene& scene, const RenderOptions& options)
        : scene_(scene), options_(options), interval_(options.film_every) {}

    /// Whether it is time to write the film. Any thread may call it.
    bool due() const { return !options_.film.empty() && Clock::now() - last_ >= interval_; }
    /// Writes the film; no thread may add to it meanwhile. If writing fails, prints a message, and
    /// tries again next time.
    void save(const Rendering& rendering);

private:
    using Clock = std::chrono::steady_clock;
    using Seconds = std::chrono::duration<double>;

    const Scene& scene_;
    const RenderOptions& options_;
    Seconds interval_;
    Clock::time_point last_ = Clock::now();
};
