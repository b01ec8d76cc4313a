#include "common/options.h"

#include <getopt.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <thread>

#include "common/error.h"
#include "common/image.h"
#include "common/nearest.h"

namespace {

[[noreturn]] void fail_value(const std::string& option, const std::string& text,
                             const std::string& wanted) {
    throw UsageError("error: --" + option + " takes " + wanted + ", not '" + text + "'");
}

[[noreturn]] void fail_unknown(const std::string& word, const std::vector<Option>& options) {
    std::vector<std::string> names;
    for (const Option& option : options) names.push_back("--" + option.name);
    std::string nearest = nearest_word(word.substr(0, word.find('=')), names);
    throw UsageError(
        "error: unknown option '" + word + "'" +
        (nearest.empty() ? "; --help lists them" : ", did you mean '" + nearest + "'?"));
}

void print_usage(const char* program, const std::string& positional, const std::string& about,
                 const std::vector<Option>& options) {
    std::printf("usage: %s%s%s [OPTION]...\n%s\n\n", program, positional.empty() ? "" : " ",
                positional.c_str(), about.c_str());
    for (const Option& option : options) {
        std::string left =
            "--" + option.name + (option.argument.empty() ? "" : " " + option.argument);
        std::printf("  %-24s %s\n", left.c_str(), option.help.c_str());
    }
}

std::string command_line(int argc, char** argv) {
    std::string line;
    for (int i = 0; i < argc; i++) line += (i ? " " : "") + std::string(argv[i]);
    return line;
}

void add_output(std::vector<std::string>& out, const std::string& path, bool table) {
    bool tsv = table && path.ends_with(".tsv");
    if (!tsv && !is_image_path(path)) {
        fail_value("out", path,
                   table ? "a .ppm, .pfm, .png or .tsv file" : "a .ppm, .pfm or .png file");
    }
    out.push_back(path);
}

}  // namespace

void parse_options(int argc, char** argv, const std::string& positional, const std::string& about,
                   std::vector<Option> options,
                   const std::function<void(const std::string&)>& set_positional) {
    options.push_back({"help", "", "print this and stop", [](const std::string&) {}});
    std::vector<option> table;
    for (size_t i = 0; i < options.size(); i++) {
        table.push_back({options[i].name.c_str(),
                         options[i].argument.empty() ? no_argument : required_argument, nullptr,
                         static_cast<int>(256 + i)});
    }
    table.push_back({nullptr, 0, nullptr, 0});

    opterr = 0;  // messages are ours
    optind = 1;
    for (int code; (code = getopt_long(argc, argv, "-:", table.data(), nullptr)) != -1;) {
        std::string word = argv[std::max(1, optind - 1)];
        if (code == 1) {
            set_positional(optarg);
        } else if (code == ':') {
            throw UsageError("error: option '" + word + "' needs a value");
        } else if (code == '?') {
            if (optopt >= 256) throw UsageError("error: option '" + word + "' takes no value");
            fail_unknown(word, options);
        } else if (const Option& found = options[static_cast<size_t>(code - 256)];
                   found.name == "help") {
            print_usage(argv[0], positional, about, options);
            std::exit(0);
        } else {
            found.set(optarg ? optarg : "");
        }
    }
    for (; optind < argc; optind++) set_positional(argv[optind]);  // after "--"
}

int64_t parse_integer(const std::string& option, const std::string& text, int64_t low,
                      int64_t high) {
    char* end = nullptr;
    errno = 0;
    long long value = std::strtoll(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || errno != 0 || value < low || value > high) {
        fail_value(option, text,
                   "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    }
    return value;
}

double parse_positive(const std::string& option, const std::string& text) {
    char* end = nullptr;
    double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !(value > 0) || !std::isfinite(value)) {
        fail_value(option, text, "a number greater than 0");
    }
    return value;
}

namespace {

void parse_size(const std::string& text, RenderOptions& options) {
    size_t x = text.find('x');
    if (x == std::string::npos) fail_value("size", text, "WIDTHxHEIGHT, such as 256x256");
    options.width = static_cast<int>(parse_integer("size", text.substr(0, x), 1, 65536));
    options.height = static_cast<int>(parse_integer("size", text.substr(x + 1), 1, 65536));
}

void parse_explain(const std::string& text, RenderOptions& options) {
    std::smatch match;
    if (!std::regex_match(text, match, std::regex("(\\d{1,9}),(\\d{1,9})(?:,(\\d{1,9}))?"))) {
        fail_value("explain", text, "X,Y or X,Y,SAMPLE");
    }
    options.explain = true;
    options.explain_x = std::stoi(match[1]);
    options.explain_y = std::stoi(match[2]);
    options.explain_sample = match[3].matched ? std::stoi(match[3]) : 0;
}

SamplerType parse_sampler(const std::string& text) {
    if (text == "independent") return SamplerType::independent;
    if (text == "stratified") return SamplerType::stratified;
    if (text == "sobol") return SamplerType::sobol;
    std::string nearest = nearest_word(text, {"independent", "stratified", "sobol"});
    fail_value("sampler", text,
               "independent, stratified or sobol" +
                   (nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
}

std::string parse_regex(const std::string& text) {
    try {
        std::regex check(text);
    } catch (const std::regex_error&) {
        fail_value("paths", text, "a regular expression, such as 'LD(S|D)*E'");
    }
    return text;
}

}  // namespace

RenderOptions parse_render_options(int argc, char** argv, const std::string& name,
                                   const std::string& scene, std::vector<Option> extra) {
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
        {"time", "SECONDS", "render whole passes until the time is up",
         [&](const std::string& text) { o.time = parse_positive("time", text); }},
        {"size", "WxH", "pixels", [&](const std::string& text) { parse_size(text, o); }},
        {"seed", "S", "of the random numbers (default 0)", integer("seed", o.seed, 0, 0xffffffff)},
        {"threads", "T", "default: one for each processor", integer("threads", o.threads, 1, 1024)},
        {"max-depth", "D", "scattering events: 0 emitters only, 1 direct light",
         integer("max-depth", o.max_depth, 0, 1 << 30)},
        {"sampler", "KIND", "independent (default), stratified or sobol",
         [&](const std::string& text) { o.sampler = parse_sampler(text); }},
        {"out", "FILE", ".ppm, .pfm or .png; may be repeated (default out/" + name + ".ppm)",
         [&](const std::string& text) { add_output(o.out, text, false); }},
        {"stats", "FILE.json", "write time, rays, mean and standard error",
         [&](const std::string& text) { o.stats = text; }},
        {"explain", "X,Y[,SAMPLE]", "print one path step by step, and draw it",
         [&](const std::string& text) { parse_explain(text, o); }},
        {"paths", "REGEX", "keep only these classes of path, such as 'LD(S|D)*E'",
         [&](const std::string& text) { o.paths = parse_regex(text); }},
        {"split", "DIR", "write one picture for each class of path",
         [&](const std::string& text) { o.split = text; }},
        {"quiet", "", "print errors only", [&](const std::string&) { o.quiet = true; }},
    };
    options.insert(options.begin(), extra.begin(), extra.end());
    parse_options(
        argc, argv, "[SCENE]", "Chapter " + name + " on a pbrt-v4 scene (default " + scene + ").",
        options, [&](const std::string& word) {
            if (!o.scene.empty())
                throw UsageError("error: two scenes: '" + o.scene + "' and '" + word + "'");
            o.scene = word;
        });
    if (o.scene.empty()) o.scene = scene;
    if (o.out.empty()) o.out = {"out/" + name + ".ppm"};
    if (o.threads == 0)
        o.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return o;
}

TableOptions parse_table_options(int argc, char** argv, const std::string& name, uint64_t n) {
    TableOptions o;
    o.name = name;
    o.command = command_line(argc, argv);
    o.n = n;
    std::vector<Option> options = {
        {"n", "N", "samples (default " + std::to_string(n) + ")",
         [&](const std::string& text) {
             o.n = static_cast<uint64_t>(parse_integer("n", text, 1, int64_t{1} << 40));
         }},
        {"seed", "S", "of the random numbers (default 0)",
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
    return o;
}

int run_program(const std::function<int()>& program) {
    try {
        return program();
    } catch (const UsageError& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 2;
    } catch (const InputError& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "error: out of memory\n");
        return 1;
    }
}
