// Notes in a picture's file about how it was made.
#pragma once
#include "common/picture/film_file.h"

/// Names and values. Where the same samples make the same pixels, the notes are the same too: they
/// do not hold threads, times, folders, or names of outputs.
using Notes = std::vector<std::pair<std::string, std::string>>;

/// What a film is of, with `spp` samples per pixel on average. Without samples it is no film: then
/// they say what a picture shows that has none.
Notes notes_of(const FilmLabel& label, double spp);

/// A line "NAME VALUE" for each, and back.
std::vector<std::string> lines_of(const Notes& notes);
Notes notes_in(const std::vector<std::string>& lines);

/// The lines as a comment for write_image, below one that says whose notes they are, and back.
/// Empty for a comment by another program.
///
/// tested by  "identity: notes are read from a .ppm, a .png and a .json as they were written"
std::string comment_of(const Notes& notes);
Notes notes_in(const std::string& comment);

/// The value of a note; empty where there is none.
std::string value_of(const Notes& notes, const std::string& name);
/// The notes with this value.
Notes with(Notes notes, const std::string& name, const std::string& value);
