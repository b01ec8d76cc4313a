#include "common/base/ray_count.h"

#include <mutex>

// The limits that live, the last one first. Renders on several threads begin and end in any order.
static std::mutex mutex;
static const TracingLimit* last_limit = nullptr;

TracingLimit::TracingLimit(std::function<bool()> ends) : ends_(std::move(ends)) {
    std::lock_guard lock(mutex);
    before_ = last_limit;
    last_limit = this;
}
TracingLimit::~TracingLimit() {
    std::lock_guard lock(mutex);
    if (last_limit == this) last_limit = before_;
    for (const TracingLimit* limit = last_limit; limit != nullptr; limit = limit->before_) {
        if (limit->before_ == this) const_cast<TracingLimit*>(limit)->before_ = before_;
    }
}

void RayCount::look() {
    counted_ += between_looks, left_ = between_looks;
    std::lock_guard lock(mutex);
    if (last_limit != nullptr && last_limit->ends_()) throw TracingEnds();
}
