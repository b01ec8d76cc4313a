#include "common/program/stop.h"

#include <atomic>

static std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // or a handler must not touch it

StopOnSignal::StopOnSignal() {
    stop_requested = false;
    struct sigaction stop {};
    stop.sa_handler = [](int) { stop_requested = true; };
    stop.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    for (int i = 0; i < 3; i++) {
        ::sigaction(signals_[i], nullptr, &before_[i]);
        if (before_[i].sa_handler != SIG_IGN) ::sigaction(signals_[i], &stop, nullptr);
    }
}

StopOnSignal::~StopOnSignal() {
    for (int i = 0; i < 3; i++) ::sigaction(signals_[i], &before_[i], nullptr);
}

bool StopOnSignal::requested() const { return stop_requested; }
