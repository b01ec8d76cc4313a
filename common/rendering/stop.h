// Stops work on Ctrl-C and similar signals, so that results so far are kept.
#pragma once

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
