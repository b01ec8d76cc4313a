// Helper of the tests that run the programs of the chapters.
#pragma once
#include <algorithm>

#include "tests/support/process.h"
#include "tests/support/program.h"

using Words = std::vector<std::string>;

inline const std::string spheres = "scenes/cornell-spheres.pbrt";
inline const std::string path_tracer = "07_path_tracing", light_tracer = "20_light_tracing";

inline Words with_words(const std::string& program, const Words& words) {
    Words all = program_words(program);
    all.insert(all.end(), words.begin(), words.end());
    return all;
}

#ifndef _WIN32
/// Becomes the program.
inline int execute(const std::string& program, const Words& words) {
    return execute_words(with_words(program, words));
}
#endif

inline Process start(const std::string& program, const Words& words) {
    return Process(with_words(program, words));
}

inline Finished run(const std::string& program, const Words& words) {
    return start(program, words).wait();
}

/// The programs of the chapters; those that render a scene, or those that print a table.
inline std::vector<std::string> programs(bool render) {
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

inline void append(Words& words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
}

/// For programs that trace photons: few, since these take most of the time of a brief render.
inline Words few_photons(const std::string& program) {
    if (program.find("photon") == std::string::npos) return {};
    return {"--photons", "2000"};
}

inline bool begins_at_lights(const std::string& program) {
    return program > "20" && program < "23";
}
