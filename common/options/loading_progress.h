// The progress messages while a large scene is loaded.
#pragma once
#include <chrono>
#include <mutex>
#include <string>

/// Shows the progress of loading: on a terminal in one line, which disappears at the end; in a log
/// file as a new line now and then. Small scenes are loaded before the first message.
class LoadingProgress {
public:
    /// pause   s, between lines in a file
    LoadingProgress(bool is_terminal, double pause);
    ~LoadingProgress();
    LoadingProgress(const LoadingProgress&) = delete;
    LoadingProgress& operator=(const LoadingProgress&) = delete;

    /// A Report (base/report.h).
    void show(const std::string& what, double share);
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
