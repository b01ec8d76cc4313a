// The known word that a mistyped one was probably meant to be.
#pragma once
#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

/// How many letters must be inserted, deleted, replaced or swapped to turn a into b.
inline size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> above(b.size() + 1), row(b.size() + 1), before(b.size() + 1);
    std::iota(above.begin(), above.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); i++) {
        row[0] = i;
        for (size_t j = 1; j <= b.size(); j++) {
            row[j] =
                std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
            bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, above);
        std::swap(above, row);
    }
    return above[b.size()];
}

/// The known word nearest to `word`; empty when none is closer than half its length. Only the first
/// 64 letters of the word and the first 10,000 known words count, since longer searches take
/// seconds.
inline std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
    constexpr size_t longest = 64, most = 10'000;
    word = word.substr(0, longest);
    std::string nearest;
    size_t best = word.size() / 2 + 1;
    for (size_t i = 0; i < std::min(known.size(), most); i++) {
        const std::string& candidate = known[i];
        if (candidate.size() >= word.size() + best) continue;  // as many letters to insert
        size_t distance = edit_distance(word, candidate);
        if (distance < best) {
            best = distance;
            nearest = candidate;
        }
    }
    return nearest;
}
