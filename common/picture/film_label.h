// The label of a film: its options, samples and counts, as a value and as text.
#pragma once
#include <compare>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/picture/film.h"

/// Samples number first to last - 1 of each pixel, with the random numbers of a seed.
struct SampleRange {
    uint32_t seed = 0, first = 0, last = 0;
    auto operator<=>(const SampleRange&) const = default;  // NOLINT(*-use-nullptr): version 14
};

/// "samples 3 to 7 of seed 0".
std::string text_of(const SampleRange& range);

/// How many samples of a pixel a render of this seed takes, in so many parts.
struct Goal {
    uint32_t seed = 0, samples = 0, parts = 1;
    auto operator<=>(const Goal&) const = default;  // NOLINT(*-use-nullptr): version 14

    /// The first sample of a part. Parts count from 1.
    uint32_t first_of(int part) const {
        return static_cast<uint32_t>(uint64_t{samples} * static_cast<uint32_t>(part - 1) / parts);
    }
    /// The part that takes this sample.
    uint32_t part_of(uint32_t sample) const {
        return static_cast<uint32_t>(((uint64_t{sample} + 1) * parts - 1) / samples + 1);
    }
};

/// Counts besides the sums. Those of two sets of samples add up.
struct SampleCounts {
    uint64_t rays = 0;
    uint64_t paths_cut = 0;                   // ended by the depth limit
    uint64_t photons = 0, inner_photons = 0;  // that were gathered; in the inner half of a disk
    uint64_t not_finite = 0;  // samples that were NaN or infinite, as their pixels are then
    uint32_t bad_seed = 0;    // the first of those
    int bad_sample = 0, bad_y = 0, bad_x = 0;
    double largest = 0;  // the largest sample (average of the channels)

    void add_not_finite(uint32_t seed, int sample, int y, int x);
    void add(const SampleCounts& other);
};

/// The label of a film. Two films can be added if their options are equal, and no sample is in
/// both.
struct FilmLabel {
    std::vector<std::pair<std::string, std::string>> options;  // names and values, all that matter
    std::vector<SampleRange> samples;                          // sorted, none touches the next
    std::vector<Goal> goals;  // sorted, one for each seed; none for a seed that has reached its own
    SampleCounts counts;

    /// Leaves each seed its largest goal alone, and none when all its samples are there.
    void keep_open_goals();
    /// Adds samples and counts. Throws InputError, and leaves all as it was, when a sample is in
    /// both: `path` is the file that `other` is from.
    void add(const FilmLabel& other, const std::string& path);
    /// The samples that are missing, and the parts that they belong to: a line for each gap.
    std::vector<std::string> missing() const;
};

/// The properties that decide which sums a film has.
struct FilmShape {
    int width = 0, height = 0;
    int kind = 0;  // 0: pixels alone; 1: with audits; 2: with a second half of each; 3: with
                   // batches; 4: with batches and audits
    bool takes_splats = false;
    bool has_audits() const { return kind == 1 || kind == 4; }
    bool has_batches() const { return kind >= 3; }
    bool operator==(const FilmShape&) const = default;
};
FilmShape shape_of(const Film& film);

/// The line that a film's file begins with, and what of it is the same in all versions.
inline constexpr const char* film_version = "film of path-by-path, version 6\n";
inline constexpr const char* film_any_version = "film of path-by-path, version ";

/// The lines of text at the beginning of a film's file, with the empty one that ends them.
std::string label_text(const FilmLabel& label, const FilmShape& shape);

/// The reverse of label_text(). Throws InputError for all that label_text() does not write; `path`
/// is the file that the text is from.
std::pair<FilmLabel, FilmShape> parse_label(const std::string& path, const std::string& text);
