// Reads the --stats file of a render, for the tools.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// The JSON object that --stats wrote: one level, one name once.
class StatsFile {
public:
    explicit StatsFile(std::string json) : json_(std::move(json)) {}

    /// The file NAME.json beside the picture NAME.pfm; nothing when there is none.
    static std::optional<StatsFile> beside(const std::string& picture);
    static std::string path_beside(const std::string& picture);

    /// The number of that name; nothing where it is null or missing.
    std::optional<double> number(const std::string& name) const;
    /// The texts of the list of that name; none when missing.
    std::vector<std::string> texts(const std::string& name) const;

private:
    const char* value(const std::string& name) const;
    std::string json_;
};
