// Pictures in memory and on disk: .ppm, .pfm, .png; and files that gzip packed, in the same way as
// .png.
#pragma once
#include <string>
#include <vector>

#include "common/base/vec.h"

/// Linear radiance, row by row from the top left.
struct Image {
    int width = 0, height = 0;
    std::vector<Rgb> pixels;

    Image() = default;
    Image(int w, int h)
        : width(w), height(h), pixels(static_cast<size_t>(w) * static_cast<size_t>(h)) {}
    Rgb& at(int x, int y) {
        return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
    Rgb at(int x, int y) const {
        return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
};

/// One channel as an 8-bit sRGB code; values outside [0,1] (and NaN) are clamped.
unsigned char to_srgb8(float linear);
/// Back to linear, from a code in [0,1]: an sRGB code, or to the power gamma where it is not 0.
float to_linear(float code, float gamma = 0);

/// Writes by extension: .ppm (P6, 8-bit sRGB), .pfm (linear float, little endian, bottom row
/// first), .png (8-bit sRGB). The lines of `comment` are kept in a .ppm and a .png; a .pfm has no
/// place for them. A pixel that is not finite stays so in a .pfm and is magenta in the others.
/// Throws InputError; see files.h.
void write_image(const std::string& path, const Image& image, const std::string& comment);

/// The bytes of a .png, and of a chunk of it, with its length and its checksum.
std::string encode_png(const Image& image, const std::string& comment);
std::string png_chunk(const std::string& kind_and_data);

/// Whether write_image knows the extension of `path`.
bool is_image_path(const std::string& path);

/// Reads a .pfm (one or three channels, either byte order, times its scale); or, back to linear, a
/// .ppm (P6, maxval 255), .png, .jpg or .tga. Throws InputError for anything else, and for a file
/// that is damaged: too short or too long, or, in a .png, with a wrong checksum.
Image read_image(const std::string& path);
/// What read_image reads, from the bytes of the file `path`; gamma: see to_linear().
Image decode_image(const std::string& path, const std::string& bytes, float gamma = 0);
/// The comment that write_image put into a .ppm or .png; empty where there is none.
std::string decode_comment(const std::string& path, const std::string& bytes);

/// What a file holds, be it packed by gzip or not; throws InputError for one that is damaged.
std::string unpack_gzip(const std::string& path, const std::string& bytes);
