// Notes in a picture's file about how it was made.
#pragma once
#include <string>
#include <utility>
#include <vector>

/// Names and values that describe how a picture was made. The same samples give the same notes, so
/// they do not contain numbers of threads, times, folders, or names of outputs.
using Notes = std::vector<std::pair<std::string, std::string>>;

/// A line "NAME VALUE" for each.
std::vector<std::string> lines_of(const Notes& notes);

/// The lines as a comment for write_image, below one that says whose notes they are, and back.
/// Empty for a comment by another program.
///
/// tested by  "identity: notes are read from a .ppm and a .png as they were written"
std::string comment_of(const Notes& notes);
Notes notes_in(const std::string& comment);

/// The value of a note; empty where there is none.
std::string value_of(const Notes& notes, const std::string& name);
