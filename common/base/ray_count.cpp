#include "common/base/ray_count.h"

#include <mutex>
#include <vector>

// The limits that live. Renders on several threads begin and end in any order.
static std::mutex mutex;
static std::vector<const TracingLimit*> limits;

TracingLimit::TracingLimit(std::function<bool()> ends) : ends_(std::move(ends)) {
    std::lock_guard lock(mutex);
    limits.push_back(this);
}
TracingLimit::~TracingLimit() {
    std::lock_guard lock(mutex);
    std::erase(limits, this);
}

void RayCount::look() {
    counted_ += between_looks, left_ = between_looks;
    std::lock_guard lock(mutex);
    if (!limits.empty() && limits.back()->ends_()) throw TracingEnds();
}
