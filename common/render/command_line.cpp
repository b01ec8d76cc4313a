#include "common/render/command_line.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/base/system.h"
#include "common/base/text.h"

[[noreturn]] static void print_usage(const char* program, const std::string& positional,
                                     const std::string& about, const std::vector<Option>& options) {
    std::printf("usage: %s%s%s [OPTION]...\n%s\n\n", program, positional.empty() ? "" : " ",
                positional.c_str(), about.c_str());
    for (const Option& option : options) {
        if (option.help.empty()) continue;
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
    errno = 0;
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
    std::string why = errno != 0 ? std::strerror(errno) : "some of the output is lost";
    throw InputError("stdout: error: cannot write: " + why);
}

std::vector<Option> parse_options(int argc, char** argv, const std::string& positional,
                                  const std::string& about, std::vector<Option> options,
                                  const std::function<void(const std::string&)>& set_positional) {
    options.push_back({"help", "", "print this and stop", [&](const std::string&) {
                           print_usage(argv[0], positional, about, options);
                       }});
    std::vector<std::string> names;
    for (const Option& option : options) names.push_back("--" + option.name);
    bool options_ended = false;
    for (int i = 1; i < argc; i++) {
        std::string word = argv[i];
        if (options_ended || !word.starts_with('-')) {
            set_positional(word);
            continue;
        }
        options_ended = word == "--";
        if (options_ended) continue;
        size_t equals = word.find('=');
        std::string name = word.substr(0, equals), value;
        auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
            std::string nearest = nearest_word(name, names);
            throw UsageError(
                "error: unknown option '" + name + "'" +
                (nearest.empty() ? "; --help lists them" : ", did you mean '" + nearest + "'?"));
        }
        Option& option = options[static_cast<size_t>(found - names.begin())];

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

int64_t parse_integer(const std::string& option, const std::string& text, int64_t low,
                      int64_t high) {
    double value = to_number(text).value_or(NAN);
    if (value == std::floor(value) && value >= static_cast<double>(low) &&
        value <= static_cast<double>(high))
        return static_cast<int64_t>(value);
    fail_value(option, text,
               "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
}

size_t parse_choice(const std::string& option, const std::string& text,
                    const std::vector<std::string>& known) {
    auto found = std::find(known.begin(), known.end(), text);
    if (found != known.end()) return static_cast<size_t>(found - known.begin());
    std::string words = listed(known, " or ");
    std::string nearest = nearest_word(text, known);
    if (!nearest.empty()) words += " (did you mean '" + nearest + "'?)";
    fail_value(option, text, words);
}

std::vector<int> split_numbers(const std::string& text, char separator) {
    std::vector<int> numbers;
    for (size_t begin = 0, end = 0; end < text.size(); begin = end + 1) {
        end = std::min(text.find(separator, begin), text.size());
        std::string digits = text.substr(begin, end - begin);
        bool is_number = digits.find_first_not_of("0123456789") == std::string::npos;
        if (!is_number || digits.empty() || digits.size() > 9) return {};
        numbers.push_back(std::stoi(digits));
    }
    return numbers;
}

double parse_positive(const std::string& option, const std::string& text) {
    double value = to_number(text).value_or(0);
    if (!(value > 0) || !std::isfinite(value)) {
        fail_value(option, text, "a number greater than 0");
    }
    return value;
}

std::string listed(const std::vector<std::string>& words, const std::string& last) {
    std::string text;
    for (size_t i = 0; i < words.size(); i++)
        text += (i == 0 ? "" : i + 1 < words.size() ? ", " : last) + words[i];
    return text;
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
    std::string error;
    bool is_usage = false;
    try {
        prepare_streams();
        int code = program();
        flush_stdout();
        return code;
    } catch (const UsageError& e) {
        error = printable(e.what());  // one line
        is_usage = true;
    } catch (const InputError& e) {
        error = e.what();
    } catch (const std::bad_alloc&) {
        error = "error: out of memory";
    } catch (const std::exception& e) {
        error = "error: " + printable(e.what());
    }
    std::istringstream lines(error);
    for (std::string line; std::getline(lines, line);) tell(printable(line) + "\n");
    return is_usage ? 2 : 1;
}
