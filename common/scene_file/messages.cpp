#include "common/scene_file/messages.h"

#include "common/scene_file/stand_ins.h"

void stop_reading(const Position& at, const std::string& text) {
    throw ReadingEnds(message_at(at, "error", text));
}

void check_limit(const Position& at, uint64_t count, uint64_t most, const std::string& things) {
    if (count > most) stop_reading(at, "more than " + std::to_string(most) + ' ' + things);
}

void Messages::note(const Position& at, const std::string& text) {
    constexpr size_t most = 100;
    if (notes_.size() > most || !texts_.insert(text).second) return;
    bool too_many = notes_.size() == most;
    notes_.push_back(
        message_at(at, "note", too_many ? "there is more of which to take note" : text));
}

void Messages::error(const Position& at, const std::string& text) {
    add(InputError(message_at(at, "error", text)));
}

void Messages::add(const std::exception& error) {
    std::string line = error.what();
    std::string text = line.substr(std::min(line.size(), line.find(": error: ")));
    if (texts_.insert(text).second) errors_.push_back(line);
}

void Messages::stand_in(const Position& at, const std::string& what, const std::string& text) {
    if (!stand_ins_) {
        std::string wrong = text.empty() ? what + " is not supported" : text;
        return error(at, wrong + or_stand_in(what).substr(wrong.ends_with('?') ? 1 : 0));
    }
    used_[what].insert(at);
}

bool Messages::try_to_read(const Position& at, const std::string& what,
                           const std::function<void()>& read) {
    try {
        read();
        return true;
    } catch (const InputError& error) {
        if (stand_ins_) {
            stand_in(at, what);
        } else {
            add(InputError(error.what() + or_stand_in(what)));
        }
        return false;
    }
}

std::vector<UsedStandIn> Messages::used() const {
    std::vector<UsedStandIn> list;
    for (const auto& [what, instead] : all_stand_ins()) {
        auto found = used_.find(what);
        if (found == used_.end()) continue;
        list.push_back({what, instead, found->second.size(), *found->second.begin()});
    }
    return list;
}

void Messages::finish() const {
    std::string text;
    for (const std::string& line : errors_) text += (text.empty() ? "" : "\n") + line;
    if (!text.empty()) throw InputError(text);
}
