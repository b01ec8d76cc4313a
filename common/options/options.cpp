#include "common/options/options.h"

#include <algorithm>
#include <thread>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/position.h"
#include "common/options/project.h"
#include "common/picture/notes.h"
#include "common/recording/class_filter.h"

namespace {

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

void parse_film(const std::string& text, RenderOptions& options) {
    if (!has_ending(text, film_ending)) fail_value("film", text, "a .film file");
    options.film = text;
}

double parse_interval(const std::string& text) {
    double seconds = parse_positive("film-every", text);
    // At shorter intervals nothing would be rendered between two writings.
    if (seconds < 0.01) fail_value("film-every", text, "at least 0.01 seconds");
    return seconds;
}

void parse_part(const std::string& text, RenderOptions& options) {
    std::vector<int> numbers = split_numbers(text, '/');
    if (numbers.size() == 2) {
        options.part = numbers[0], options.parts = numbers[1];
        if (options.part >= 1 && options.part <= options.parts) return;
    }
    fail_value("part", text, "K/N, such as 1/8, with K from 1 to N");
}

/// Throws UsageError for options that cannot be combined.
void check_together(const RenderOptions& o) {
    if (o.film.empty()) {
        if (o.parts > 1) {
            throw UsageError("error: --part needs --film, or its samples could not be merged");
        }
        return;
    }
    const char* split = "error: --split and --film: a film keeps the whole alone, no classes";
    const char* explain = "error: --explain and --film: a film keeps no paths";
    if (!o.split.empty()) throw UsageError(split);
    if (o.explain || o.explain_brightest) throw UsageError(explain);
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

SamplerType parse_sampler(const std::string& text) {
    return static_cast<SamplerType>(
        parse_choice("sampler", text, {"independent", "stratified", "sobol"}));
}

std::string parse_class_filter(const std::string& text) {
    if (!ClassFilter(text).matches_some_path()) {
        throw UsageError("error: --paths " + quote(text) +
                         ": no path is of such a class; they are L, then any of D and S, then E");
    }
    return text;
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
    auto integer = [](const char* option, auto& value, int64_t low, int64_t high) {
        return [=, &value](const std::string& text) {
            value =
                static_cast<std::decay_t<decltype(value)>>(parse_integer(option, text, low, high));
        };
    };
    std::vector<Option> options = {
        {"spp", "N", "samples per pixel (default: as the scene says)",
         integer("spp", o.spp, 1, 1 << 30)},
        {"time", "SECONDS", "stop when the time is up, with the samples taken so far",
         [&](const std::string& text) { o.time = parse_positive("time", text); }},
        {"size", "WxH", "size in pixels", [&](const std::string& text) { parse_size(text, o); }},
        {"seed", "S", "seed of the random numbers (default 0)",
         integer("seed", o.seed, 0, 0xffffffff)},
        {"threads", "T", "number of threads (default: one for each processor)",
         integer("threads", o.threads, 1, 1024)},
        {"max-depth", "D", "limit of scattering events: 0 lights only, 1 direct light",
         integer("max-depth", o.max_depth, 0, 1 << 30)},
        {"sampler", "KIND", "independent (default), stratified or sobol",
         [&](const std::string& text) { o.sampler = parse_sampler(text); }},
        {"out", "FILE", ".ppm, .pfm or .png; may be repeated (default out/" + name + ".ppm)",
         [&](const std::string& text) { add_output(o.out, text, false); }},
        {"stats", "FILE.json", "write time, rays, mean and standard error",
         [&](const std::string& text) { o.stats = text; }},
        {"explain", "X,Y[,SAMPLE]", "print one path step by step, and draw it",
         [&](const std::string& text) { parse_explain(text, o); }},
        {"explain-brightest", "", "find the sample that is the worst firefly, and explain it",
         [&](const std::string&) { o.explain_brightest = true; }},
        {"paths", "REGEX", "keep only these classes of path, such as 'LD(S|D)*E'",
         [&](const std::string& text) { o.paths = parse_class_filter(text); }},
        {"split", "DIR", "write one picture for each class of path, and all as one sheet",
         [&](const std::string& text) { o.split = text; }},
        {"film", "FILE.film", "save the samples' sums, to continue later, even after kill -9",
         [&](const std::string& text) { parse_film(text, o); }},
        {"film-every", "SECONDS", "how often the film is written (default 60)",
         [&](const std::string& text) { o.film_every = parse_interval(text); }},
        {"part", "K/N", "take the K-th of N parts of the samples; build/merge adds their films",
         [&](const std::string& text) { parse_part(text, o); }},
        {"stand-in", "", "render what is not modelled as something like it, and say so",
         [&](const std::string&) { o.stand_in = true; }},
        {"quiet", "", "print errors only", [&](const std::string&) { o.quiet = true; }},
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
    check_together(o);
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
        {"n", "N", "samples (default " + std::to_string(n) + ")",
         [&](const std::string& text) {
             o.n = static_cast<uint64_t>(parse_integer("n", text, 1, int64_t{1} << 40));
         }},
        {"seed", "S", "seed of the random numbers (default 0)",
         [&](const std::string& text) {
             o.seed = static_cast<uint32_t>(parse_integer("seed", text, 0, 0xffffffff));
         }},
        {"out", "FILE", ".ppm, .pfm or .png for the picture, .tsv for the table; may be repeated",
         [&](const std::string& text) { add_output(o.out, text, true); }},
        {"quiet", "", "print errors only", [&](const std::string&) { o.quiet = true; }},
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
