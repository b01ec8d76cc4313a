// Command lines, and the error handling that all programs share.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// One option, `--name ARGUMENT` (or `--name` if `argument` is empty). `set` receives the
/// argument's text, and throws UsageError if it is invalid. --help omits options without `help`.
/// value: the default. --help adds it to a help line that names none; and films record it for the
/// options that a chapter adds.
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

/// A whole number within [low, high], or UsageError that names the option.
int64_t parse_integer(const std::string& option, const std::string& text, int64_t low,
                      int64_t high);
/// The index of `text` in the words `known`, or UsageError that suggests the most similar one.
size_t parse_choice(const std::string& option, const std::string& text,
                    const std::vector<std::string>& known);
/// A number greater than 0, or UsageError.
double parse_positive(const std::string& option, const std::string& text);
/// The numbers of at most 9 digits in a text such as "256x256"; none if it has another form.
std::vector<int> split_numbers(const std::string& text, char separator);

/// An option that sets a whole number within [low, high]. Its default is what it is now.
template <class Number>
Option whole_option(const std::string& name, const std::string& argument, const std::string& help,
                    int64_t low, int64_t high, Number& number) {
    auto set = [=, &number](const std::string& text) {
        number = static_cast<Number>(parse_integer(name, text, low, high));
    };
    return {name, argument, help, set, std::to_string(number)};
}
/// An option that chooses one of the words; `choice` is its number, from 0.
template <class Choice>
Option choice_option(const std::string& name, const std::string& argument, const std::string& help,
                     const std::vector<std::string>& words, Choice& choice) {
    auto set = [=, &choice](const std::string& text) {
        choice = static_cast<Choice>(parse_choice(name, text, words));
    };
    return {name, argument, help, set, words[static_cast<size_t>(choice)]};
}
/// An option that sets a number greater than 0 (or_zero: or 0, its default).
inline Option positive_option(const std::string& name, const std::string& argument,
                              const std::string& help, double& number, bool or_zero = false) {
    auto set = [=, &number](const std::string& text) {
        number = or_zero && text == "0" ? 0 : parse_positive(name, text);
    };
    return {name, argument, help, set, or_zero ? "0" : ""};
}
/// An option that sets a text, and one without argument.
inline Option text_option(const std::string& name, const std::string& argument,
                          const std::string& help, std::string& text) {
    return {name, argument, help, [&](const std::string& given) { text = given; }};
}
inline Option flag_option(const std::string& name, const std::string& help, bool& flag) {
    return {name, "", help, [&](const std::string&) { flag = true; }};
}

/// "a, b and c", where `last` is " and ".
std::string listed(const std::vector<std::string>& words, const std::string& last);

/// The command, quoted for the shell: words with special characters are in single quotes.
std::string command_line(int argc, char** argv);

/// Runs a program and returns its exit code: 1 after an InputError or if output to stdout failed, 2
/// after a UsageError. Prints errors to stderr.
int run_program(const std::function<int()>& program);

/// Flushes stdout; throws InputError if writing failed, for example on a full disk.
void flush_stdout();
