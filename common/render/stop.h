// Stops work on Ctrl-C and similar signals, so that results so far are kept.
#pragma once
#include <atomic>
#include <chrono>

/// While it exists, the first SIGINT (Ctrl-C), SIGTERM or other signal that would end the program
/// (stop_signals) asks for a stop. The same signal ends the program if it comes again at least half
/// a second later (timeout and others send it twice at once). Signals that the program was started
/// to ignore, as by nohup, stay ignored. If several objects exist, only the first has an effect.
class StopOnSignal {
public:
    StopOnSignal();
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;

    bool requested() const;
    /// Whether a signal came; resets it, so that the signal ends one part of the work but not the
    /// next.
    bool take_request();
};

/// When the render has to end before it has all samples.
class Limit {
public:
    explicit Limit(double seconds) : seconds_(seconds) {}
    bool reached() const { return signal_.requested() || (seconds_ > 0 && elapsed() >= seconds_); }
    bool interrupted() const { return signal_.requested(); }
    /// Whether it was interrupted; resets it, since the next render has its own limit.
    bool take_interruption() { return signal_.take_request(); }
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
    double seconds_;  // 0: no limit
    StopOnSignal signal_;
    mutable std::atomic<double> reached_at_ = 0;  // s, when a thread first noticed it; 0: not yet
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};
