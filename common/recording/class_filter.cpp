#include "common/recording/class_filter.h"

#include <algorithm>
#include <functional>
#include <set>

#include "common/base/position.h"

namespace {

constexpr std::string_view letters = "LDSE";
constexpr int endless = 1 << 30;

using Places = std::set<size_t>;
/// Adds the places that are reached from a place by reading one letter of a set.
using Step = std::function<void(size_t place, const std::string& set, Places& reached)>;

/// Follows an expression from all possible places at the same time. Each function reads one rule of
/// the grammar at at_, and returns the places that are reached from those before it.
class Matcher {
public:
    Matcher(const std::string& expression, const Step& step) : text_(expression), step_(step) {}

    Places run() {
        if (text_.size() > 1000) fail(1000, "the expression is too long");
        Places reached = read_choice({0});
        if (at_ < text_.size()) fail(at_, "this ) closes nothing");
        return reached;
    }

private:
    [[noreturn]] void fail(size_t at, const std::string& what) const {
        throw UsageError("error: --paths " + quote(text_) + ", column " + std::to_string(at + 1) +
                         ": " + what);
    }
    bool next_is(char c) const { return at_ < text_.size() && text_[at_] == c; }
    bool take(char c) {
        if (!next_is(c)) return false;
        at_++;
        return true;
    }

    Places read_choice(const Places& from) {
        Places reached = read_sequence(from);
        while (take('|')) reached.merge(read_sequence(from));
        return reached;
    }
    Places read_sequence(Places from) {
        while (at_ < text_.size() && !next_is('|') && !next_is(')')) from = read_repeated(from);
        return from;
    }

    Places read_repeated(const Places& from) {
        size_t begin = at_;
        read_one(from);
        auto [low, high] = read_count();
        size_t behind = at_;
        Places reached = from, newest = from;
        for (int i = 0; i < high && !newest.empty(); i++) {
            at_ = begin;
            newest = read_one(newest);
            if (i < low) {
                if (newest == reached) break;
                reached = newest;
            } else {
                std::erase_if(newest, [&](size_t place) { return reached.contains(place); });
                reached.insert(newest.begin(), newest.end());
            }
        }
        at_ = behind;
        return reached;
    }
    /// How often the part before may be repeated: at least, at most.
    std::pair<int, int> read_count() {
        if (take('*')) return {0, endless};
        if (take('+')) return {1, endless};
        if (take('?')) return {0, 1};
        size_t brace = at_;
        if (!take('{')) return {1, 1};
        int low = read_number(brace), high = low;
        if (take(',')) high = next_is('}') ? endless : read_number(brace);
        if (!take('}') || high < low) fail(brace, "a count is written {2}, {2,} or {2,4}");
        return {low, high};
    }
    int read_number(size_t brace) {
        size_t end = std::min(text_.find_first_not_of("0123456789", at_), text_.size());
        if (end == at_) fail(brace, "a count is written {2}, {2,} or {2,4}");
        if (end > at_ + 4) fail(at_, "a count is at most 9999");
        int number = std::stoi(text_.substr(at_, end - at_));
        at_ = end;
        return number;
    }

    Places read_one(const Places& from) {
        size_t begin = at_;
        if (take('(')) {
            if (++depth_ > 8) fail(begin, "brackets are nested more than 8 deep");
            if (text_.compare(at_, 2, "?:") == 0) at_ += 2;
            Places reached = read_choice(from);
            if (!take(')')) fail(begin, "this ( is not closed");
            depth_--;
            return reached;
        }
        std::string set = take('.')   ? std::string(letters)
                          : take('[') ? read_set(begin)
                                      : std::string(1, read_letter());
        Places reached;
        for (size_t place : from) step_(place, set, reached);
        return reached;
    }
    std::string read_set(size_t begin) {
        bool others = take('^');
        std::string named, set;
        while (!take(']')) {
            if (at_ == text_.size()) fail(begin, "this [ is not closed");
            named += read_letter();
        }
        for (char c : letters)
            if ((named.find(c) == std::string::npos) == others) set += c;
        if (set.empty()) fail(begin, "no letter is in this [ ]");
        return set;
    }
    char read_letter() {
        char c = text_[at_];
        std::string name = {'\'', c, '\''};
        if (std::string_view("*+?{").find(c) != std::string_view::npos)
            fail(at_, "nothing stands before " + name + " that it could repeat");
        if (letters.find(c) == std::string_view::npos)
            fail(at_, name + " is no letter of a path's class: those are L, D, S and E");
        at_++;
        return c;
    }

    const std::string& text_;
    const Step& step_;
    size_t at_ = 0;
    int depth_ = 0;  // of brackets
};

}  // namespace

ClassFilter::ClassFilter(const std::string& expression) : expression_(expression) { matches(""); }

bool ClassFilter::matches(std::string_view path_class) const {
    // A place: how many letters of the class have been read.
    Step step = [&](size_t place, const std::string& set, Places& reached) {
        bool fits = place < path_class.size() && set.find(path_class[place]) != std::string::npos;
        if (fits) reached.insert(place + 1);
    };
    return Matcher(expression_, step).run().contains(path_class.size());
}

bool ClassFilter::matches_some_path() const {
    // The places: 0 before L, 1 behind it and behind any number of D and S, 2 behind E.
    Step step = [](size_t place, const std::string& set, Places& reached) {
        if (place == 0 && set.find('L') != std::string::npos) reached.insert(1);
        if (place == 1 && set.find_first_of("DS") != std::string::npos) reached.insert(1);
        if (place == 1 && set.find('E') != std::string::npos) reached.insert(2);
    };
    return Matcher(expression_, step).run().contains(2);
}

bool ClassSelection::contains(const std::string& path_class) {
    if (auto known = known_.find(path_class); known != known_.end()) return known->second;
    bool matches = filter_.matches(path_class);
    if (known_.size() < 1000) known_[path_class] = matches;
    return matches;
}
