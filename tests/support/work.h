// What a command that takes minutes says while it works.
#pragma once
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

/// Seconds in words: "40 s", "3 min", "2.5 h".
inline std::string duration(double seconds) {
    char text[40];
    if (seconds < 100) {
        std::snprintf(text, sizeof text, "%.0f s", seconds);
    } else if (seconds < 100 * 60) {
        std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
    } else {
        std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
    }
    return text;
}

/// A piece of work in steps. Says on standard error what it is, which step it is at, and how long
/// the others will take: on a terminal in one line, in a file by a line every 10 s.
class Work {
public:
    /// steps      how many, or the sum of their weights
    /// expected   s, as far as that is known; 0: not
    Work(const std::string& what, double steps, double expected = 0);
    ~Work();
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

    /// The next step begins. weight: its share of the time, beside the others'.
    void next(const std::string& name, double weight = 1);

    /// "[ 25 %] cornell, 15: 30 s so far, about 90 s left", when this share is done.
    static std::string line(const std::string& name, double share, double seconds);

private:
    using Clock = std::chrono::steady_clock;
    const double steps_;
    const bool is_terminal_;
    double begun_ = 0;  // of the steps
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

inline Work::Work(const std::string& what, double steps, double expected)
    : steps_(steps), is_terminal_(isatty(STDERR_FILENO)) {
    std::string time = expected > 0 ? ", about " + duration(expected) : "";
    std::fprintf(stderr, "%s%s\n", what.c_str(), time.c_str());
}

inline Work::~Work() {
    if (is_terminal_) std::fprintf(stderr, "\r\033[K");
}

inline std::string Work::line(const std::string& name, double share, double seconds) {
    char head[40];
    std::snprintf(head, sizeof head, "[%3.0f %%] ", 100 * share);
    std::string text = head + name;
    if (share == 0) return text;
    return text + ": " + duration(seconds) + " so far, about " +
           duration(seconds / share - seconds) + " left";
}

inline void Work::next(const std::string& name, double weight) {
    Clock::time_point now = Clock::now();
    double share = begun_ / steps_;
    begun_ += weight;
    bool due = is_terminal_ || now - last_ >= std::chrono::seconds(10);
    if (!due) return;
    last_ = now;
    double seconds = std::chrono::duration<double>(now - start_).count();
    std::string text = line(name, share, seconds);
    std::fprintf(stderr, is_terminal_ ? "\r%s\033[K" : "%s\n", text.c_str());
}

/// Says on standard error that a file was written.
inline void say_wrote(const std::string& files) {
    std::fprintf(stderr, "%swrote %s\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", files.c_str());
}
