// Work shared out among threads; how it is stopped, and how it tells how far it is.
#pragma once
#include <functional>
#include <string>

/// Whether the user wants the program to end: asked by work that takes long.
using Stopped = std::function<bool()>;

/// Is told now and then what is being done, such as "reading knot.ply", and which share of it is
/// done, from 0 to 1. Any thread may call it; an empty one is not called.
using Report = std::function<void(const std::string& what, double share)>;

/// What follows, on at least two threads.
void on_threads(int count, int threads, const std::function<void(int)>& work);

/// Calls work(i) for i = 0 .. count-1 on `threads` threads, each taking the next i when it is free.
/// What work throws stops it all, and is thrown on to the caller. Rays that other threads trace for
/// it are added to the caller's count.
template <typename Work>
void parallel_for(int count, int threads, const Work& work) {
    if (threads > 1) return on_threads(count, threads, work);
    for (int i = 0; i < count; i++) work(i);
}
