// JSON objects, written.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

/// A text in JSON's quotes; control characters are blanks.
inline std::string json_quoted(const std::string& text) {
    std::string json = "\"";
    for (char c : text) {
        if (c == '"' || c == '\\') json += '\\';
        json += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
    return json + "\"";
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
