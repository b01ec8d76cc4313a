#include "common/options/loading_progress.h"

#include <algorithm>
#include <cstdio>

#include "common/base/position.h"
#include "common/base/report.h"

LoadingProgress::LoadingProgress(bool is_terminal, double pause)
    : is_terminal_(is_terminal), pause_(is_terminal ? std::min(pause, 0.1) : pause) {}

LoadingProgress::~LoadingProgress() { clear(); }

void LoadingProgress::clear() {
    std::lock_guard lock(mutex_);
    if (is_shown_) tell("\r\033[K");
    is_shown_ = false;
}

void LoadingProgress::show(const std::string& what, double share) {
    std::lock_guard lock(mutex_);
    Clock::time_point now = Clock::now();
    if (now - last_ < pause_) return;
    last_ = now;
    char done[50];
    std::snprintf(done, sizeof done, " ... %2.0f %%", 100 * std::clamp(share, 0.0, 1.0));
    std::string text = printable(what) + done;
    tell(is_terminal_ ? "\r" + text + "\033[K" : text + "\n");
    is_shown_ = is_terminal_;
}
