// The expressions of --paths, which select classes of paths.
#pragma once
#include <map>
#include <set>
#include <string>

#include "common/base/error.h"

/// A regular expression over the letters of a path's class, which must match the whole class.
///
///   L D S E   that letter            .     any letter          a|b   a or b
///   a* a+ a?  any number of a, at least one, at most one       (a)   brackets
///
/// It is followed from all possible places of the class at the same time. Each function reads one
/// rule of the grammar at at_, and returns the places that are reached from those before it.
/// tested by  "truth: what each sign of a class filter matches"
class ClassFilter {
public:
    /// Empty: all classes match. Throws UsageError, with the column, for an invalid expression.
    explicit ClassFilter(const std::string& expression)
        : text_(expression.empty() ? ".*" : expression) {
        matches("");
        if (at_ < text_.size()) fail(at_, "this ) closes nothing");
    }

    /// Remembers the answers.
    bool matches(const std::string& path_class) {
        if (auto known = known_.find(path_class); known != known_.end()) return known->second;
        word_ = path_class, at_ = 0;
        bool found = read_choice({0}).contains(word_.size());
        if (known_.size() < 1000) known_[path_class] = found;
        return found;
    }

private:
    using Places = std::set<size_t>;  // how many letters have been read

    [[noreturn]] void fail(size_t at, const std::string& what) const {
        throw UsageError("error: --paths " + quote(text_) + ", column " + std::to_string(at + 1) +
                         ": " + what);
    }
    bool take(char c) {
        bool is_next = at_ < text_.size() && text_[at_] == c;
        at_ += is_next;
        return is_next;
    }

    Places read_choice(const Places& from) {
        Places reached;
        do {
            Places places = from;
            while (at_ < text_.size() && text_[at_] != '|' && text_[at_] != ')')
                places = read_repeated(places);
            reached.merge(places);
        } while (take('|'));
        return reached;
    }
    Places read_repeated(const Places& from) {
        size_t begin = at_;
        Places newest = read_one(from), reached = newest;
        bool star = take('*'), plus = !star && take('+'), maybe = !star && !plus && take('?');
        size_t behind = at_;
        while ((star || plus) && !newest.empty()) {
            at_ = begin;
            newest = read_one(newest);
            std::erase_if(newest, [&](size_t place) { return reached.contains(place); });
            reached.insert(newest.begin(), newest.end());
        }
        at_ = behind;
        if (star || maybe) reached.insert(from.begin(), from.end());
        return reached;
    }
    Places read_one(const Places& from) {
        size_t begin = at_;
        char c = text_[at_++];
        Places reached;
        if (c == '(') {
            if (++depth_ > 8) fail(begin, "brackets are nested more than 8 deep");
            reached = read_choice(from);
            if (!take(')')) fail(begin, "this ( is not closed");
            depth_--;
        } else if (c != '.' && c != 'L' && c != 'D' && c != 'S' && c != 'E') {
            fail(begin, std::string("'") + c + "' is not one of the letters L, D, S and E");
        } else {
            for (size_t place : from)
                if (place < word_.size() && (c == '.' || c == word_[place]))
                    reached.insert(place + 1);
        }
        return reached;
    }

    std::string text_, word_;
    size_t at_ = 0;
    int depth_ = 0;  // of brackets
    std::map<std::string, bool> known_;
};
