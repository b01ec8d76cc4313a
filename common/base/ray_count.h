// Counts the rays that are traced, and ends paths that are longer than there is time.
#pragma once
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <vector>

/// Thrown from a ray of a path for which there is no time left; what it has found is lost.
struct TracingEnds : std::exception {
    const char* what() const noexcept override { return "tracing was stopped"; }
};

/// While it lives, rays of all threads throw TracingEnds when `ends()`. Any thread may ask that,
/// now and then. Of several, the last one counts.
class TracingLimit {
public:
    explicit TracingLimit(const std::function<bool()>& ends) : ends_(ends) {
        std::lock_guard lock(mutex);
        limits.push_back(this);
    }
    ~TracingLimit() {
        std::lock_guard lock(mutex);
        std::erase(limits, this);
    }
    TracingLimit(const TracingLimit&) = delete;
    TracingLimit& operator=(const TracingLimit&) = delete;

    static bool is_reached() {
        std::lock_guard lock(mutex);
        return !limits.empty() && limits.back()->ends_();
    }

private:
    // Those that live. Renders on several threads begin and end in any order.
    static inline std::mutex mutex;
    static inline std::vector<const TracingLimit*> limits;
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
        if (TracingLimit::is_reached()) throw TracingEnds();
    }

    uint64_t counted_ = between_looks, left_ = between_looks;
};

/// Rays traced by this thread, for rays per second.
inline constinit thread_local RayCount rays_traced;
