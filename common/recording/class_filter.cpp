#include "common/recording/class_filter.h"

#include <algorithm>
#include <functional>
#include <set>

#include "common/base/position.h"

namespace {

constexpr std::string_view letters = "LDSE";

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
    bool take(char c) {
        bool is_next = at_ < text_.size() && text_[at_] == c;
        at_ += is_next;
        return is_next;
    }

    Places read_choice(const Places& from) {
        Places reached = read_sequence(from);
        while (take('|')) reached.merge(read_sequence(from));
        return reached;
    }
    Places read_sequence(Places from) {
        while (at_ < text_.size() && text_[at_] != '|' && text_[at_] != ')')
            from = read_repeated(from);
        return from;
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
        if (take('(')) {
            if (++depth_ > 8) fail(begin, "brackets are nested more than 8 deep");
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
        if (letters.find(c) == std::string_view::npos)
            fail(at_, std::string("'") + c + "' is not one of the letters L, D, S and E");
        at_++;
        return c;
    }

    const std::string& text_;
    const Step& step_;
    size_t at_ = 0;
    int depth_ = 0;  // of brackets
};

}  // namespace

ClassFilter::ClassFilter(const std::string& expression)
    : expression_(expression.empty() ? ".*" : expression) {
    matches("");
}

bool ClassFilter::matches(const std::string& path_class) {
    if (auto known = known_.find(path_class); known != known_.end()) return known->second;
    // A place: how many letters of the class have been read.
    Step step = [&](size_t place, const std::string& set, Places& reached) {
        bool fits = place < path_class.size() && set.find(path_class[place]) != std::string::npos;
        if (fits) reached.insert(place + 1);
    };
    bool found = Matcher(expression_, step).run().contains(path_class.size());
    if (known_.size() < 1000) known_[path_class] = found;
    return found;
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
