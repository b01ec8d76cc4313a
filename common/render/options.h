// Command lines and the error handling that all programs share; the options of the chapters, and
// the tables that they print.
#pragma once
#include <cmath>
#include <cstdint>
#include <ctime>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/text.h"
#include "common/path/sampler.h"
#include "common/picture/film.h"
#include "common/picture/image.h"

/// One option, `--name ARGUMENT` (or `--name` if `argument` is empty). `set` receives the
/// argument's text, and throws UsageError if it is invalid. value: the default. --help adds it to a
/// help line that names none; and films record it for the options that a chapter adds.
struct Option {
    std::string name, argument, help;
    std::function<void(const std::string&)> set;
    std::string value = {};
};

/// Parses the command line. Words that belong to no option go to `set_positional`. For --help it
/// prints the usage and exits. Throws UsageError for an unknown option, and suggests the most
/// similar one. Returns the options; those with a default have the value that was given.
std::vector<Option> parse_options(int argc, char** argv, const std::string& positional,
                                  const std::string& about, std::vector<Option> options,
                                  const std::function<void(const std::string&)>& set_positional);

/// Throws the UsageError "--option takes WANTED, not 'text'".
[[noreturn]] void fail_value(const std::string& option, const std::string& text,
                             const std::string& wanted);

/// The whole numbers in a text such as "256x256"; none if it has another form.
std::vector<int> split_numbers(const std::string& text, char separator);

/// A variable that holds a whole number: a number, a truth or an enumerator.
struct WholeNumber {
    int64_t now;
    std::function<void(int64_t)> set;
    template <class Variable>
    WholeNumber(Variable& variable)
        : now(static_cast<int64_t>(variable)),
          set([&variable](int64_t value) { variable = static_cast<Variable>(value); }) {}
};
/// An option that sets a whole number within [low, high]. Its default is what it is now.
Option whole_option(const char* name, const char* argument, const char* help, double low,
                    double high, const WholeNumber& number);
/// An option that chooses one of the words; `choice` is its number, from 0.
Option choice_option(const char* name, const char* argument, const char* help,
                     const std::vector<const char*>& words, const WholeNumber& choice);
/// An option that sets a number greater than 0 (or_zero: or 0, its default).
inline Option positive_option(const char* name, const char* argument, const std::string& help,
                              double& number, bool or_zero = false) {
    auto set = [=, &number](const std::string& text) {
        double value = to_number(text).value_or(NAN);
        bool fits = (value > 0 && std::isfinite(value)) || (or_zero && value == 0);
        if (!fits) fail_value(name, text, "a number greater than 0");
        number = value;
    };
    return {name, argument, help, set, or_zero ? "0" : ""};
}
/// An option that sets a text, and one without argument.
inline Option text_option(const char* name, const char* argument, const char* help,
                          std::string& text) {
    return {name, argument, help, [&](const std::string& given) { text = given; }};
}
inline Option flag_option(const char* name, const char* help, bool& flag) {
    return {name, "", help, [&](const std::string&) { flag = true; }};
}

/// The command, quoted for the shell: words with special characters are in single quotes.
std::string command_line(int argc, char** argv);

/// Runs a program and returns its exit code: 1 after an InputError or if output to stdout failed, 2
/// after a UsageError. Prints errors to stderr.
int run_program(const std::function<int()>& program);

/// Flushes stdout; throws InputError if writing failed, for example on a full disk.
void flush_stdout();

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

/// The file name of a picture, or UsageError.
std::string parse_picture(const std::string& option, const std::string& text);

/// The options of the chapters without a scene (01 to 04).
struct TableOptions {
    std::string comment;  // for the picture; see picture/film.h
    uint64_t n = 0;
    uint32_t seed = 0;
    std::vector<std::string> out;
    bool quiet = false;
};

/// The options of a chapter that prints a table; n is its default number of samples. Throws
/// InputError when an output cannot be written.
TableOptions parse_table_options(int argc, char** argv, const std::string& name, uint64_t n);

/// Results.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

/// One line per row, the columns aligned to the right (the first to the left).
std::string aligned(const Table& table);

/// The slope of the straight line fitted to (log x, log y) by least squares: -1/2 if four times the
/// samples halve the error. NaN for fewer than two points.
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y);

/// Prints the table and the notes below it (nothing with --quiet), and writes the picture to every
/// --out FILE. Throws InputError.
void write_results(const TableOptions& options, const Table& table, const std::string& notes,
                   const Image& picture);

/// Seconds of processor time so far: other programs on the machine do not count.
inline double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
