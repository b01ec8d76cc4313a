#include "common/recording/class_filter.h"

#include "common/base/position.h"

namespace {

constexpr std::string_view letters = "LDSE";
constexpr uint8_t every_letter = 15;

/// The bit of a letter; 0 for any other character.
uint8_t letter_bit(char c) {
    size_t i = letters.find(c);
    return static_cast<uint8_t>(i == std::string_view::npos ? 0 : 1 << i);
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

/// Compiles an expression to places (states) and steps (transitions) of an automaton. Each function
/// parses one rule of the grammar at at_, and returns the first and the last place of its part.
class ClassFilterReader {
public:
    ClassFilterReader(ClassFilter& filter, const std::string& text)
        : filter_(filter), text_(text) {}

    void read() {
        if (text_.size() > most_letters) fail(most_letters, "the expression is too long");
        Part all = read_choice();
        if (at_ < text_.size()) fail(at_, "this ) closes nothing");
        filter_.start_ = all.start;
        filter_.end_ = all.end;
    }

private:
    static constexpr size_t most_letters = 1000;  // nested brackets use the stack
    static constexpr size_t most_places = 5000;

    struct Part {
        uint32_t start, end;
    };

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

    uint32_t new_place() {
        if (filter_.steps_.size() == most_places)
            fail(at_, "too much, when its counts are written out");
        filter_.steps_.emplace_back();
        return static_cast<uint32_t>(filter_.steps_.size() - 1);
    }
    void connect(uint32_t from, uint32_t to, uint8_t over = 0) {
        filter_.steps_[from].push_back({to, over});
    }

    Part read_choice() {
        Part all = {new_place(), new_place()};
        do {
            Part one = read_sequence();
            connect(all.start, one.start);
            connect(one.end, all.end);
        } while (take('|'));
        return all;
    }

    Part read_sequence() {
        uint32_t start = new_place(), end = start;
        while (at_ < text_.size() && !next_is('|') && !next_is(')')) {
            Part next = read_repeated();
            connect(end, next.start);
            end = next.end;
        }
        return {start, end};
    }

    Part read_repeated() {
        size_t begin = at_;
        Part all = read_one();
        if (take('*')) {
            connect(all.end, all.start);
            return optional(all);
        }
        if (take('+')) {
            connect(all.end, all.start);
            return all;
        }
        if (take('?')) return optional(all);
        if (next_is('{')) return read_counted(begin);
        return all;
    }
    /// Makes a part optional.
    Part optional(Part part) {
        Part all = {new_place(), new_place()};
        connect(all.start, part.start);
        connect(part.end, all.end);
        connect(all.start, all.end);
        return all;
    }

    /// Repeats the part that begins at `begin` as often as the count behind it says.
    Part read_counted(size_t begin) {
        size_t brace = at_++;
        int low = read_count(brace), high = low;
        bool endless = false;
        if (take(',')) {
            endless = next_is('}');
            if (!endless) high = read_count(brace);
        }
        if (!take('}') || high < low) fail(brace, "a count is written {2}, {2,} or {2,4}");
        size_t behind = at_;

        uint32_t start = new_place(), end = start;
        for (int i = 0; i < high + (endless ? 1 : 0); i++) {
            at_ = begin;
            Part next = read_one();
            if (endless && i == high) connect(next.end, next.start);
            if (i >= low) next = optional(next);
            connect(end, next.start);
            end = next.end;
        }
        at_ = behind;
        return {start, end};
    }
    int read_count(size_t brace) {
        size_t digits = 0;
        while (at_ + digits < text_.size() && is_digit(text_[at_ + digits])) digits++;
        if (digits == 0) fail(brace, "a count is written {2}, {2,} or {2,4}");
        if (digits > 4) fail(at_, "a count is at most 9999");
        at_ += digits;
        return std::stoi(text_.substr(at_ - digits, digits));
    }

    Part read_one() {
        size_t begin = at_;
        if (take('(')) {
            if (text_.compare(at_, 2, "?:") == 0) at_ += 2;
            Part inside = read_choice();
            if (!take(')')) fail(begin, "this ( is not closed");
            return inside;
        }
        uint8_t set = take('.') ? every_letter : take('[') ? read_set(begin) : read_letter();
        Part one = {new_place(), new_place()};
        connect(one.start, one.end, set);
        return one;
    }
    uint8_t read_set(size_t begin) {
        bool others = take('^');
        uint8_t set = 0;
        while (!take(']')) {
            if (at_ == text_.size()) fail(begin, "this [ is not closed");
            set |= read_letter();
        }
        if (others) set = every_letter & ~set;
        if (set == 0) fail(begin, "no letter is in this [ ]");
        return set;
    }
    uint8_t read_letter() {
        uint8_t bit = letter_bit(text_[at_]);
        std::string c = {'\'', text_[at_], '\''};
        if (std::string_view("*+?{").find(text_[at_]) != std::string_view::npos) {
            fail(at_, "nothing stands before " + c + " that it could repeat");
        }
        if (bit == 0) fail(at_, c + " is no letter of a path's class: those are L, D, S and E");
        at_++;
        return bit;
    }

    ClassFilter& filter_;
    const std::string& text_;
    size_t at_ = 0;
};

ClassFilter::ClassFilter(const std::string& expression) {
    ClassFilterReader(*this, expression).read();
}

/// Adds a place, and all places that are reached from it without reading a letter.
void ClassFilter::add(Places& places, uint32_t place) const {
    std::vector<uint32_t> open = {place};
    while (!open.empty()) {
        place = open.back();
        open.pop_back();
        if (places[place]) continue;
        places[place] = true;
        for (const Step& step : steps_[place]) {
            if (step.letters == 0) open.push_back(step.to);
        }
    }
}

ClassFilter::Places ClassFilter::at_start() const {
    Places places(steps_.size());
    add(places, start_);
    return places;
}

/// The places that are reached by reading one of these letters.
ClassFilter::Places ClassFilter::after(const Places& places, uint8_t over) const {
    Places next(steps_.size());
    for (size_t place = 0; place < steps_.size(); place++) {
        if (!places[place]) continue;
        for (const Step& step : steps_[place]) {
            if ((step.letters & over) != 0) add(next, step.to);
        }
    }
    return next;
}

bool ClassFilter::matches(std::string_view path_class) const {
    Places places = at_start();
    for (char c : path_class) places = after(places, letter_bit(c));
    return places[end_];
}

bool ClassFilter::matches_some_path() const {
    Places places = after(at_start(), letter_bit('L')), before;
    // Add the places that more D and S reach, until there are no new ones.
    while (places != before) {
        before = places;
        Places more = after(places, letter_bit('D') | letter_bit('S'));
        for (size_t i = 0; i < places.size(); i++) places[i] = places[i] || more[i];
    }
    return after(places, letter_bit('E'))[end_];
}

ClassSelection::ClassSelection(const std::string& expression) {
    if (!expression.empty()) filter_.emplace(expression);
}

bool ClassSelection::contains(const std::string& path_class) {
    if (!filter_) return true;
    if (auto known = known_.find(path_class); known != known_.end()) return known->second;
    bool matches = filter_->matches(path_class);
    if (known_.size() < 1000) known_[path_class] = matches;
    return matches;
}
