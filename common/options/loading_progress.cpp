#include "common/options/loading_progress.h"

#include <algorithm>

#include "common/base/position.h"

LoadingProgress::LoadingProgress(std::FILE* to, bool is_terminal, double pause)
    : to_(to), is_terminal_(is_terminal), pause_(is_terminal ? std::min(pause, 0.1) : pause) {}

LoadingProgress::~LoadingProgress() { clear(); }

void LoadingProgress::clear() {
    std::lock_guard lock(mutex_);
    if (is_shown_) std::fprintf(to_, "\r\033[K");
    is_shown_ = false;
}

void LoadingProgress::show(const std::string& what, double share) {
    std::lock_guard lock(mutex_);
    Clock::time_point now = Clock::now();
    if (now - last_ < pause_) return;
    last_ = now;
    std::fprintf(to_, is_terminal_ ? "\r%s ... %2.0f %%\033[K" : "%s ... %2.0f %%\n",
                 printable(what).c_str(), 100 * std::clamp(share, 0.0, 1.0));
    std::fflush(to_);
    is_shown_ = is_terminal_;
}
