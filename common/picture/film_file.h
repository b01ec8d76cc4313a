// Films on disk: the state of a render, to be continued or merged later.
#pragma once
#include <string>

#include "common/base/files.h"
#include "common/picture/film.h"
#include "common/picture/film_label.h"

struct LabeledFilm {
    FilmLabel label;
    Film film;
};

/// The ending of a film's name.
inline constexpr const char* film_ending = ".film";

/// Writes a film: a label in lines of text, the sums as they are in memory, and a checksum of both.
/// The bytes depend on the samples, but not on their order. Throws InputError; the file that was
/// there before stays until the new one is whole.
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
