// Command lines, and what every program does around its own work.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// One option, `--name ARGUMENT` (or `--name` alone where argument is empty). `set` gets the
/// argument's text and throws UsageError when it cannot be used. Without help --help leaves it out.
/// An option that changes what is rendered names in `value` what it is without being set.
struct Option {
    std::string name, argument, help;
    std::function<void(const std::string&)> set;
    std::string value = {};
};

/// Reads the command line. Words that belong to no option go to `set_positional`. Prints the
/// usage and ends the program for --help. Throws UsageError for anything unknown, with the nearest
/// known option.
void parse_options(int argc, char** argv, const std::string& positional, const std::string& about,
                   std::vector<Option> options,
                   const std::function<void(const std::string&)>& set_positional);

/// Throws the UsageError "--option takes WANTED, not 'text'".
[[noreturn]] void fail_value(const std::string& option, const std::string& text,
                             const std::string& wanted);

/// A whole number within [low, high], or UsageError that names the option.
int64_t parse_integer(const std::string& option, const std::string& text, int64_t low,
                      int64_t high);
/// The place of `text` among the words `known`, or UsageError with the nearest of them.
size_t parse_choice(const std::string& option, const std::string& text,
                    const std::vector<std::string>& known);
/// A number greater than 0, or UsageError.
double parse_positive(const std::string& option, const std::string& text);

/// The command so that a shell takes it again: words with special characters in single quotes.
std::string command_line(int argc, char** argv);

/// Runs a program: returns its exit code, 1 after an InputError or when not all that it printed
/// arrived, 2 after a UsageError. Errors are lines on stderr.
int run_program(const std::function<int()>& program);

/// Hands over what was printed; throws InputError when it did not all arrive, as on a full disk.
void flush_stdout();
