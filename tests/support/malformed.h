// The tables of malformed input in tests/support/malformed: what is given, and what must be said.
#pragma once
#include <string>
#include <vector>

#include "common/base/files.h"

struct MalformedCase {
    std::string input, message;
    bool in_world = false;  // a scene: stands behind the first line of a world
};

/// Reads a table: lines up to one that starts with => are the input, the rest of that line is the
/// message, and so are the lines after it that start with => too. Lines that start with ## are for
/// the reader; [world] stands before inputs for a world.
inline std::vector<MalformedCase> read_malformed_cases(const std::string& path) {
    std::vector<MalformedCase> cases;
    std::string text = read_file(path);
    MalformedCase next;
    bool more = false;  // of the last message
    for (size_t start = 0; start < text.size();) {
        size_t end = text.find('\n', start);
        std::string line = text.substr(start, end - start);
        start = end + 1;
        if (line.starts_with("##") || line.empty()) continue;
        if (line.starts_with("=> ") && more) {
            cases.back().message += '\n' + line.substr(3);
            continue;
        }
        more = line.starts_with("=> ");
        if (line == "[world]") {
            next.in_world = true;
        } else if (line.starts_with("=> ")) {
            next.message = line.substr(3);
            cases.push_back(next);
            next.input.clear();
        } else {
            next.input += line + '\n';
        }
    }
    return cases;
}
