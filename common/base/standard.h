// What most files of common/ and chapters/ include of the standard library. g++ compiles it once,
// for all of them: see rules.mk. Each file still includes what it uses, as other compilers need it.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#ifdef __AVX2__
#include <immintrin.h>
#endif
