// Helper of the tests that start programs: where they are, and what stands before their names.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/system.h"

/// The folder of the test binary, which main() sets: the programs are there too.
inline std::filesystem::path program_folder;

inline std::string program_file(const std::string& name) {
    return file_name(program_folder / name);
}

/// The words that start a program: first those of $RUN, such as an emulator of its processor.
inline std::vector<std::string> program_words(const std::string& name) {
#ifdef _WIN32
    return {program_file(name + ".exe")};  // an emulator of Windows runs this process, too
#else
    const char* run = std::getenv("RUN");
    std::istringstream text(run != nullptr ? run : "");
    std::vector<std::string> words;
    for (std::string word; text >> word;) words.push_back(word);
    words.push_back(program_file(name));
    return words;
#endif
}
