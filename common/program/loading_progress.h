// What a program says while it loads a large scene.
#pragma once
#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

/// Shows how far loading is: on a terminal in one line, which is gone at the end; else, as in a log
/// file, by a line now and then. Small scenes are loaded before there is anything to say.
class LoadingProgress {
public:
    /// pause   s, between lines in a file
    LoadingProgress(std::FILE* to, bool is_terminal, double pause);
    ~LoadingProgress();
    LoadingProgress(const LoadingProgress&) = delete;
    LoadingProgress& operator=(const LoadingProgress&) = delete;

    /// A Report (base/report.h).
    void show(const std::string& what, double share);
    /// Takes the line off the terminal, so that other lines can be printed.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    std::FILE* const to_;
    const bool is_terminal_;
    const std::chrono::duration<double> pause_;  // between lines, or between drawings of the one
    std::mutex mutex_;
    bool is_shown_ = false;
    Clock::time_point last_ = Clock::now();
};
