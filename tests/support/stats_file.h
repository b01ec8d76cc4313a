// Helper of the tests that read what --stats wrote.
#pragma once
#include <optional>
#include <string>

#include "common/base/text.h"

/// A JSON object of one level.
struct StatsFile {
    std::string json;

    /// The number of that name; nothing where it is null or missing.
    std::optional<double> number(const std::string& name) const {
        size_t at = json.find("\"" + name + "\": ");
        if (at == std::string::npos) return {};
        std::string rest = json.substr(at + name.size() + 4);
        return to_number(rest.substr(0, rest.find_first_of(",\n}")));
    }
};
