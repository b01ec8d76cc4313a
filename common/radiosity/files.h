// A radiosity solution on disk: to go on from, and to walk through.
#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "common/base/files.h"
#include "common/radiosity/display.h"

/// The numbers of a solution, piece by piece, as they lie in memory.
using Pieces = std::vector<std::span<std::byte>>;

/// Writes label, numbers, checksum. Throws InputError.
/// label: lines that say what the solution is of, the last one empty.
void save_numbers(const std::string& path, const std::string& label, const Pieces& numbers,
                  FileLock* lock = nullptr);

/// Reads as many numbers as there is room for. Throws InputError for what is of something else, or
/// damaged.
/// tested by  "input: a film of radiosity of something else, or damaged, is refused"
void read_numbers(const std::string& path, const std::string& label, const Pieces& numbers);

/// Writes triangles with their radiosity at each corner, W m^-2, as a mesh whose colours are the
/// radiance: .ply, binary, sRGB. Throws InputError.
/// tested by  "files: radiosity says its costs first, writes pictures on the way, and a mesh"
void write_mesh(const std::string& path, const Triangles& triangles, const CornerColours& B);
