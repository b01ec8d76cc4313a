#include "common/rendering/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "common/base/report.h"

Progress::Progress(bool quiet) : on_(!quiet), is_terminal_(isatty(STDERR_FILENO)) {}

Progress::~Progress() {
    if (on_ && is_terminal_) tell("\r\033[K");
}

void Progress::show(double share, double seconds) {
    if (!on_) return;
    std::unique_lock lock(mutex_, std::try_to_lock);  // another thread is showing it
    if (!lock || seconds - last_ < (is_terminal_ ? 0.1 : 60)) return;
    last_ = seconds;
    share = std::min(share, 1.0);
    char left[100];
    std::snprintf(left, sizeof left, "%3.0f %%  %.0f s left", 100 * share,
                  seconds / share - seconds);
    if (!is_terminal_) return tell(left + std::string("\n"));
    constexpr size_t width = 30;
    std::string bar(static_cast<size_t>(share * width), '#');
    bar.resize(width, ' ');
    tell("\r[" + bar + "] " + left + "\033[K");
}
