#include "common/program/stop.h"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <ctime>

static std::atomic<bool> stop_requested = false;
static std::atomic<int64_t> first_times[NSIG];  // ns, of the first signal of each kind; 0: none
static_assert(std::atomic<bool>::is_always_lock_free);  // or a handler must not touch it
static_assert(std::atomic<int64_t>::is_always_lock_free);
static int alive = 0;

static void request_stop(int signal) {
    constexpr int64_t second = 1'000'000'000;  // ns
    int before = errno;
    timespec time = {};
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    int64_t now = int64_t{time.tv_sec} * second + time.tv_nsec, first = 0;
    bool again = !first_times[signal].compare_exchange_strong(first, now);
    if (again && now - first > second / 2) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
    stop_requested = true;
    errno = before;
}

StopOnSignal::StopOnSignal() {
    if (alive++ > 0) return;
    stop_requested = false;
    struct sigaction stop {};
    stop.sa_handler = request_stop;
    stop.sa_flags = SA_RESTART;
    for (int i = 0; i < 3; i++) {
        first_times[signals_[i]] = 0;
        ::sigaction(signals_[i], nullptr, &before_[i]);
        if (before_[i].sa_handler != SIG_IGN) ::sigaction(signals_[i], &stop, nullptr);
    }
}

StopOnSignal::~StopOnSignal() {
    if (--alive > 0) return;
    for (int i = 0; i < 3; i++) ::sigaction(signals_[i], &before_[i], nullptr);
}

bool StopOnSignal::requested() const { return stop_requested; }
bool StopOnSignal::take_request() { return stop_requested.exchange(false); }
