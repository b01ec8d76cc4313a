// What the programs of all chapters understand on their command lines.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/path/sampler.h"
#include "common/program/command_line.h"

/// How a chapter finds light, which decides what it can tell about its error.
enum class LightSearch : uint8_t {
    aims,         // at lights, and also meets by chance those that it cannot aim at
    by_chance,    // never aims
    direct,       // only aims, and follows mirrors and glass; other light it leaves out
    from_lights,  // begins at them, and cannot see what mirrors and glass show the camera
    both_ends,    // begins at them and at the eye, and joins the two
    photons       // begins at them, and counts what arrives near to what the eye sees
};

/// What every chapter that renders a scene understands.
struct RenderOptions {
    std::string name;     // of the chapter, such as "07_path_tracing"
    std::string command;  // as typed
    std::string scene;
    int spp = 0;                // 0: as the scene says
    double time = 0;            // s; 0: no limit
    int width = 0, height = 0;  // 0: as the scene says
    int max_depth = -1;         // -1: as the scene says
    uint32_t seed = 0;
    int threads = 0;  // 0: one for each processor
    SamplerType sampler = SamplerType::independent;
    std::vector<std::string> out;
    std::string stats;  // JSON file; empty: none
    bool explain = false;
    int explain_x = 0, explain_y = 0, explain_sample = -1;  // -1: none was named
    bool explain_brightest = false;
    std::string paths;        // regular expression; empty: all
    std::string strategy;     // chapter 21: the `way` of the contributions that count; empty: all
    bool unweighted = false;  // they count without their MIS weight
    std::string split;        // folder; empty: none
    std::string film;         // keeps the sums; empty: none
    double film_every = 60;   // s, from one writing of the film to the next
    int part = 1, parts = 1;  // which samples: the part-th of so many parts, from 1
    LightSearch search = LightSearch::aims;
    /// The chapter's own options, with their values.
    std::vector<std::pair<std::string, std::string>> own = {};
    bool quiet = false;
    std::string map;  // chapter 19: picture of how many samples each pixel has
};

/// The options of a chapter that renders; `scene` is its default scene, `extra` its own options.
/// `takes` names those of the others that mean something to it (empty: all); the rest it refuses.
RenderOptions parse_render_options(int argc, char** argv, const std::string& name,
                                   const std::string& scene, std::vector<Option> extra = {},
                                   const std::vector<std::string>& takes = {});

/// The name of a picture, or UsageError.
std::string parse_picture(const std::string& option, const std::string& text);

/// What the chapters without a scene (01 to 04) understand.
struct TableOptions {
    std::string name;
    std::string comment;  // for the picture; see picture/notes.h
    uint64_t n = 0;
    uint32_t seed = 0;
    std::vector<std::string> out;  // pictures, and .tsv for the table
    bool quiet = false;
};

/// The options of a chapter that prints a table; n is its default number of samples. Throws
/// InputError when an output cannot be written.
TableOptions parse_table_options(int argc, char** argv, const std::string& name, uint64_t n);
