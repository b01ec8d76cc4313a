// When the film of a render is written.
#pragma once
#include <chrono>

#include "common/program/render.h"

/// Says when the film is to be written next, and writes it.
class FilmClock {
public:
    FilmClock(const Scene& scene, const RenderOptions& options)
        : scene_(scene), options_(options), interval_(options.film_every) {}

    /// Any thread may ask.
    bool due() const { return !options_.film.empty() && Clock::now() - last_ >= interval_; }
    /// While nobody adds to the film. A film that cannot be written now is reported, and tried
    /// again next time: the render goes on.
    void save(const Rendering& rendering);

private:
    using Clock = std::chrono::steady_clock;
    using Seconds = std::chrono::duration<double>;

    const Scene& scene_;
    const RenderOptions& options_;
    Seconds interval_;
    Clock::time_point last_ = Clock::now();
};
