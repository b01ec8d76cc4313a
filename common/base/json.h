// JSON objects, written.
#pragma once
#include <cmath>
#include <concepts>
#include <cstdio>
#include <string>
#include <vector>

#include "common/base/text.h"

/// A text in JSON's quotes, of what can be printed.
inline std::string json_quoted(std::string_view text) {
    std::string json = "\"";
    for (char c : printable(text)) {
        if (c == '"' || c == '\\') json += '\\';
        json += c;
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
    template <class Value>
    void add(const char* name, const Value& value) {
        lines_ += std::string(lines_.empty() ? "  \"" : ",\n  \"") + name + "\": " + json(value);
    }
    std::string text() const { return "{\n" + lines_ + "\n}\n"; }

private:
    static std::string json(bool value) { return value ? "true" : "false"; }
    static std::string json(double value) { return json_number(value); }
    static std::string json(std::integral auto value) { return std::to_string(value); }
    static std::string json(const std::string& text) { return json_quoted(text); }
    template <class Value>
    static std::string json(const std::vector<Value>& values) {
        std::string list;
        for (const Value& value : values) list += (list.empty() ? "" : ", ") + json(value);
        return "[" + list + "]";
    }
    std::string lines_;
};
