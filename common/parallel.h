// Work shared out among threads.
#pragma once
#include <atomic>
#include <thread>
#include <vector>

/// Calls work(i) for i = 0 .. count-1 on `threads` threads, each taking the next i when it is free.
template <typename Work>
void parallel_for(int count, int threads, const Work& work) {
    std::atomic<int> next = 0;
    auto run = [&] {
        for (int i; (i = next++) < count;) work(i);
    };
    std::vector<std::jthread> others;
    for (int t = 1; t < std::min(threads, count); t++) others.emplace_back(run);
    run();
}
