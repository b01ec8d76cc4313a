// The command-line options of the chapters' programs.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/path/sampler.h"
#include "common/picture/film.h"
#include "common/render/command_line.h"

/// How a chapter finds light, which decides what it can know about its error.
enum class LightSearch : uint8_t {
    light_sampling,  // samples lights, and hits at random those that it cannot sample
    random_hits,     // never samples lights
    direct,          // samples lights, follows mirrors and glass; leaves out other light
    from_lights,     // starts at lights; misses what the camera sees in mirrors and glass
    both_ends,       // starts at lights and at the eye, and connects the two
    photons,         // starts at lights; uses what arrives near visible points
    merging          // as both_ends, and photons behind mirrors and glass
};

/// The options of every chapter that renders a scene.
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
    std::optional<SampleAt> explain;
    std::string paths;        // regular expression; empty: all
    std::string strategy;     // chapter 21: the `way` of the selected contributions; empty: all
    bool unweighted = false;  // they count without their MIS weight
    std::string split;        // folder; empty: none
    std::string film;         // file for the sums; empty: none
    double film_every = 60;   // s, between two writings of the film
    int part = 1, parts = 1;  // render part number `part` of `parts`, from 1
    LightSearch search = LightSearch::light_sampling;
    /// The chapter's own options, with their values.
    Notes own = {};
    bool stand_in = false;  // for what is not modelled in the scene
    bool quiet = false;
    /// Pictures that the chapter writes of its film besides the rendered one: file, and picture.
    std::vector<std::pair<std::string, std::function<Image(const Film&)>>> pictures = {};
};

/// The options of a chapter that renders. scene: the one that it renders if none is named, and its
/// samples per pixel (0: as it says). extra: its own options. takes: names of the general options
/// that apply to it (empty: all); it refuses the others.
RenderOptions parse_render_options(int argc, char** argv, const std::string& name,
                                   const std::pair<std::string, int>& scene,
                                   std::vector<Option> extra = {},
                                   const std::vector<std::string>& takes = {});

/// The file name of a picture (or of a table), or UsageError.
std::string parse_picture(const std::string& option, const std::string& text,
                          bool or_table = false);

/// The options of the chapters without a scene (01 to 04).
struct TableOptions {
    std::string name;
    std::string comment;  // for the picture; see picture/film.h
    uint64_t n = 0;
    uint32_t seed = 0;
    std::vector<std::string> out;  // pictures, and .tsv for the table
    bool quiet = false;
};

/// The options of a chapter that prints a table; n is its default number of samples. Throws
/// InputError when an output cannot be written.
TableOptions parse_table_options(int argc, char** argv, const std::string& name, uint64_t n);
