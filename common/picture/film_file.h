// Films on disk: what a render has done so far, and what it takes to go on or to be merged.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "common/picture/film.h"

/// Samples number first to last - 1 of each pixel, made of the random numbers of a seed.
struct SampleRange {
    uint32_t seed = 0, first = 0, last = 0;
    auto operator<=>(const SampleRange&) const = default;
};

/// What is counted beside the sums. The counts of two sets of samples add up.
struct SampleCounts {
    uint64_t rays = 0;
    uint64_t paths_cut = 0;   // ended by the depth limit
    uint64_t not_finite = 0;  // samples that were NaN or infinite, as their pixels are then
    uint32_t bad_seed = 0;    // the first of those
    int bad_sample = 0, bad_y = 0, bad_x = 0;
    double largest = 0;  // the largest sample (average of the channels)

    void add_not_finite(uint32_t seed, int sample, int y, int x);
    void add(const SampleCounts& other);
};

/// What a film is of: two films can be added when their options are the same, and their samples
/// are not.
struct FilmLabel {
    std::vector<std::pair<std::string, std::string>> options;  // names and values, all that matter
    std::vector<SampleRange> samples;                          // sorted, none touches the next
    SampleCounts counts;
};

struct LabeledFilm {
    FilmLabel label;
    Film film;
};

/// The ending of a film's name.
inline constexpr const char* film_ending = ".film";

/// Writes a film: lines of text that say what it is of, the sums as they lie in memory, and a
/// checksum over all. The same bytes for the same samples, in whatever order they came. Throws
/// InputError; the file that was there before stays until the new one is whole and on the disk.
void write_film(const std::string& path, const FilmLabel& label, const Film& film);

/// Reads a film. Throws InputError, one line, for a file that is cut short, damaged in any bit, or
/// no film.
LabeledFilm read_film(const std::string& path);

/// Throws InputError, a line that names the first difference, when the film read from `path` is of
/// other options than these.
void check_options(const std::string& path, const FilmLabel& label,
                   const std::vector<std::pair<std::string, std::string>>& options);

/// Adds the film read from `path` to another. Throws InputError, and leaves `sum` as it was, when
/// its options are others, or a sample is in both.
/// tested by  "identity: films of parts, added in any order, have the bytes of the whole"
void add_film(LabeledFilm& sum, const std::string& path, const LabeledFilm& part);
