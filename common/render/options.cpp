#include "common/render/options.h"

#include <algorithm>
#include <filesystem>
#include <thread>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/system.h"
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

void parse_size(const std::string& text, RenderOptions& o) {
    std::vector<int> sides = split_numbers(text, 'x');
    bool fits = sides.size() == 2;
    for (int side : sides) fits = fits && side >= 1 && side <= 65536;
    if (!fits || int64_t{sides[0]} * sides[1] > 1 << 28)
        fail_value("size", text,
                   "WIDTHxHEIGHT, such as 256x256, with sides up to 65536 and at most 2^28 pixels");
    o.width = sides[0], o.height = sides[1];
}

void parse_explain(const std::string& text, RenderOptions& o) {
    std::vector<int> place = split_numbers(text, ',');
    if (place.size() != 2 && place.size() != 3) fail_value("explain", text, "X,Y or X,Y,SAMPLE");
    place.push_back(0);
    o.explain = {0, place[1], place[0], place[2]};
}

void parse_part(const std::string& text, RenderOptions& o) {
    std::vector<int> numbers = split_numbers(text, '/');
    if (numbers.size() != 2 || numbers[0] < 1 || numbers[0] > numbers[1])
        fail_value("part", text, "K/N, such as 1/8, with K from 1 to N");
    o.part = numbers[0], o.parts = numbers[1];
}

/// Throws UsageError for values that are wrong, and for options that cannot be combined.
void check(const RenderOptions& o) {
    ClassFilter{o.paths};
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

}  // namespace

std::string parse_picture(const std::string& option, const std::string& text, bool or_table) {
    if (or_table && has_ending(text, ".tsv")) return text;
    if (!is_image_path(text))
        fail_value(option, text,
                   or_table ? "a .ppm, .pfm, .png or .tsv file" : "a .ppm, .pfm or .png file");
    return text;
}

RenderOptions parse_render_options(int argc, char** argv, const std::string& name,
                                   const std::pair<std::string, int>& scene,
                                   std::vector<Option> extra,
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
         [&](const std::string& text) { o.out.push_back(parse_picture("out", text)); }},
        text_option("stats", "FILE.json", "write time, rays, mean and standard error", o.stats),
        {"explain", "X,Y[,SAMPLE]", "print one path step by step, and draw it",
         [&](const std::string& text) { parse_explain(text, o); }},
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
    std::erase_if(options, [&](const Option& option) {
        return !takes.empty() && std::find(takes.begin(), takes.end(), option.name) == takes.end();
    });
    options.insert(options.begin(), extra.begin(), extra.end());
    options = parse_options(
        argc, argv, "[SCENE]",
        "Chapter " + name + " on a pbrt-v4 scene (default: the project's " + scene.first +
            ").\nWrites into the folder where it is started. Ctrl-C keeps the picture so far: exit "
            "code 3.",
        options, [&](const std::string& word) {
            if (word.empty()) throw UsageError("error: the name of the scene is empty");
            if (!o.scene.empty()) {
                throw UsageError("error: two scenes: '" + o.scene + "' and '" + word + "'");
            }
            o.scene = word;
        });
    // A chapter's own options that change what is rendered have a default.
    for (size_t i = 0; i < extra.size(); i++)
        if (!options[i].value.empty()) o.own.push_back({options[i].name, options[i].value});
    if (o.scene.empty()) {
        o.scene = project_file(argv[0], scene.first);
        if (o.spp == 0) o.spp = scene.second;
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
         [&](const std::string& text) { o.out.push_back(parse_picture("out", text, true)); }},
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
