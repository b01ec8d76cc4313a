#include "common/render/options.h"

#include <algorithm>
#include <filesystem>
#include <thread>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/position.h"
#include "common/base/system.h"
#include "common/picture/film_file.h"
#include "common/recording/class_filter.h"

namespace {

/// The path of the project's file `name`, from the working directory: it is searched in the folder
/// of the program and in the folders above. If it is not found: `name` itself.
std::string project_file(const std::string& program, const std::string& name) {
    namespace fs = std::filesystem;
    std::error_code none;
    fs::path folder = own_file(program);
    while (folder != folder.parent_path()) {
        folder = folder.parent_path();
        if (!fs::exists(folder / file_path(name), none)) continue;
        return file_name((folder / file_path(name)).lexically_proximate(fs::current_path(none)));
    }
    return name;
}

void add_output(std::vector<std::string>& out, const std::string& path, bool table) {
    bool tsv = table && has_ending(path, ".tsv");
    if (!tsv && !is_image_path(path)) {
        fail_value("out", path,
                   table ? "a .ppm, .pfm, .png or .tsv file" : "a .ppm, .pfm or .png file");
    }
    out.push_back(path);
}

void parse_size(const std::string& text, RenderOptions& options) {
    std::vector<int> sides = split_numbers(text, 'x');
    if (sides.size() != 2) fail_value("size", text, "WIDTHxHEIGHT, such as 256x256");
    for (int side : sides)
        if (side < 1 || side > 65536) fail_value("size", text, "sides of 1 to 65536 pixels");
    options.width = sides[0], options.height = sides[1];
    if (int64_t{options.width} * options.height > 1 << 28) {
        fail_value("size", text, "at most 2^28 pixels");
    }
}

void parse_explain(const std::string& text, RenderOptions& options) {
    std::vector<int> place = split_numbers(text, ',');
    if (place.size() != 2 && place.size() != 3) fail_value("explain", text, "X,Y or X,Y,SAMPLE");
    options.explain = true;
    options.explain_x = place[0];
    options.explain_y = place[1];
    options.explain_sample = place.size() == 2 ? -1 : place[2];
}

void parse_part(const std::string& text, RenderOptions& options) {
    std::vector<int> numbers = split_numbers(text, '/');
    if (numbers.size() == 2) {
        options.part = numbers[0], options.parts = numbers[1];
        if (options.part >= 1 && options.part <= options.parts) return;
    }
    fail_value("part", text, "K/N, such as 1/8, with K from 1 to N");
}

/// Throws UsageError for values that are wrong, and for options that cannot be combined.
void check(const RenderOptions& o) {
    if (!o.paths.empty() && !ClassFilter(o.paths).matches_some_path()) {
        throw UsageError("error: --paths " + quote(o.paths) +
                         ": no path is of such a class; they are L, then any of D and S, then E");
    }
    // At shorter intervals nothing would be rendered between two writings.
    if (o.film_every < 0.01) throw UsageError("error: --film-every takes at least 0.01 seconds");
    if (o.film.empty()) {
        if (o.parts == 1) return;
        throw UsageError("error: --part needs --film, or its samples could not be merged");
    }
    if (!has_ending(o.film, film_ending)) fail_value("film", o.film, "a .film file");
    if (!o.split.empty())
        throw UsageError("error: --split and --film: a film keeps the whole alone, no classes");
}

/// Remembers the values of a chapter's own options that change what is rendered.
void remember_values(std::vector<Option>& extra, RenderOptions& options) {
    for (Option& option : extra) {
        if (option.value.empty()) continue;
        size_t i = options.own.size();
        options.own.push_back({option.name, option.value});
        option.set = [set = option.set, i, &options](const std::string& text) {
            set(text);
            options.own[i].second = text;
        };
    }
}

/// Makes options that do not apply to the program an error; --help does not list them.
void refuse_all_but(const std::vector<std::string>& takes, const std::string& program,
                    std::vector<Option>& options) {
    for (Option& option : options) {
        if (std::find(takes.begin(), takes.end(), option.name) != takes.end()) continue;
        option.help.clear();
        option.set = [=, name = option.name](const std::string&) {
            throw UsageError("error: option '--" + name + "' means nothing to " + program +
                             "; --help lists those that do");
        };
    }
}

}  // namespace

std::string parse_picture(const std::string& option, const std::string& text) {
    if (!is_image_path(text)) fail_value(option, text, "a .ppm, .pfm or .png file");
    return text;
}

RenderOptions parse_render_options(int argc, char** argv, const std::string& name,
                                   const DefaultScene& scene, std::vector<Option> extra,
                                   const std::vector<std::string>& takes) {
    RenderOptions o;
    o.name = name;
    o.command = command_line(argc, argv);
    std::vector<Option> options = {
        whole_option("spp", "N", "samples per pixel (default: as the scene says)", 1, 1 << 30,
                     o.spp),
        positive_option("time", "SECONDS",
                        "stop when the time is up, with the samples taken so far", o.time),
        {"size", "WxH", "size in pixels", [&](const std::string& text) { parse_size(text, o); }},
        whole_option("seed", "S", "seed of the random numbers", 0, 0xffffffff, o.seed),
        whole_option("threads", "T", "number of threads (default: one for each processor)", 1, 1024,
                     o.threads),
        whole_option("max-depth", "D",
                     "limit of scattering events: 0 lights only, 1 direct light (default: as the "
                     "scene says)",
                     0, 1 << 30, o.max_depth),
        choice_option("sampler", "KIND", "independent (default), stratified or sobol",
                      {"independent", "stratified", "sobol"}, o.sampler),
        {"out", "FILE", ".ppm, .pfm or .png; may be repeated (default out/" + name + ".ppm)",
         [&](const std::string& text) { add_output(o.out, text, false); }},
        text_option("stats", "FILE.json", "write time, rays, mean and standard error", o.stats),
        {"explain", "X,Y[,SAMPLE]", "print one path step by step, and draw it",
         [&](const std::string& text) { parse_explain(text, o); }},
        flag_option("explain-brightest",
                    "find the sample that is the worst firefly, and explain it",
                    o.explain_brightest),
        text_option("paths", "REGEX", "keep only these classes of path, such as 'LD(S|D)*E'",
                    o.paths),
        text_option("split", "DIR",
                    "write one picture for each class of path, and all as one sheet", o.split),
        text_option("film", "FILE.film",
                    "save the samples' sums, to continue later, even after kill -9", o.film),
        positive_option("film-every", "SECONDS", "how often the film is written (default 60)",
                        o.film_every),
        {"part", "K/N", "take the K-th of N parts of the samples; build/merge adds their films",
         [&](const std::string& text) { parse_part(text, o); }},
        flag_option("stand-in", "render what is not modelled as something like it, and say so",
                    o.stand_in),
        flag_option("quiet", "print errors only", o.quiet),
    };
    if (!takes.empty()) refuse_all_but(takes, name, options);
    remember_values(extra, o);
    options.insert(options.begin(), extra.begin(), extra.end());
    parse_options(
        argc, argv, "[SCENE]",
        "Chapter " + name + " on a pbrt-v4 scene (default: the project's " + scene.file +
            ").\nWrites into the folder where it is started. Ctrl-C keeps the picture so far: exit "
            "code 3.",
        options, [&](const std::string& word) {
            if (word.empty()) throw UsageError("error: the name of the scene is empty");
            if (!o.scene.empty()) {
                throw UsageError("error: two scenes: '" + o.scene + "' and '" + word + "'");
            }
            o.scene = word;
        });
    if (o.scene.empty()) {
        o.scene = project_file(argv[0], scene.file);
        if (o.spp == 0) o.spp = scene.spp;
    }
    check(o);
    if (o.out.empty()) o.out = {"out/" + name + ".ppm"};
    if (o.threads == 0)
        o.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return o;
}

TableOptions parse_table_options(int argc, char** argv, const std::string& name, uint64_t n) {
    TableOptions o;
    o.name = name;
    o.n = n;
    std::vector<Option> options = {
        whole_option("n", "N", "samples", 1, int64_t{1} << 40, o.n),
        whole_option("seed", "S", "seed of the random numbers", 0, 0xffffffff, o.seed),
        {"out", "FILE", ".ppm, .pfm or .png for the picture, .tsv for the table; may be repeated",
         [&](const std::string& text) { add_output(o.out, text, true); }},
        flag_option("quiet", "print errors only", o.quiet),
    };
    parse_options(argc, argv, "", "Chapter " + name + ": prints a table and draws a picture.",
                  options, [](const std::string& word) {
                      throw UsageError("error: '" + word + "' is not an option; --help lists them");
                  });
    if (o.out.empty()) o.out = {"out/" + name + ".ppm", "out/" + name + ".tsv"};
    check_outputs(o.out);
    o.comment = comment_of(
        {{"chapter", name}, {"n", std::to_string(o.n)}, {"seed", std::to_string(o.seed)}});
    return o;
}
