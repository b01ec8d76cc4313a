// The .png format, and others that are only read, for image.h; and what gzip packs, in the same
// way.
#pragma once
#include "common/picture/image.h"

/// Whether a file is packed by gzip.
bool is_gzip(std::string_view bytes);

/// What such a file holds; throws InputError for one that is damaged.
std::string unpack_gzip(const std::string& path, const std::string& bytes);

bool is_png(const std::string& bytes);

/// A picture of 8-bit sRGB codes, row by row, three for each pixel; `comment` in a text chunk.
std::string encode_png(int width, int height, const std::string& codes, const std::string& comment);

/// Reads any kind of .png: grey, with a palette, of 16 bits; transparency is left out. Throws
/// InputError where a chunk does not have its checksum, or is missing.
Image decode_png(const std::string& path, const std::string& bytes, float gamma = 0);

bool is_jpg(const std::string& bytes);

/// Reads a .jpg or .tga picture. Throws InputError for one that is damaged, as far as that can be
/// seen: they have no checksums.
Image decode_jpg_or_tga(const std::string& path, const std::string& bytes, float gamma);

/// A chunk of a file, with its length and its checksum.
std::string png_chunk(const std::string& kind_and_data);

/// The text of the first comment; empty where there is none. Throws as decode_png does.
std::string png_comment(const std::string& path, const std::string& bytes);
