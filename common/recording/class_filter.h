// The expressions of --paths, which select classes of paths.
#pragma once
#include <map>
#include <string>

/// A regular expression over the letters of a path's class, which must match the whole class.
///
///   L D S E   that letter            .     any letter          a|b   a or b
///   a* a+ a?  any number of a, at least one, at most one       (a)   brackets
///
/// tested by  "truth: what each sign of a class filter matches"
class ClassFilter {
public:
    /// Empty: all classes match. Throws UsageError, with the column, for an invalid expression.
    explicit ClassFilter(const std::string& expression);

    /// Remembers the answers.
    bool matches(const std::string& path_class);

private:
    std::string expression_;
    std::map<std::string, bool> known_;
};
