// A radiosity solution on disk: to go on from, and to walk through.
#pragma once
#include <string>

#include "common/radiosity/display.h"
#include "common/radiosity/solution.h"

/// Writes the state of the shots: label, numbers, checksum. Throws InputError.
/// label: lines that say what the solution is of, the last one empty.
void save_solution(const std::string& path, const std::string& label, const Solution& s);

/// Reads it into a solution of as many patches. Throws InputError for what is of something else, or
/// damaged.
/// tested by  "input: a film of radiosity of something else, or damaged, is refused"
void read_solution(const std::string& path, const std::string& label, Solution& s);

/// Writes the patches as a mesh with a colour at each corner: .ply, binary, sRGB. Throws
/// InputError. tested by  "files: radiosity says its costs first, writes pictures on the way, and a
/// mesh"
void write_mesh(const std::string& path, const std::vector<Patch>& patch, const CornerB& B);
