// The progress bar.
#pragma once
#include <mutex>

/// Shows the progress of the work and the remaining time: on a terminal as a bar, which disappears
/// at the end; in a file as one line each minute. The work never waits for it.
class Progress {
public:
    explicit Progress(bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `share` of the work, from 0 to 1, took `seconds`. Any thread may call it.
    void show(double share, double seconds);

private:
    const bool on_, is_terminal_;
    std::mutex mutex_;
    double last_ = 0;  // s, when it was drawn
};
