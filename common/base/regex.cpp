#include "common/base/regex.h"

#include <regex>

std::vector<std::string> groups_of(const std::string& text, const char* pattern) {
    std::smatch match;
    if (!std::regex_match(text, match, std::regex(pattern))) return {};
    return {match.begin(), match.end()};
}

std::string replace_each(const std::string& text, const char* pattern, const std::string& by) {
    return std::regex_replace(text, std::regex(pattern), by);
}
