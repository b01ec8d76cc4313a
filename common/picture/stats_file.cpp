#include "common/picture/stats_file.h"

#include <cstring>
#include <filesystem>

#include "common/base/files.h"
#include "common/base/numbers.h"
#include "common/base/system.h"

static constexpr const char* blanks = " \t\r\n";

std::string StatsFile::path_beside(const std::string& picture) {
    return file_name(file_path(picture).replace_extension(".json"));
}

std::optional<StatsFile> StatsFile::beside(const std::string& picture) {
    std::string path = path_beside(picture);
    if (!std::filesystem::exists(file_path(path))) return {};
    return StatsFile(read_file(path));
}

const char* StatsFile::value(const std::string& name) const {
    size_t at = json_.find("\"" + name + "\":");
    if (at == std::string::npos) return nullptr;
    at = json_.find_first_not_of(blanks, at + name.size() + 3);
    return at == std::string::npos ? nullptr : json_.c_str() + at;
}

std::optional<double> StatsFile::number(const std::string& name) const {
    const char* at = value(name);
    if (at == nullptr) return {};
    return to_number({at, std::strcspn(at, " \t\r\n,}")});
}

std::vector<std::string> StatsFile::texts(const std::string& name) const {
    std::vector<std::string> list;
    const char* at = value(name);
    while (at != nullptr && (*at == '[' || *at == ',')) {
        at += 1 + std::strspn(at + 1, blanks);
        if (*at != '"') break;
        std::string& text = list.emplace_back();
        for (at++; *at != '"' && *at != '\0'; at++) {
            if (*at == '\\' && at[1] != '\0') at++;
            text += *at;
        }
        at += *at == '"';
        at += std::strspn(at, blanks);
    }
    return list;
}
