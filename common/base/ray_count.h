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

/// A number of rays, which each of them makes larger by 1; every 128th looks at the limit.
class RayCount {
public:
    void operator++(int) {
        if (++rays_ % 128 == 0) [[unlikely]]
            look();
    }
    void add(uint64_t rays) { rays_ += rays; }
    operator uint64_t() const { return rays_; }

private:
    [[gnu::noinline]] static void look() {
        if (TracingLimit::current && (*TracingLimit::current)()) throw TracingEnds();
    }

    uint64_t rays_ = 0;
};

/// Rays traced by this thread, for rays per second.
inline constinit thread_local RayCount rays_traced;
