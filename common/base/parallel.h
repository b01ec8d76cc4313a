// Work shared out among threads; how it is stopped, and how it tells how far it is.
#pragma once
#include <algorithm>
#include <atomic>
#include <functional>
#include <future>
#include <string>
#include <system_error>
#include <vector>

#include "common/base/ray_count.h"

/// Whether the user wants the program to end: asked by work that takes long.
using Stopped = std::function<bool()>;

/// Is told now and then what is being done, such as "reading knot.ply", and which share of it is
/// done, from 0 to 1. Any thread may call it; an empty one is not called.
using Report = std::function<void(const std::string& what, double share)>;

/// Calls work(i) for i = 0 .. count-1 on `threads` threads, each taking the next i when it is free.
/// What work throws stops it all, and is thrown on to the caller. Rays that other threads trace for
/// it are added to the caller's count.
template <typename Work>
void parallel_for(int count, int threads, const Work& work) {
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
