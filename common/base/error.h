// What is thrown when the user's input is wrong; main() prints what() and exits.
#pragma once
#include <cstdint>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <string>

/// Bad input or a file that cannot be read or written: exit code 1.
/// what() is the whole line, "file:line:column: error: text", or "file: error: text"; or several
/// such lines, where one run finds more that is wrong.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A wrong option or option value: exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// "12.3 MB"
inline std::string megabytes(uint64_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g MB", static_cast<double>(bytes) / 1e6);
    return text;
}

/// Does the work; where there is too little memory for it, throws an InputError that says what
/// needed how much.
template <typename Work>
decltype(auto) needing_memory(const std::string& what, uint64_t bytes, const Work& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        throw InputError("error: out of memory: " + what + " needs " + megabytes(bytes));
    }
}
