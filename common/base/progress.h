// What a program tells while it works: how far it is, and what is wrong.
#pragma once
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <string>

#include "common/base/text.h"

/// Prints the text on stderr.
inline void tell(const std::string& text) { std::fputs(text.c_str(), stderr); }

/// Shows the progress of long work on stderr: on a terminal in one line, which disappears at the
/// end; in a file as a new line now and then. The work never waits for it.
class Progress {
public:
    /// pause   s, between lines in a file; what takes less shows none
    explicit Progress(double pause) : pause_(is_terminal_ ? std::min(pause, 0.1) : pause) {}
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// "WHAT ... 12 %": a `share` of the work, from 0 to 1; with the time that is left, where it is
    /// known that the share took `seconds`. Any thread may call it.
    void show(const std::string& what, double share, double seconds = NAN) {
        std::unique_lock lock(mutex_, std::try_to_lock);  // or another thread is showing it
        if (!lock || Clock::now() - last_ < pause_) return;
        last_ = Clock::now();
        share = std::clamp(share, 0.0, 1.0);
        std::string text = printable(what) + format(" ... %2.0f %%", 100 * share);
        if (!std::isnan(seconds)) text += format(", %.0f s left", seconds / share - seconds);
        tell(is_terminal_ ? "\r" + text + "\033[K" : text + "\n");
        is_shown_ = is_terminal_;
    }
    /// Clears the line on the terminal, so that other lines can be printed.
    void clear() {
        std::lock_guard lock(mutex_);
        if (is_shown_) tell("\r\033[K");
        is_shown_ = false;
    }

private:
    using Clock = std::chrono::steady_clock;

    const bool is_terminal_ = isatty(STDERR_FILENO);
    const std::chrono::duration<double> pause_;  // between lines, or between drawings of the one
    std::mutex mutex_;
    bool is_shown_ = false;
    Clock::time_point last_ = Clock::now();
};
