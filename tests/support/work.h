// What a command that takes minutes says while it works.
#pragma once
#include <chrono>
#include <cstdio>
#include <string>

/// A piece of work in steps. Says on standard error what it is, and every 10 s which step it is at
/// and how long the others will take.
class Work {
public:
    /// steps      how many, or the sum of their weights
    /// expected   s, as far as that is known; 0: not
    Work(const std::string& what, double steps, double expected = 0) : steps_(steps) {
        std::fputs(what.c_str(), stderr);
        if (expected > 0) std::fprintf(stderr, ", about %.0f s", expected);
        std::fputs("\n", stderr);
    }

    /// The next step begins. weight: its share of the time, beside the others'.
    void next(const std::string& name, double weight = 1) {
        Clock::time_point now = Clock::now();
        double share = begun_ / steps_;
        begun_ += weight;
        if (share == 0 || now - last_ < std::chrono::seconds(10)) return;
        last_ = now;
        double seconds = std::chrono::duration<double>(now - start_).count();
        std::fprintf(stderr, "[%3.0f %%] %s: %.0f s so far, about %.0f s left\n", 100 * share,
                     name.c_str(), seconds, seconds / share - seconds);
    }

private:
    using Clock = std::chrono::steady_clock;
    double steps_, begun_ = 0;
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

/// Says on standard error that a file was written.
inline void say_wrote(const std::string& files) {
    std::fprintf(stderr, "wrote %s\n", files.c_str());
}
