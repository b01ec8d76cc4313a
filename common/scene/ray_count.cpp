#include "common/scene/ray_count.h"

#include <atomic>

static std::atomic<const TracingLimit*> current_limit = nullptr;

TracingLimit::TracingLimit(std::function<bool()> ends)
    : ends_(std::move(ends)), before_(current_limit.exchange(this)) {}
TracingLimit::~TracingLimit() { current_limit = before_; }

void RayCount::look() {
    counted_ += between_looks, left_ = between_looks;
    const TracingLimit* limit = current_limit;
    if (limit != nullptr && limit->ends_()) throw TracingEnds();
}
