// Ctrl-C and its like, for work that keeps what it has done so far.
#pragma once
#include <csignal>

/// While it lives, the first SIGINT (Ctrl-C), SIGTERM or SIGHUP asks for a stop, and the same
/// signal once more ends the program. What the program was started to ignore, as by nohup, it
/// ignores.
class StopOnSignal {
public:
    StopOnSignal();
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;

    bool requested() const;

private:
    static constexpr int signals_[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction before_[3];
};
