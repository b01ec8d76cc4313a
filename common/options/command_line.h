// Command lines, and the error handling that all programs share.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// One option, `--name ARGUMENT` (or `--name` if `argument` is empty). `set` receives the
/// argument's text, and throws UsageError if it is invalid. --help omits options without `help`.
/// For an option that changes what is rendered, `value` is its default.
struct Option {
    std::string name, argument, help;
    std::function<void(const std::string&)> set;
    std::string value = {};
};

/// Parses the command line. Words that belong to no option go to `set_positional`. For --help it
/// prints the usage and exits. Throws UsageError for an unknown option, and suggests the most
/// similar one.
void parse_options(int argc, char** argv, const std::string& positional, const std::string& about,
                   std::vector<Option> options,
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
/// The numbers of at most 9 digits in a text such as "256x256"; none if it has another form.
std::vector<int> split_numbers(const std::string& text, char separator);
/// A number greater than 0, or UsageError.
double parse_positive(const std::string& option, const std::string& text);

/// The command, quoted for the shell: words with special characters are in single quotes.
std::string command_line(int argc, char** argv);

/// Runs a program and returns its exit code: 1 after an InputError or if output to stdout failed, 2
/// after a UsageError. Prints errors to stderr.
int run_program(const std::function<int()>& program);

/// Flushes stdout; throws InputError if writing failed, for example on a full disk.
void flush_stdout();
