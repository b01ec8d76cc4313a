#include "common/render/stop.h"

#include <cerrno>
#include <cstdint>

#include "common/base/system.h"

static std::atomic<int64_t> first_times[NSIG];  // ns, of the first signal of each kind; 0: none
static_assert(std::atomic<bool>::is_always_lock_free);  // or a handler must not touch it
static_assert(std::atomic<int64_t>::is_always_lock_free);
static int alive = 0;

void request_stop(int signal) {
    constexpr int64_t second = 1'000'000'000;  // ns
    int before = errno;
    std::chrono::nanoseconds time = std::chrono::steady_clock::now().time_since_epoch();
    int64_t now = time.count(), first = 0;
    bool again = !first_times[signal].compare_exchange_strong(first, now);
    if (again && now - first > second / 2) return end_by_signal(signal);
    Limit::signal_came = true;
    std::signal(signal, request_stop);  // some systems call it once
    errno = before;
}

Limit::Limit(double seconds) : seconds_(seconds) {
    if (alive++ > 0) return;
    signal_came = false;
    for (int signal : stop_signals) first_times[signal] = 0;
    catch_stop_signals(request_stop);
}

Limit::~Limit() {
    if (--alive > 0) return;
    release_stop_signals();
}
