// What the measuring programs share: their options, renders with different seeds, and what the
// spread of those says.
#pragma once
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/render/options.h"
#include "tests/measure/numbers.h"
#include "tests/methods/table.h"

/// What all measuring programs understand; each has its own defaults.
struct MeasureOptions {
    std::vector<std::string> words = {};    // on the command line: scenes, or a chapter
    std::vector<std::string> methods = {};  // names; empty: the program's choice
    int spp = 64, runs = 8;
    int width = 0, height = 0;  // 0: as the scene says
    int max_depth = -1;         // -1: as the scene says
    int threads = 0;            // 0: one for each processor
    SamplerType sampler = SamplerType::independent;
    double seconds = 0;       // s, of the program's choice
    std::string out = "out";  // folder for tables and charts
};

/// The words of "A,B".
std::vector<std::string> split_list(const std::string& text);

/// Reads the command line over `defaults`.
MeasureOptions parse_measure_options(int argc, char** argv, const std::string& positional,
                                     const std::string& about, const MeasureOptions& defaults,
                                     const std::vector<Option>& extra = {});

/// The scene of this path at the size and depth of the options, ready to render.
Scene load_scene_for(const std::string& path, const MeasureOptions& options);

/// One render, for which scene.spp is set; `classes`: with the films of the classes of path.
/// stats.seconds is processor time over threads: what a clock shows on a machine with nothing else
/// to do.
Rendering render_once(const NamedMethod& method, Scene& scene, const MeasureOptions& options,
                      int spp, uint32_t seed, bool classes = false);

/// How many samples per pixel it takes in these seconds of one render, by a short one.
int samples_in(double seconds, const NamedMethod& method, Scene& scene,
               const MeasureOptions& options, bool classes = false);

/// Writes the table to FOLDER/NAME.tsv, and makes the folder.
void write_table(const std::string& folder, const std::string& name, const Table& table);

/// x with three significant digits, without an exponent where that is short.
std::string short_number(double x);

/// One line of a chart: what was measured.
struct Line {
    std::string panel, label, color;
    std::vector<double> x = {}, y = {};
};
/// Writes FOLDER/NAME.tsv, which plot.gp draws as NAME.svg.
void write_lines(const std::string& folder, const std::string& name, const std::string& title,
                 const std::string& x_label, const std::string& y_label,
                 const std::vector<Line>& lines);

/// The table in Markdown, its columns aligned so that it reads as plain text too.
std::string markdown(const Table& table);
std::string tab_separated(const Table& table);

/// The scenes of scenes/, as paths; and those with the ones of tests/pictures/references/.
std::vector<std::string> own_scenes();
std::vector<std::string> all_scenes();

/// "cornell" for scenes/cornell.pbrt, "references/veach-mis" for the scenes of others.
std::string scene_name(const std::string& path);

/// The same as part of a file's name: without a slash.
std::string file_name(std::string scene_name);

/// How a scene's picture was made, and the error that is expected of it.
struct Reference {
    std::string method;
    int spp = 0, max_depth = 0;
    double rmse = 0;
};

inline const std::string reference_folder = "tests/measure/references/";
inline const std::string reference_table = reference_folder + "table.tsv";

/// The table of all references, by file_name(scene_name) of the scene: the picture's name.
std::map<std::string, Reference> read_references();

/// The path of a scene from its path or its scene_name, or UsageError.
std::string find_scene(const std::string& name);

/// A piece of work in steps. Says on standard error what it is, and now and then which step it is
/// at and how long the others will take.
class Work {
public:
    /// steps      how many, or the sum of their weights
    /// expected   s, as far as that is known; 0: not
    Work(const std::string& what, double steps, double expected = 0) : steps_(steps) {
        tell(what + (expected > 0 ? ", about " + short_number(expected) + " s\n" : "\n"));
    }

    /// The next step begins. weight: its share of the time, beside the others'.
    void next(const std::string& name, double weight = 1) {
        std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start_;
        if (begun_ > 0) progress_.show(name, begun_ / steps_, seconds.count());
        begun_ += weight;
    }

private:
    double steps_, begun_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    Progress progress_{10};
};

/// Says on standard error that a file was written.
inline void say_wrote(const std::string& files) { tell("wrote " + files + "\n"); }
