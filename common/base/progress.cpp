#include "common/base/progress.h"

#include <unistd.h>

#include <algorithm>

#include "common/base/text.h"

Progress::Progress(double pause)
    : is_terminal_(isatty(STDERR_FILENO)), pause_(is_terminal_ ? std::min(pause, 0.1) : pause) {}

void Progress::clear() {
    std::lock_guard lock(mutex_);
    if (is_shown_) tell("\r\033[K");
    is_shown_ = false;
}

void Progress::show(const std::string& what, double share, double seconds) {
    std::unique_lock lock(mutex_, std::try_to_lock);  // or another thread is showing it
    if (!lock || Clock::now() - last_ < pause_) return;
    last_ = Clock::now();
    share = std::clamp(share, 0.0, 1.0);
    char numbers[100];
    std::snprintf(numbers, sizeof numbers,
                  std::isnan(seconds) ? " ... %2.0f %%" : " ... %2.0f %%, %.0f s left", 100 * share,
                  seconds / share - seconds);
    std::string text = printable(what) + numbers;
    tell(is_terminal_ ? "\r" + text + "\033[K" : text + "\n");
    is_shown_ = is_terminal_;
}
