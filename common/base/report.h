// What a program tells while it works: how far it is, and what is wrong.
#pragma once
#include <cstdio>
#include <functional>
#include <string>

/// Is told now and then what is being done, such as "reading knot.ply", and which share of it is
/// done, from 0 to 1. Any thread may call it; an empty one is not called.
using Report = std::function<void(const std::string& what, double share)>;

/// Prints the text on stderr.
inline void tell(const std::string& text) { std::fputs(text.c_str(), stderr); }
