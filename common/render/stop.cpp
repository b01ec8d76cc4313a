#include "common/render/stop.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>

#include "common/base/system.h"

static std::atomic<bool> stop_requested = false;
static std::atomic<int64_t> first_times[NSIG];  // ns, of the first signal of each kind; 0: none
static_assert(std::atomic<bool>::is_always_lock_free);  // or a handler must not touch it
static_assert(std::atomic<int64_t>::is_always_lock_free);
static int alive = 0;

static void request_stop(int signal) {
    constexpr int64_t second = 1'000'000'000;  // ns
    int before = errno;
    std::chrono::nanoseconds time = std::chrono::steady_clock::now().time_since_epoch();
    int64_t now = time.count(), first = 0;
    bool again = !first_times[signal].compare_exchange_strong(first, now);
    if (again && now - first > second / 2) return end_by_signal(signal);
    stop_requested = true;
    std::signal(signal, request_stop);  // some systems call it once
    errno = before;
}

StopOnSignal::StopOnSignal() {
    if (alive++ > 0) return;
    stop_requested = false;
    for (int signal : stop_signals) first_times[signal] = 0;
    catch_stop_signals(request_stop);
}

StopOnSignal::~StopOnSignal() {
    if (--alive > 0) return;
    release_stop_signals();
}

bool StopOnSignal::requested() const { return stop_requested; }
bool StopOnSignal::take_request() { return stop_requested.exchange(false); }
