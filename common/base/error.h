// What is thrown when the user's input is wrong; main() prints what() and exits.
#pragma once
#include <stdexcept>

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
