// Ends work when its time is up, or on Ctrl-C and similar signals, so that results so far are kept.
#pragma once
#include <atomic>
#include <chrono>

#include "common/base/system.h"

/// When work has to end before all of it is done: after some seconds, or on a signal.
///
/// While it exists, the first SIGINT (Ctrl-C), SIGTERM or other signal that would end the program
/// (stop_signals) asks for a stop. The same signal ends the program if it comes again at least half
/// a second later (timeout and others send it twice at once). Signals that the program was started
/// to ignore, as by nohup, stay ignored. If several objects exist, a signal stops them all.
class Limit {
public:
    explicit Limit(double seconds = 0) : seconds_(seconds) {  // 0: signals alone
        if (alive++ == 0) catch_stop_signals();
    }
    ~Limit() {
        if (--alive == 0) release_stop_signals();
    }
    Limit(const Limit&) = delete;
    Limit& operator=(const Limit&) = delete;

    bool reached() const { return interrupted() || (seconds_ > 0 && elapsed() >= seconds_); }
    bool interrupted() const { return stop_requested; }
    /// Whether it was interrupted; resets it, so that the signal ends one part of the work but not
    /// the next.
    bool take_interruption() { return stop_requested.exchange(false); }
    /// Whether overdue() has found the limit reached; at most a few rays late.
    bool seen() const { return reached_at_ != 0; }
    /// Whether it was reached some time ago. Until then, samples that have started are finished:
    /// giving up samples would leave out the long ones, a bias.
    bool overdue() const {
        if (!reached()) return false;
        double now = elapsed();
        if (!seen()) reached_at_ = now;
        return now - reached_at_ > 0.25;
    }
    double elapsed() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    static inline int alive = 0;

    double seconds_;
    mutable std::atomic<double> reached_at_ = 0;  // s, when a thread first noticed it; 0: not yet
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};
