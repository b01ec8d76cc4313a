// Which code a chapter's program was compiled from.
#pragma once
#include <string>

/// A hash of the files in the chapter's folder and in common/: the same on all machines, and
/// different after any change. Empty if there is no such chapter. tested by  "teeth: the hash of a
/// chapter's code changes with any file of it, and of no other chapter"
std::string code_hash(const std::string& chapter);
