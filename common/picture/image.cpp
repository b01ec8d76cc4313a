#include "common/picture/image.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>

#include "common/base/files.h"
#include "common/base/position.h"
#include "common/picture/png.h"

static_assert(std::endian::native == std::endian::little, "pfm rows are written as they lie");

// In double, then rounded: the same with every library.
static float power(float x, float y) { return static_cast<float>(std::pow(double{x}, double{y})); }

unsigned char to_srgb8(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    float code = linear <= 0.0031308f ? 12.92f * linear : 1.055f * power(linear, 1 / 2.4f) - 0.055f;
    return static_cast<unsigned char>(255 * code + 0.5f);
}

float from_srgb(float code) {
    return code <= 0.04045f ? code / 12.92f : power((code + 0.055f) / 1.055f, 2.4f);
}

namespace {

// The colour of pixels that are not finite, in formats that cannot store them: magenta.
constexpr Rgb not_a_color = {1, 0, 1};

std::string srgb_bytes(const Image& image) {
    std::string bytes;
    bytes.reserve(3 * image.pixels.size());
    for (Rgb p : image.pixels) {
        if (!is_finite(p)) p = not_a_color;
        for (float channel : {p.r, p.g, p.b}) bytes += static_cast<char>(to_srgb8(channel));
    }
    return bytes;
}

/// Lines of letters that every format can keep; anything else is '?'.
std::string ascii(std::string comment) {
    for (char& c : comment) c = c == '\n' || (c >= 32 && c < 127) ? c : '?';
    return comment;
}

std::string encode_ppm(const Image& image, const std::string& comment) {
    std::string bytes = "P6\n";
    std::istringstream lines(ascii(comment));
    for (std::string line; std::getline(lines, line);) bytes += "# " + line + '\n';
    return bytes + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n" +
           srgb_bytes(image);
}

std::string encode_pfm(const Image& image) {
    std::string bytes =
        "PF\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n";
    size_t row = static_cast<size_t>(image.width);
    for (size_t y = static_cast<size_t>(image.height); y-- > 0;) {
        bytes.append(reinterpret_cast<const char*>(&image.pixels[y * row]), row * sizeof(Rgb));
    }
    return bytes;
}

/// What a .ppm or .pfm file begins with.
struct Header {
    std::string kind, comment;  // with the ends of its lines
    int width = 0, height = 0;
    double scale = 0;  // or the largest code
    size_t size = 0;   // bytes, up to the blank that ends it
};

/// Reads as much of it as there is.
Header header_of(const std::string& bytes) {
    Header header;
    std::istringstream text(bytes);
    text >> header.kind;
    for (std::string line; (text >> std::ws).peek() == '#' && std::getline(text, line);)
        header.comment += line.substr(std::min<size_t>(2, line.size())) + '\n';
    text >> header.width >> header.height >> header.scale;
    header.size = std::min(static_cast<size_t>(text.tellg()), bytes.size());
    return header;
}

/// The scale of a .pfm: its sign is the order of bytes; its magnitude multiplies all values, as in
/// pbrt.
Image decode_ppm_or_pfm(const std::string& path, const std::string& bytes, float gamma) {
    Header header = header_of(bytes);
    bool is_ppm = header.kind == "P6", is_grey = header.kind == "Pf";
    if (!is_ppm && !is_grey && header.kind != "PF")
        fail({path}, "not a .ppm (P6), .pfm, .png, .jpg or .tga picture");
    bool fits = std::min(header.width, header.height) > 0 &&
                int64_t{header.width} * header.height <= most_pixels;
    if (!fits) fail({path}, "a picture must have from 1 to 2^28 pixels");
    float scale = static_cast<float>(header.scale);
    if (is_ppm && scale != 255) fail({path}, "only 8-bit .ppm files (maxval 255) are read");
    if (!std::isfinite(scale) || scale == 0)
        fail({path}, "a .pfm file's scale must be a finite number other than 0");

    // One blank ends the header, or CR LF where the file then has the right size.
    size_t pixels = static_cast<size_t>(header.width) * static_cast<size_t>(header.height);
    size_t channels = is_grey ? 1 : 3, size = channels * pixels * (is_ppm ? 1 : 4);
    std::string_view body = std::string_view(bytes).substr(header.size);
    if (body.starts_with("\r\n") && body.size() == size + 2) body.remove_prefix(1);
    if (body.size() != size + 1) fail({path}, "the picture is cut short, or too long");
    body.remove_prefix(1);

    std::array<float, 256> linear;
    for (size_t i = 0; i < 256; i++) linear[i] = to_linear(static_cast<float>(i) / 255, gamma);
    auto value = [&](size_t i) {
        if (is_ppm) return linear[static_cast<unsigned char>(body[i])];
        uint32_t bits;
        std::memcpy(&bits, body.data() + 4 * i, 4);
        return std::bit_cast<float>(scale < 0 ? bits : __builtin_bswap32(bits)) * std::abs(scale);
    };
    Image image(header.width, header.height);
    size_t at = 0;
    for (int row = 0; row < image.height; row++) {
        for (int x = 0; x < image.width; x++, at += channels) {
            image.at(x, is_ppm ? row : image.height - 1 - row) = {
                value(at), value(is_grey ? at : at + 1), value(is_grey ? at : at + 2)};
        }
    }
    return image;
}

}  // namespace

bool is_image_path(const std::string& path) {
    return has_ending(path, ".ppm") || has_ending(path, ".pfm") || has_ending(path, ".png");
}

std::string encode_png(const Image& image, const std::string& comment) {
    return encode_png(image.width, image.height, srgb_bytes(image), ascii(comment));
}

void write_image(const std::string& path, const Image& image, const std::string& comment) {
    if (has_ending(path, ".ppm")) return write_file_atomically(path, encode_ppm(image, comment));
    if (has_ending(path, ".pfm")) return write_file_atomically(path, encode_pfm(image));
    if (has_ending(path, ".png")) return write_file_atomically(path, encode_png(image, comment));
    fail({path}, "a picture's name must end in .ppm, .pfm or .png");
}

Image read_image(const std::string& path) { return decode_image(path, read_file(path)); }

Image decode_image(const std::string& path, const std::string& bytes, float gamma) {
    if (is_png(bytes) || is_jpg(bytes) || has_ending(path, ".tga"))
        return decode_by_stb(path, bytes, gamma);
    if (bytes.starts_with("\x76\x2f\x31\x01"))
        fail({path}, "an .exr picture: imgtool, a program of pbrt, converts it to .pfm");
    return decode_ppm_or_pfm(path, bytes, gamma);
}

std::string decode_comment(const std::string& path, const std::string& bytes) {
    if (is_png(bytes)) return png_comment(path, bytes);
    return bytes.starts_with("P6") ? header_of(bytes).comment : "";
}
