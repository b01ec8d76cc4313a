#include "tests/support/program.h"

std::string program_file(const std::string& name) { return file_name(program_folder / name); }

std::vector<std::string> program_words(const std::string& name) {
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
