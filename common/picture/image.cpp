#include "common/picture/image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/text.h"

/// The most bytes that stb may ask for at once: a small file can be made to unpack to gigabytes.
static thread_local size_t most_memory = 0;

static void* limited_realloc(void* old, size_t size) {
    return size > most_memory ? nullptr : std::realloc(old, size);
}

#pragma GCC diagnostic push  // stb is not written for our warnings
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MALLOC(size) limited_realloc(nullptr, size)
#define STBI_REALLOC limited_realloc
#define STBI_FREE std::free
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

static_assert(std::endian::native == std::endian::little, "pfm rows are written as they lie");

// In double, then rounded: the same with every library.
static float power(float x, float y) { return static_cast<float>(std::pow(double{x}, double{y})); }

unsigned char to_srgb8(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    float code = linear <= 0.0031308f ? 12.92f * linear : 1.055f * power(linear, 1 / 2.4f) - 0.055f;
    return static_cast<unsigned char>(255 * code + 0.5f);
}

float to_linear(float code, float gamma) {
    if (gamma != 0) return power(code, gamma);
    return code <= 0.04045f ? code / 12.92f : power((code + 0.055f) / 1.055f, 2.4f);
}

namespace {

constexpr size_t most_bytes = size_t{1} << 30;
constexpr int most_pixels = 1 << 28;
constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
constexpr std::string_view comment_key = {"Comment\0", 8};
// What is said of all that is wrong with a picture.
constexpr const char* not_read =
    "not a .ppm (P6, maxval 255), .pfm, .png, .jpg or .tga picture of 1 to 2^28 pixels, or damaged";
constexpr const char* not_whole = "the picture is cut short, too long, or damaged";

uint32_t crc32(std::string_view bytes) {
    auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    return stbiw__crc32(const_cast<unsigned char*>(data), static_cast<int>(bytes.size()));
}

std::string big_endian(size_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

/// The number in some bytes, the highest first; 0 for those behind the end.
size_t big_endian_at(std::string_view bytes, size_t at, size_t count) {
    size_t value = 0;
    for (size_t i = at; i < at + count; i++)
        value = value << 8 | (i < bytes.size() ? static_cast<uint8_t>(bytes[i]) : 0u);
    return value;
}
size_t byte_at(std::string_view bytes, size_t at) { return big_endian_at(bytes, at, 1); }

/// Whether a .jpg file has a Huffman table of more than 256 codes: stb has no room for more.
bool has_large_table(std::string_view file) {
    constexpr size_t tables = 0xc4, end_of_picture = 0xd9;
    for (size_t at = 2; (at = file.find('\xff', at)) < file.size();) {
        size_t marker = byte_at(file, at + 1), end = at + 2 + big_endian_at(file, at + 2, 2);
        if (marker == end_of_picture) return false;
        for (size_t table = at + 4; marker == tables && table < end;) {
            size_t codes = 0;
            for (size_t i = 1; i <= 16; i++) codes += byte_at(file, table + i);
            if (codes > 256) return true;
            table += 17 + codes;
        }
        // Fill bytes, pixels that are FF, and restarts are followed by no segment.
        bool has_segment = marker > 1 && marker != 0xff && (marker < 0xd0 || marker > 0xd8);
        at = has_segment ? end : at + (marker == 0xff ? 1 : 2);
    }
    return false;
}

bool is_jpg(std::string_view bytes) { return bytes.starts_with("\xff\xd8\xff"); }

/// The text of the first comment of a .png; empty where there is none. Throws InputError where a
/// chunk does not have its checksum, or is missing.
std::string png_comment(const std::string& path, std::string_view bytes) {
    std::string comment;
    std::string_view kind;
    for (size_t at = signature.size(); kind != "IEND";) {
        size_t length = big_endian_at(bytes, at, 4);
        if (bytes.size() - at < 12 || length > bytes.size() - at - 12) fail({path}, not_whole);
        kind = bytes.substr(at + 4, 4);
        std::string_view data = bytes.substr(at + 8, length);
        if (crc32(bytes.substr(at + 4, 4 + length)) != big_endian_at(bytes, at + 8 + length, 4))
            fail({path}, not_whole);
        // The colors of the first are in another order; stb copies the second to nowhere.
        if (kind == "CgBI" || (kind == "IDAT" && data.empty())) fail({path}, not_read);
        if (comment.empty() && kind == "tEXt" && data.starts_with(comment_key))
            comment = data.substr(comment_key.size());
        at += 12 + length;
    }
    return comment;
}

/// The linear values of `count` codes.
std::vector<float> linear_codes(size_t count, float gamma) {
    std::vector<float> linear;
    for (size_t i = 0; i < count; i++)
        linear.push_back(to_linear(static_cast<float>(i) / static_cast<float>(count - 1), gamma));
    return linear;
}

/// Any kind of .png (grey, with a palette, of 16 bits; transparency is left out), a .jpg or a .tga.
Image decode_by_stb(const std::string& path, const std::string& bytes, float gamma) {
    if (bytes.starts_with(signature)) png_comment(path, bytes);  // checks it
    // stb makes up what a file lacks. Behind this one there is more than it takes at once (a row of
    // 65535 pixels), so that it is seen to go on there.
    const std::string padded = bytes + std::string(1 << 18, '\0');
    auto* start = reinterpret_cast<const unsigned char*>(padded.data());
    int size = static_cast<int>(padded.size()), width = 0, height = 0, channels = 0;
    constexpr int64_t most = 1032;  // times smaller is what the .png format can make of it
    most_memory = 1 << 16;
    if ((is_jpg(bytes) && has_large_table(bytes)) ||
        !stbi_info_from_memory(start, size, &width, &height, &channels) ||
        int64_t{width} * height > std::min<int64_t>(most_pixels, 8 * most * ssize(bytes)))
        fail({path}, not_read);
    Image image(width, height);
    most_memory += 2 * bytes.size() + 32 * image.pixels.size();
    stbi__context context = {};
    stbi__start_mem(&context, start, size);
    // With 16 bits for all: 257 times a code of 8 bits, of 65535, is the same float.
    std::unique_ptr<uint16_t, void (*)(void*)> codes(
        stbi__load_and_postprocess_16bit(&context, &width, &height, &channels, STBI_rgb),
        std::free);
    if (!codes || context.img_buffer > start + bytes.size()) fail({path}, not_whole);
    const std::vector<float> linear = linear_codes(65536, gamma);
    for (size_t i = 0; i < image.pixels.size(); i++) {
        const uint16_t* code = codes.get() + 3 * i;
        image.pixels[i] = {linear[code[0]], linear[code[1]], linear[code[2]]};
    }
    return image;
}

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
    return bytes + format("%d %d\n255\n", image.width, image.height) + srgb_bytes(image);
}

std::string encode_pfm(const Image& image) {
    std::string bytes = format("PF\n%d %d\n-1.0\n", image.width, image.height);
    size_t row = static_cast<size_t>(image.width);
    for (size_t y = static_cast<size_t>(image.height); y-- > 0;) {
        bytes.append(reinterpret_cast<const char*>(&image.pixels[y * row]), row * sizeof(Rgb));
    }
    return bytes;
}

/// The scale of a .pfm: its sign is the order of bytes; its magnitude multiplies all values, as in
/// pbrt.
Image decode_ppm_or_pfm(const std::string& path, const std::string& bytes, float gamma) {
    std::istringstream header(bytes);
    std::string kind, comment;
    int width = 0, height = 0;
    float scale = 0;  // or the largest code
    header >> kind;
    while ((header >> std::ws).peek() == '#') std::getline(header, comment);
    header >> width >> height >> scale;
    bool is_ppm = kind == "P6", is_grey = kind == "Pf";
    bool is_read = is_ppm ? scale == 255 : scale != 0 && (is_grey || kind == "PF");
    if (!is_read || std::min(width, height) < 1 || int64_t{width} * height > most_pixels)
        fail({path}, not_read);

    // One blank ends the header.
    size_t channels = is_grey ? 1 : 3,
           values = channels * static_cast<size_t>(width) * static_cast<size_t>(height),
           size = values * (is_ppm ? 1 : 4);
    std::string_view body = bytes;
    body.remove_prefix(std::min(static_cast<size_t>(header.tellg()), bytes.size()));
    if (body.size() != size + 1) fail({path}, not_whole);
    body.remove_prefix(1);

    const std::vector<float> linear = linear_codes(256, gamma);
    auto value = [&](size_t i) {
        if (is_ppm) return linear[static_cast<unsigned char>(body[i])];
        uint32_t bits;
        std::memcpy(&bits, body.data() + 4 * i, 4);
        return std::bit_cast<float>(scale < 0 ? bits : __builtin_bswap32(bits)) * std::abs(scale);
    };
    Image image(width, height);
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

std::string png_chunk(const std::string& kind_and_data) {
    return big_endian(kind_and_data.size() - 4) + kind_and_data + big_endian(crc32(kind_and_data));
}

std::string unpack_gzip(const std::string& path, const std::string& bytes) {
    if (!bytes.starts_with("\x1f\x8b")) return bytes;
    constexpr size_t most = 1032, room = 1 << 14;  // times larger; what stb asks for at first
    most_memory = std::min(most_bytes, room + 2 * most * bytes.size());
    // Ten bytes, then the name of the file where a bit of the fourth says so.
    size_t header = byte_at(bytes, 3) & 8 ? bytes.find('\0', 10) + 1 : 10;
    header = std::min(std::max(header, size_t{10}), bytes.size());
    int size = 0;
    // stb looks at a few bytes behind the data, and so is given the rest of the file too.
    std::unique_ptr<char, void (*)(void*)> unpacked(
        stbi_zlib_decode_noheader_malloc(bytes.data() + header,
                                         static_cast<int>(bytes.size() - header), &size),
        std::free);
    std::string_view data(unpacked.get(), static_cast<size_t>(size));
    std::string sums = big_endian(data.size()) + big_endian(crc32(data));
    std::reverse(sums.begin(), sums.end());  // the lowest byte comes first
    if (!unpacked || !bytes.ends_with(sums))
        fail({path}, "damaged, cut short, or larger than 1 GB: packed by gzip");
    return std::string(data);
}

bool is_image_path(const std::string& path) {
    return has_ending(path, ".ppm") || has_ending(path, ".pfm") || has_ending(path, ".png");
}

std::string encode_png(const Image& image, const std::string& comment) {
    std::string png, codes = srgb_bytes(image);
    auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<char*>(data), static_cast<size_t>(size));
    };
    if (!stbi_write_png_to_func(append, &png, image.width, image.height, 3, codes.data(),
                                3 * image.width))
        throw std::bad_alloc();
    constexpr size_t after_header = signature.size() + 25;  // IHDR
    return png.insert(after_header, png_chunk("tEXt" + std::string(comment_key) + ascii(comment)));
}

void write_image(const std::string& path, const Image& image, const std::string& comment) {
    if (has_ending(path, ".ppm")) return write_file_atomically(path, encode_ppm(image, comment));
    if (has_ending(path, ".pfm")) return write_file_atomically(path, encode_pfm(image));
    if (has_ending(path, ".png")) return write_file_atomically(path, encode_png(image, comment));
    fail({path}, "a picture's name must end in .ppm, .pfm or .png");
}

Image read_image(const std::string& path) { return decode_image(path, read_file(path)); }

Image decode_image(const std::string& path, const std::string& bytes, float gamma) {
    if (bytes.starts_with(signature) || is_jpg(bytes) || has_ending(path, ".tga"))
        return decode_by_stb(path, bytes, gamma);
    if (bytes.starts_with("\x76\x2f\x31\x01"))
        fail({path}, "an .exr picture: imgtool, a program of pbrt, converts it to .pfm");
    return decode_ppm_or_pfm(path, bytes, gamma);
}

std::string decode_comment(const std::string& path, const std::string& bytes) {
    if (bytes.starts_with(signature)) return png_comment(path, bytes);
    std::istringstream lines(bytes);
    std::string line, comment;
    std::getline(lines, line);  // P6
    while (std::getline(lines, line) && line.starts_with("# ")) comment += line.substr(2) + '\n';
    return comment;
}
