// The expressions of --paths, which select classes of paths.
#pragma once
#include <map>
#include <string>
#include <string_view>

/// A regular expression over the letters of a path's class, which must match the whole class.
///
///   L D S E   that letter        .        any letter       [DS] [^S]   one of these, none of these
///   a b       a, and then b      a|b      a or b           (a)         brackets
///   a* a+ a?  any number of a, at least one, at most one   a{2} a{2,} a{2,4}   that many
///
/// tested by  "truth: what each sign of a class filter matches"
class ClassFilter {
public:
    /// Throws UsageError, with the column, for an invalid expression.
    explicit ClassFilter(const std::string& expression);

    bool matches(std::string_view path_class) const;
    /// Whether any class of paths, L(D|S)*E, matches.
    bool matches_some_path() const;

private:
    std::string expression_;
};

/// The classes that are selected. Caches the answer of the filter for each class.
class ClassSelection {
public:
    /// expression: that of a ClassFilter; empty: all classes count.
    explicit ClassSelection(const std::string& expression)
        : filter_(expression.empty() ? ".*" : expression) {}
    bool contains(const std::string& path_class);

private:
    ClassFilter filter_;
    std::map<std::string, bool> known_;
};
