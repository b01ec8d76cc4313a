// Of the programs that try a student's file: how make grade knows that they came to their end.
#pragma once
#include <unistd.h>

#include <cstdlib>

/// Returns `result`; if it is 0 and the program runs for make grade, passes on the number that
/// waits in a pipe. An exit code alone can be that of std::exit in the student's code.
inline int seal(int result) {
    char number[16];
    if (result != 0 || std::getenv("SEALED") == nullptr) return result;
    bool passed = ::read(10, number, sizeof number) == static_cast<int>(sizeof number) &&
                  ::write(11, number, sizeof number) == static_cast<int>(sizeof number);
    return passed ? 0 : 1;
}
