// When the film of a render is written.
#pragma once
#include <chrono>

#include "common/render/render_film.h"

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
