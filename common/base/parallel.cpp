#include "common/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <system_error>
#include <vector>

#include "common/base/ray_count.h"

void on_threads(int count, int threads, const std::function<void(int)>& work) {
    std::atomic<int> next = 0;
    auto run = [&] {
        try {
            for (int i; (i = next++) < count;) work(i);
        } catch (...) {
            next = count;
            throw;
        }
    };
    std::vector<std::future<uint64_t>> others;  // each is waited for at the end
    try {
        for (int t = 1; t < std::min(threads, count); t++)
            others.push_back(std::async(std::launch::async, [&, limit = TracingLimit::current] {
                TracingLimit::current = limit;
                run();
                return uint64_t{rays_traced};
            }));
    } catch (const std::system_error&) {  // fewer threads do the work
    }
    run();
    for (auto& other : others) rays_traced.add(other.get());
}
