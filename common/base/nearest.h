// The known word that a mistyped one was probably meant to be.
#pragma once
#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

/// How many letters must be inserted, deleted or replaced to turn a into b.
inline size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (char letter : a) {
        size_t diagonal = row[0]++;
        for (size_t j = 0; j < b.size(); j++) {
            size_t replaced = diagonal + (letter != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({diagonal + 1, row[j] + 1, replaced});
        }
    }
    return row.back();
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
