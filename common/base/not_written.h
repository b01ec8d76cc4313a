// What stands in an exercise where a function is left to the reader.
#pragma once
#include <stdexcept>
#include <string>

/// Ends whatever needs this function: make check says that it waits for it.
[[noreturn]] inline void not_written(const std::string& function) {
    throw std::logic_error("`" + function + "` is not written yet");
}
