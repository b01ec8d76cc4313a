// Files that are either wholly written or not touched, and whole files read.
#pragma once
#include <string>
#include <string_view>

/// Writes `bytes` to a new file beside `path` and renames it over `path`: a crash, a full disk or
/// a kill leaves what was there before. A device or pipe is written to directly.
/// Throws InputError when anything fails.
void write_file_atomically(const std::string& path, std::string_view bytes);

/// The whole file; throws InputError when it is missing, a folder, or larger than 4 GiB.
std::string read_file(const std::string& path);
