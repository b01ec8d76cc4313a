// Regular expressions, compiled here alone: <regex> takes a second in every file that includes it.
#pragma once
#include <string>
#include <vector>

/// The groups of the pattern if it matches all of the text, the whole match first; else none.
std::vector<std::string> groups_of(const std::string& text, const char* pattern);

/// The text with `by` for each part that matches the pattern.
std::string replace_each(const std::string& text, const char* pattern, const std::string& by);
