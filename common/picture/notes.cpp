#include "common/picture/notes.h"

#include <sstream>

#include "common/base/json.h"
#include "common/base/position.h"

static constexpr const char* first_line = "picture of path-by-path";

Notes notes_of(const FilmLabel& label, double spp) {
    Notes notes;
    for (const auto& [name, value] : label.options) {
        if (name != "code" && !value.empty()) notes.push_back({name, value});
    }
    if (!label.samples.empty()) notes.push_back({"spp", json_number(spp)});
    bool from_the_start = label.samples.size() == 1 && label.samples[0].first == 0;
    if (from_the_start) notes.push_back({"seed", std::to_string(label.samples[0].seed)});
    for (const SampleRange& r : label.samples) {
        if (from_the_start) break;
        notes.push_back({"samples", std::to_string(r.first) + " to " + std::to_string(r.last - 1) +
                                        " of seed " + std::to_string(r.seed)});
    }
    return notes;
}

std::vector<std::string> lines_of(const Notes& notes) {
    std::vector<std::string> lines;
    for (const auto& [name, value] : notes) lines.push_back(name + ' ' + printable(value));
    return lines;
}

Notes notes_in(const std::vector<std::string>& lines) {
    Notes notes;
    for (const std::string& line : lines) {
        size_t space = std::min(line.find(' '), line.size());
        notes.push_back({line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
    }
    return notes;
}

std::string comment_of(const Notes& notes) {
    std::string comment = first_line;
    for (const std::string& line : lines_of(notes)) comment += '\n' + line;
    return comment;
}

Notes notes_in(const std::string& comment) {
    std::istringstream text(comment);
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    if (lines.empty() || lines[0] != first_line) return {};
    lines.erase(lines.begin());
    return notes_in(lines);
}

std::string value_of(const Notes& notes, const std::string& name) {
    for (const auto& [its_name, value] : notes) {
        if (its_name == name) return value;
    }
    return "";
}
