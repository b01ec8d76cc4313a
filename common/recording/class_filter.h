// The expressions of --paths, which select classes of paths.
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
/// Reads each letter of a class once, whatever the expression: it follows all possible places of
/// the expression at the same time, and never backtracks.
/// source  Thompson 1968      tested by  "truth: what each sign of a class filter matches"
class ClassFilter {
public:
    /// Throws UsageError, with the column, for an invalid expression.
    explicit ClassFilter(const std::string& expression);

    bool matches(std::string_view path_class) const;
    /// Whether any class of paths, L(D|S)*E, matches.
    bool matches_some_path() const;

private:
    friend class ClassFilterReader;
    /// A transition from one place of the expression to another: it reads one of these letters, or
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

/// The classes that are selected. Caches the answer of the filter for each class.
class ClassSelection {
public:
    /// expression: that of a ClassFilter; empty: all classes count.
    explicit ClassSelection(const std::string& expression);
    bool contains(const std::string& path_class);

private:
    std::optional<ClassFilter> filter_;
    std::map<std::string, bool> known_;
};
