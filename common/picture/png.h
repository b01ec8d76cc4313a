// What stb reads and writes: .png, .jpg and .tga pictures; and what gzip packs, in the same way as
// .png.
#pragma once
#include "common/picture/image.h"

/// Whether a file is packed by gzip.
bool is_gzip(std::string_view bytes);

/// What such a file holds; throws InputError for one that is damaged.
std::string unpack_gzip(const std::string& path, const std::string& bytes);

bool is_png(const std::string& bytes);
bool is_jpg(const std::string& bytes);

/// A picture of 8-bit sRGB codes, row by row, three for each pixel; `comment` in a text chunk.
std::string encode_png(int width, int height, const std::string& codes, const std::string& comment);

/// Reads any kind of .png (grey, with a palette, of 16 bits; transparency is left out), a .jpg or a
/// .tga. Throws InputError for one that is cut short or damaged: a .png by its checksums, others as
/// far as that can be seen.
Image decode_by_stb(const std::string& path, const std::string& bytes, float gamma);

/// A chunk of a .png, with its length and its checksum.
std::string png_chunk(const std::string& kind_and_data);

/// The text of the first comment of a .png; empty where there is none. Throws InputError where a
/// chunk does not have its checksum, or is missing.
std::string png_comment(const std::string& path, std::string_view bytes);
