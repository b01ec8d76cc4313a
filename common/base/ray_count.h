// Counts the rays that are traced, and ends paths that are longer than there is time.
#pragma once
#include <cstdint>
#include <exception>
#include <functional>

/// Thrown from a ray of a path for which there is no time left; what it has found is lost.
struct TracingEnds : std::exception {
    const char* what() const noexcept override { return "tracing was stopped"; }
};

/// While it lives, rays of this thread, and of those that parallel_for() starts for it, throw
/// TracingEnds when `ends()`. They ask that now and then.
class TracingLimit {
public:
    explicit TracingLimit(const std::function<bool()>& ends) : ends_(ends) { current = &ends_; }
    ~TracingLimit() { current = nullptr; }
    TracingLimit(const TracingLimit&) = delete;
    TracingLimit& operator=(const TracingLimit&) = delete;

    static inline constinit thread_local const std::function<bool()>* current = nullptr;

private:
    const std::function<bool()> ends_;
};

/// A number of rays, which each of them makes larger by 1. It counts down in between, since that is
/// least work: the limit is looked at when it comes to 0.
class RayCount {
public:
    void operator++(int) {
        if (--left_ == 0) [[unlikely]]
            look();
    }
    void add(uint64_t rays) { counted_ += rays; }
    operator uint64_t() const { return counted_ - left_; }

private:
    static constexpr uint64_t between_looks = 128;
    [[gnu::noinline]] void look() {
        counted_ += between_looks, left_ = between_looks;
        if (TracingLimit::current && (*TracingLimit::current)()) throw TracingEnds();
    }

    uint64_t counted_ = between_looks, left_ = between_looks;
};

/// Rays traced by this thread, for rays per second.
inline constinit thread_local RayCount rays_traced;
