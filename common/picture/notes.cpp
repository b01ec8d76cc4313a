#include "common/picture/notes.h"

#include <sstream>

#include "common/base/position.h"

static constexpr const char* first_line = "picture of path-by-path";

std::vector<std::string> lines_of(const Notes& notes) {
    std::vector<std::string> lines;
    for (const auto& [name, value] : notes) lines.push_back(name + ' ' + printable(value));
    return lines;
}

std::string comment_of(const Notes& notes) {
    std::string comment = first_line;
    for (const std::string& line : lines_of(notes)) comment += '\n' + line;
    return comment;
}

Notes notes_in(const std::string& comment) {
    std::istringstream lines(comment);
    std::string line;
    Notes notes;
    if (!std::getline(lines, line) || line != first_line) return {};
    while (std::getline(lines, line)) {
        size_t space = std::min(line.find(' '), line.size());
        notes.push_back({line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
    }
    return notes;
}

std::string value_of(const Notes& notes, const std::string& name) {
    for (const auto& [its_name, value] : notes) {
        if (its_name == name) return value;
    }
    return "";
}
