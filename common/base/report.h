// How far long work is, told to whoever shows it.
#pragma once
#include <functional>
#include <string>

/// Is told now and then what is being done, such as "reading knot.ply", and which share of it is
/// done, from 0 to 1. Any thread may call it; an empty one is not called.
using Report = std::function<void(const std::string& what, double share)>;
