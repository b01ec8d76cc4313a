// Helper of the tests that run the programs of the chapters.
#pragma once
#include <algorithm>

#include "tests/support/process.h"

using Words = std::vector<std::string>;

inline const std::string spheres = "scenes/cornell-spheres.pbrt";
inline const std::string path_tracer = "07_path_tracing", light_tracer = "20_light_tracing";

inline void append(Words& words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
}
inline Words with_words(const std::string& program, const Words& words) {
    Words all = program_words(program);
    append(all, words);
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
std::vector<std::string> programs(bool render);

/// Waits until the file has its first content, which comes after its lock.
bool comes_to_be(const std::string& path);

/// For programs that trace photons: few, since these take most of the time of a brief render.
inline Words few_photons(const std::string& program) {
    bool photons = program.find("photon") != std::string::npos;
    return photons ? Words{"--photons", "2000"} : Words{};
}
