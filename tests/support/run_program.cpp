#include "tests/support/run_program.h"

std::vector<std::string> programs(bool render) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator("chapters")) {
        if (!entry.is_directory()) continue;
        std::string name = file_name(entry.path().filename());
        if (name == "06_bvh") continue;        // draws work instead of light: has tests of its own
        if (name == "26_radiosity") continue;  // renders no mirrors: has its own
        std::string help = run(name, {"--help"}).out;
        if ((help.find("[SCENE]") != std::string::npos) == render) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    REQUIRE(!names.empty());
    return names;
}

bool comes_to_be(const std::string& path) {
    std::error_code none;
    auto has_content = [&] {
        return std::filesystem::file_size(file_path(path), none) > 0 && !none;
    };
    for (int i = 0; i < 20000 && !has_content(); i++) ::usleep(1000);
    return has_content();
}
