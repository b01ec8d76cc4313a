// Ctrl-C and its like, for work that keeps what it has done so far.
#pragma once
#include <csignal>

/// While it lives, the first SIGINT (Ctrl-C), SIGTERM or SIGHUP asks for a stop, and the same
/// signal once more ends the program, if it comes half a second later: timeout and others send it
/// twice at once. What the program was started to ignore, as by nohup, it ignores. Of several, one
/// inside the life of the other, the outermost counts.
class StopOnSignal {
public:
    StopOnSignal();
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;

    bool requested() const;
    /// Whether a signal came, and forgets it: it ends one part of the work, and the next begins
    /// anew.
    bool take_request();

private:
    static constexpr int signals_[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction before_[3];
};
