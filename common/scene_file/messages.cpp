#include "common/scene_file/messages.h"

#include <sstream>

void stop_reading(const Position& at, const std::string& text) {
    throw ReadingEnds(message_at(at, "error", text));
}

Messages::Messages(std::string kind, std::vector<std::string>& lines)
    : kind_(std::move(kind)), lines_(lines) {}

void Messages::add(const Position& at, const std::string& text) {
    constexpr size_t most = 100;
    if (texts_.size() > most || !texts_.insert(text).second) return;
    bool too_many = texts_.size() > most;
    lines_.push_back(
        message_at(at, kind_, too_many ? "there is more of which to take note" : text));
}

void Messages::add(const InputError& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) {
        std::string text = line.substr(std::min(line.size(), line.find(": " + kind_ + ": ")));
        if (texts_.insert(text).second) lines_.push_back(line);
    }
}

std::string join_lines(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
    return text;
}
