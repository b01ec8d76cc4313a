// Films on disk: the state of a render, to be continued or merged later, with a label of its
// options, samples and counts; and the notes of a picture about how it was made.
#pragma once
#include <compare>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/picture/film.h"

/// Names and values that describe how a picture was made. The same samples give the same notes, so
/// they do not contain numbers of threads, times, folders, or names of outputs.
using Notes = std::vector<std::pair<std::string, std::string>>;

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

/// A sample of a picture.
struct SampleAt {
    uint32_t seed = 0;
    int y = 0, x = 0, number = 0;
    auto operator<=>(const SampleAt&) const = default;  // NOLINT(*-use-nullptr): version 14

    /// "X,Y,NUMBER", as --explain takes them.
    std::string text() const;
};

/// Counts besides the sums. Those of two sets of samples add up.
struct SampleCounts {
    uint64_t rays = 0;
    uint64_t paths_cut = 0;                   // ended by the depth limit
    uint64_t photons = 0, inner_photons = 0;  // that were gathered; in the inner half of a disk
    uint64_t not_finite = 0;  // samples that were NaN or infinite, as their pixels are then
    SampleAt bad;             // the first of those
    double largest = 0;       // the largest sample (average of the channels)

    void add_not_finite(SampleAt at) { bad = not_finite++ == 0 ? at : std::min(bad, at); }
    void add(const SampleCounts& other);
};

/// The label of a film. Two films can be added if their options are equal, and no sample is in
/// both.
struct FilmLabel {
    Notes options;                     // all that matter
    std::vector<SampleRange> samples;  // sorted, none touches the next
    std::vector<Goal> goals;  // sorted, one for each seed; none for a seed that has reached its own
    SampleCounts counts;

    /// Leaves each seed its largest goal alone, and none when all its samples are there.
    void keep_open_goals();
    /// The samples that are missing, and the parts that they belong to: a line for each gap.
    std::vector<std::string> missing() const;
};

/// The notes of a picture with this label, with `spp` samples per pixel on average. A label without
/// samples describes a picture that was not sampled.
Notes notes_of(const FilmLabel& label, double spp);

/// A line "NAME VALUE" for each.
std::vector<std::string> lines_of(const Notes& notes);

/// The lines as a comment for write_image, below one that says whose notes they are, and back.
/// Empty for a comment by another program.
///
/// tested by  "identity: notes are read from a .ppm and a .png as they were written"
std::string comment_of(const Notes& notes);
Notes notes_in(const std::string& comment);

struct LabeledFilm {
    FilmLabel label;
    Film film;
};

/// The ending of a film's name.
inline constexpr const char* film_ending = ".film";

/// Writes a film: its options in lines of text, all else as it is in memory, and a checksum. The
/// bytes depend on the samples, but not on their order. Throws InputError; the file that was there
/// before stays until the new one is whole.
void write_film(const std::string& path, const FilmLabel& label, const Film& film);

/// Throws InputError for a pipe or a device: a film is read before it is written again.
void check_film_is_file(const std::string& path);

/// Reads a film. Throws InputError, one line, for a file that is cut short, damaged in any bit, or
/// no film.
LabeledFilm read_film(const std::string& path);

/// Throws InputError, a line that names the first difference, when the film read from `path` is of
/// other options than these.
void check_options(const std::string& path, const FilmLabel& label, const Notes& options);

/// Throws InputError when the sums of the film read from `path` cannot be added to those of `sum`.
void check_sums(const std::string& path, const Film& film, const Film& sum);

/// Adds the film read from `path` to another. Throws InputError, and leaves `sum` as it was, when
/// its options are others, or a sample is in both.
/// tested by  "identity: films of parts, added in any order, have the bytes of the whole"
void add_film(LabeledFilm& sum, const std::string& path, const LabeledFilm& part);
