// Work shared out among threads.
#pragma once
#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "common/base/ray_count.h"

/// A thread that is waited for at the end of its block: std::jthread, which not all libraries have.
/// Where no thread can be had, this one does the work.
class JoinedThread {
public:
    template <typename Work>
    explicit JoinedThread(const Work& work) {
        try {
            thread_ = std::thread(work);
        } catch (const std::exception&) {
            work();
        }
    }
    JoinedThread(JoinedThread&&) = default;
    ~JoinedThread() {
        if (thread_.joinable()) thread_.join();
    }

private:
    std::thread thread_;
};

/// Whether the user wants the program to end: asked by work that takes long.
using Stopped = std::function<bool()>;

/// Calls work(i) for i = 0 .. count-1 on `threads` threads, each taking the next i when it is free.
/// What work throws stops it all, and is thrown on to the caller. Rays that other threads trace for
/// it are added to the caller's count.
template <typename Work>
void parallel_for(int count, int threads, const Work& work) {
    std::atomic<int> next = 0;
    std::exception_ptr thrown;
    std::mutex mutex;
    std::atomic<uint64_t> rays_of_others = 0;
    auto run = [&] {
        try {
            for (int i; (i = next++) < count;) work(i);
        } catch (...) {
            next = count;
            std::lock_guard lock(mutex);
            thrown = std::current_exception();
        }
    };
    {
        std::vector<JoinedThread> others;  // joined at the end of this block
        for (int t = 1; t < std::min(threads, count); t++)
            others.emplace_back([&] {
                run();
                rays_of_others += rays_traced;
            });
        run();
    }
    rays_traced.add(rays_of_others);
    if (thrown) std::rethrow_exception(thrown);
}
