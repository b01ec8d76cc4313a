// The progress bar.
#pragma once
#include <mutex>

/// Shows how far the work is and how long it will take: on a terminal as a bar, of which no trace
/// is left when it is done; in a file by a line each minute.
class Progress {
public:
    explicit Progress(bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `share` of the work, in 0 to 1, took so many seconds. Any thread may say so.
    void show(double share, double seconds);

private:
    const bool on_, is_terminal_;
    std::mutex mutex_;
    double last_ = 0;  // s, when it was drawn
};
