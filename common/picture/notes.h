// Notes in a picture's file about how it was made.
#pragma once
#include "common/picture/film_file.h"

/// Names and values that describe how a picture was made. The same samples give the same notes, so
/// they do not contain numbers of threads, times, folders, or names of outputs.
using Notes = std::vector<std::pair<std::string, std::string>>;

/// The notes of a film's label, with `spp` samples per pixel on average. A label without samples
/// describes a picture that was not sampled.
Notes notes_of(const FilmLabel& label, double spp);

/// A line "NAME VALUE" for each, and back.
std::vector<std::string> lines_of(const Notes& notes);
Notes notes_in(const std::vector<std::string>& lines);

/// The lines as a comment for write_image, below one that says whose notes they are, and back.
/// Empty for a comment by another program.
///
/// tested by  "identity: notes are read from a .ppm and a .png as they were written"
std::string comment_of(const Notes& notes);
Notes notes_in(const std::string& comment);

/// The value of a note; empty where there is none.
std::string value_of(const Notes& notes, const std::string& name);
