// Work shared out among threads.
#pragma once
#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <list>
#include <mutex>
#include <system_error>
#include <thread>

#include "common/base/ray_count.h"

/// A thread that is waited for at the end of its block: std::jthread, which not all libraries have.
struct JoinedThread {
    std::thread thread;
    explicit JoinedThread(std::thread started) : thread(std::move(started)) {}
    ~JoinedThread() { thread.join(); }
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
        std::list<JoinedThread> others;  // joined at the end of this block
        try {
            for (int t = 1; t < std::min(threads, count); t++)
                others.emplace_back(std::thread([&] {
                    run();
                    rays_of_others += rays_traced;
                }));
        } catch (const std::system_error&) {  // fewer threads do the work
        }
        run();
    }
    rays_traced.add(rays_of_others);
    if (thrown) std::rethrow_exception(thrown);
}
