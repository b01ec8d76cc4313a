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

std::string program_file(const std::string& name);

/// The words that start a program: first those of $RUN, such as an emulator of its processor.
std::vector<std::string> program_words(const std::string& name);
