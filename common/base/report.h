// What a program tells while it works: how far it is, and what is wrong.
#pragma once
#include <functional>
#include <string>

/// Is told now and then what is being done, such as "reading knot.ply", and which share of it is
/// done, from 0 to 1. Any thread may call it; an empty one is not called.
using Report = std::function<void(const std::string& what, double share)>;

/// Prints the lines on stderr. Work never waits for that: what a stopped terminal or a full pipe
/// does not take at once is printed later, at the latest by tell_rest(), which waits.
void tell(const std::string& lines);
void tell_rest();
/// Prints it on stderr if it can at once and nothing else waits; else it is lost, as what progress
/// shows may be.
void show(const std::string& text);
