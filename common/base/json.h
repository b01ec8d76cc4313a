// JSON objects, written.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/utf8.h"

/// A text in JSON's quotes; what is not UTF-8, such as a name in Latin-1, becomes U+FFFD.
inline std::string json_quoted(std::string_view text) {
    std::string json = "\"";
    for (size_t i = 0; i < text.size();) {
        size_t length = utf8_length(text, i);
        if (text[i] == '"' || text[i] == '\\') json += '\\';
        if (length == 0) {
            json += "\\ufffd";
        } else if (static_cast<unsigned char>(text[i]) < 32) {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(text[i]));
            json += escape;
        } else {
            json += text.substr(i, length);
        }
        i += std::max(length, size_t{1});
    }
    return json + '"';
}

/// A number with nine digits; null for what is not finite.
inline std::string json_number(double value) {
    if (!std::isfinite(value)) return "null";
    char text[64];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

/// One level of names and values, a line for each.
class JsonObject {
public:
    void add(const char* name, double value) { add_json(name, json_number(value)); }
    void add(const char* name, uint64_t value) { add_json(name, std::to_string(value)); }
    void add(const char* name, int value) { add_json(name, std::to_string(value)); }
    void add(const char* name, bool value) { add_json(name, value ? "true" : "false"); }
    void add(const char* name, const std::string& text) { add_json(name, json_quoted(text)); }
    void add(const char* name, const std::vector<double>& values) {
        std::vector<std::string> words;
        for (double value : values) words.push_back(json_number(value));
        add_list(name, words);
    }
    void add(const char* name, const std::vector<std::string>& texts) {
        std::vector<std::string> words;
        for (const std::string& text : texts) words.push_back(json_quoted(text));
        add_list(name, words);
    }
    std::string text() const { return "{\n" + lines_ + "\n}\n"; }

private:
    void add_list(const char* name, const std::vector<std::string>& words) {
        std::string list;
        for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
        add_json(name, "[" + list + "]");
    }
    void add_json(const char* name, const std::string& value) {
        lines_ += std::string(lines_.empty() ? "  \"" : ",\n  \"") + name + "\": " + value;
    }
    std::string lines_;
};
