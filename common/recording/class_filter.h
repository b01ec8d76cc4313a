// The expressions of --paths: which classes of paths count.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// A regular expression over the letters of a path's class, which must match the whole class.
///
///   L D S E   that letter        .        any letter       [DS] [^S]   one of these, none of these
///   a b       a, and then b      a|b      a or b           (a)         brackets
///   a* a+ a?  any number of a, at least one, at most one   a{2} a{2,} a{2,4}   that many
///
/// Reads each letter of a class once, whatever the expression is: it is in many places of the
/// expression at a time, and never goes back.
/// source  Thompson 1968      tested by  "truth: what each sign of a class filter matches"
class ClassFilter {
public:
    /// Throws UsageError, with the column, for what is no such expression.
    explicit ClassFilter(const std::string& expression);

    bool matches(std::string_view path_class) const;
    /// Whether a path can have a class that matches, L(D|S)*E that is.
    bool matches_some_path() const;

private:
    friend class ClassFilterReader;
    /// The way from one place of the expression to another: over one of these letters, or over
    /// none (letters == 0).
    struct Step {
        uint32_t to;
        uint8_t letters;
    };
    using Places = std::vector<bool>;

    Places at_start() const;
    Places after(const Places& places, uint8_t over) const;
    void add(Places& places, uint32_t place) const;

    std::vector<std::vector<Step>> steps_;  // from each place
    uint32_t start_ = 0, end_ = 0;
};

/// The classes that count. Remembers what the filter said of each class.
class ClassSelection {
public:
    /// expression: that of a ClassFilter; empty: all classes count.
    explicit ClassSelection(const std::string& expression);
    bool contains(const std::string& path_class);

private:
    std::optional<ClassFilter> filter_;
    std::map<std::string, bool> known_;
};
