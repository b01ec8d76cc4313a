#include "common/base/report.h"

#include <cstdio>
#include <mutex>

#include "common/base/system.h"

static std::mutex mutex;
static std::string waiting;

void tell(const std::string& lines) {
    std::lock_guard lock(mutex);
    waiting += lines;
    waiting.erase(0, write_at_once(waiting));
}

void tell_rest() {
    std::lock_guard lock(mutex);
    std::fputs(waiting.c_str(), stderr);
    waiting.clear();
}

void show(const std::string& text) {
    tell("");
    std::lock_guard lock(mutex);
    if (waiting.empty()) write_at_once(text);
}
