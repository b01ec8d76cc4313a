#include "common/render/options.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <thread>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/progress.h"
#include "common/base/system.h"
#include "common/recording/class_filter.h"

[[noreturn]] static void print_usage(const char* program, const std::string& positional,
                                     const std::string& about, const std::vector<Option>& options) {
    std::printf("usage: %s%s%s [OPTION]...\n%s\n\n", program, positional.empty() ? "" : " ",
                positional.c_str(), about.c_str());
    for (const Option& option : options) {
        std::string left = "--" + option.name, right = option.help;
        if (!option.argument.empty()) left += " " + option.argument;
        bool tells_default = option.value.empty() || right.find("default") != std::string::npos;
        if (!tells_default) right += " (default " + option.value + ")";
        std::printf("  %-24s %s\n", left.c_str(), right.c_str());
    }
    flush_stdout();
    std::exit(0);
}

void flush_stdout() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw InputError("stdout: error: cannot write all of the output");
}

std::vector<Option> parse_options(int argc, char** argv, const std::string& positional,
                                  const std::string& about, std::vector<Option> options,
                                  const std::function<void(const std::string&)>& set_positional) {
    options.push_back({"help", "", "print this and stop", [&](const std::string&) {
                           print_usage(argv[0], positional, about, options);
                       }});
    std::vector<std::string> names;
    for (const Option& option : options) names.push_back("--" + option.name);
    for (int i = 1; i < argc; i++) {
        std::string word = argv[i];
        if (!word.starts_with('-')) {
            set_positional(word);
            continue;
        }
        size_t equals = word.find('=');
        std::string name = word.substr(0, equals), value;
        auto known = std::find(names.begin(), names.end(), name);
        if (known == names.end()) throw UsageError("error: " + unknown("option", name, names));
        Option& option = options[static_cast<size_t>(known - names.begin())];

        // Take the value from after the = or from the next word.
        bool takes_value = !option.argument.empty(), has_value = equals != std::string::npos;
        bool follows = i + 1 < argc && !std::string_view(argv[i + 1]).starts_with("--");
        if (has_value) value = word.substr(equals + 1);
        if (takes_value && !has_value && follows) value = argv[++i];
        if (takes_value ? value.empty() : has_value)
            throw UsageError("error: option '" + name +
                             (takes_value ? "' needs a value" : "' takes no value"));
        option.set(value);
        if (!option.value.empty()) option.value = value;
    }
    return options;
}

void fail_value(const std::string& option, const std::string& text, const std::string& wanted) {
    throw UsageError("error: --" + option + " takes " + wanted + ", not '" + text + "'");
}

Option whole_option(const char* name, const char* argument, const char* help, double low,
                    double high, const WholeNumber& number) {
    auto set = [=](const std::string& text) {
        double value = to_number(text).value_or(NAN);
        if (!(value == std::floor(value) && value >= low && value <= high))
            fail_value(name, text, format("a whole number from %.0f to %.0f", low, high));
        number.set(static_cast<int64_t>(value));
    };
    return {name, argument, help, set, std::to_string(number.now)};
}

Option choice_option(const char* name, const char* argument, const char* help,
                     const std::vector<const char*>& choices, const WholeNumber& choice) {
    std::vector<std::string> words(choices.begin(), choices.end());
    auto set = [=](const std::string& text) {
        auto found = std::find(words.begin(), words.end(), text);
        if (found == words.end()) fail_value(name, text, listed(words, " or "));
        choice.set(found - words.begin());
    };
    return {name, argument, help, set, words[static_cast<size_t>(choice.now)]};
}

std::vector<int> split_numbers(const std::string& text, char separator) {
    std::vector<int> numbers;
    std::istringstream parts(text + separator);
    for (std::string part; std::getline(parts, part, separator);) {
        numbers.push_back(to_integer(part).value_or(-1));
        if (numbers.back() < 0) return {};
    }
    return numbers;
}

std::string command_line(int argc, char** argv) {
    constexpr auto plain_letters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    std::string line;
    for (int i = 0; i < argc; i++) {
        std::string word = argv[i], quoted;
        for (char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
        bool plain = !word.empty() && word.find_first_not_of(plain_letters) == std::string::npos;
        line += (i > 0 ? " " : "") + (plain ? word : "'" + quoted + "'");
    }
    return line;
}

int run_program(const std::function<int()>& program) {
    auto fails = [](int code, const std::string& error) {
        std::istringstream lines(error);
        for (std::string line; std::getline(lines, line);) tell(printable(line) + "\n");
        return code;
    };
    try {
        prepare_streams();
        int code = program();
        flush_stdout();
        return code;
    } catch (const UsageError& e) {
        return fails(2, printable(e.what()));  // one line
    } catch (const InputError& e) {
        return fails(1, e.what());
    } catch (const std::bad_alloc&) {
        return fails(1, "error: out of memory");
    } catch (const std::exception& e) {
        return fails(1, "error: " + printable(e.what()));
    }
}

/// The path of the project's file `name`, from the working directory: it is searched in the folder
/// of the program and in the folders above. If it is not found: `name` itself.
static std::string project_file(const std::string& program, const std::string& name) {
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

/// Throws UsageError for values that are wrong, and for options that cannot be combined.
static void check(const RenderOptions& o) {
    ClassFilter{o.paths};
    if (o.film.empty() && o.parts > 1)
        throw UsageError("error: --part needs --film, or its samples could not be merged");
    if (!o.film.empty() && !has_ending(o.film, film_ending))
        fail_value("film", o.film, "a .film file");
    if (!o.film.empty() && !o.split.empty())
        throw UsageError("error: --split and --film: a film keeps the whole alone, no classes");
}

std::string parse_picture(const std::string& option, const std::string& text) {
    if (is_image_path(text)) return text;
    fail_value(option, text, "a .ppm, .pfm or .png file");
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
        {"size", "WxH", "size in pixels",
         [&](const std::string& text) {
             std::vector<int> sides = split_numbers(text, 'x');
             bool fits = sides.size() == 2;
             for (int side : sides) fits = fits && side >= 1 && side <= 65536;
             if (!fits || int64_t{sides[0]} * sides[1] > 1 << 28)
                 fail_value("size", text,
                            "WIDTHxHEIGHT, such as 256x256, with sides up to 65536 and at most "
                            "2^28 pixels");
             o.width = sides[0], o.height = sides[1];
         }},
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
         [&](const std::string& text) {
             std::vector<int> place = split_numbers(text, ',');
             bool fits = place.size() == 2 || place.size() == 3;
             if (!fits) fail_value("explain", text, "X,Y or X,Y,SAMPLE");
             place.push_back(0);
             o.explain = {0, place[1], place[0], place[2]};
         }},
        text_option("paths", "REGEX", "keep only these classes of path, such as 'LD(S|D)*E'",
                    o.paths),
        text_option("split", "DIR",
                    "write one picture for each class of path, and all as one sheet", o.split),
        text_option("film", "FILE.film",
                    "save the samples' sums, to continue later, even after kill -9", o.film),
        positive_option("film-every", "SECONDS", "how often the film is written (default 60)",
                        o.film_every),
        {"part", "K/N", "take the K-th of N parts of the samples; build/merge adds their films",
         [&](const std::string& text) {
             std::vector<int> numbers = split_numbers(text, '/');
             if (numbers.size() != 2 || numbers[0] < 1 || numbers[0] > numbers[1])
                 fail_value("part", text, "K/N, such as 1/8, with K from 1 to N");
             o.part = numbers[0], o.parts = numbers[1];
         }},
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
            if (word.empty() || !o.scene.empty())
                throw UsageError("error: one scene is needed, not '" + o.scene + "' and '" + word +
                                 "'");
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
    o.n = n;
    std::vector<Option> options = {
        whole_option("n", "N", "samples", 1, int64_t{1} << 40, o.n),
        whole_option("seed", "S", "seed of the random numbers", 0, 0xffffffff, o.seed),
        {"out", "FILE", ".ppm, .pfm or .png; may be repeated (default out/" + name + ".ppm)",
         [&](const std::string& text) { o.out.push_back(parse_picture("out", text)); }},
        flag_option("quiet", "print errors only", o.quiet),
    };
    parse_options(argc, argv, "", "Chapter " + name + ": prints a table and draws a picture.",
                  options, [](const std::string& word) {
                      throw UsageError("error: '" + word + "' is not an option; --help lists them");
                  });
    if (o.out.empty()) o.out = {"out/" + name + ".ppm"};
    check_outputs(o.out);
    o.comment = comment_of(
        {{"chapter", name}, {"n", std::to_string(o.n)}, {"seed", std::to_string(o.seed)}});
    return o;
}
