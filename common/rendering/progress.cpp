#include "common/rendering/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

Progress::Progress(bool quiet) : on_(!quiet), is_terminal_(isatty(STDERR_FILENO)) {}

Progress::~Progress() {
    if (on_ && is_terminal_) std::fprintf(stderr, "\r\033[K");
}

void Progress::show(double share, double seconds) {
    if (!on_) return;
    std::unique_lock lock(mutex_, std::try_to_lock);  // another thread is showing it
    if (!lock || seconds - last_ < (is_terminal_ ? 0.1 : 60)) return;
    last_ = seconds;
    share = std::min(share, 1.0);
    if (!is_terminal_) {
        std::fprintf(stderr, "%3.0f %%  %.0f s left\n", 100 * share, seconds / share - seconds);
        return;
    }
    constexpr int width = 30;
    std::string bar(static_cast<size_t>(share * width), '#');
    std::fprintf(stderr, "\r[%-*s] %3.0f %%  %.0f s left\033[K", width, bar.c_str(), 100 * share,
                 seconds / share - seconds);
}
