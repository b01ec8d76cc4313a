// What a program tells while it works: how far it is, and what is wrong.
#pragma once
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>

/// Is told now and then what is being done, such as "reading knot.ply", and which share of it is
/// done, from 0 to 1. Any thread may call it; an empty one is not called.
using Report = std::function<void(const std::string& what, double share)>;

/// Prints the text on stderr.
inline void tell(const std::string& text) { std::fputs(text.c_str(), stderr); }

/// Shows the progress of long work on stderr: on a terminal in one line, which disappears at the
/// end; in a file as a new line now and then. The work never waits for it.
class Progress {
public:
    /// pause   s, between lines in a file; what takes less shows none
    explicit Progress(double pause);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// "WHAT ... 12 %": a `share` of the work, from 0 to 1; with the time that is left, where it is
    /// known that the share took `seconds`. Any thread may call it.
    void show(const std::string& what, double share, double seconds = NAN);
    /// Clears the line on the terminal, so that other lines can be printed.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    const bool is_terminal_;
    const std::chrono::duration<double> pause_;  // between lines, or between drawings of the one
    std::mutex mutex_;
    bool is_shown_ = false;
    Clock::time_point last_ = Clock::now();
};
