#include "common/picture/image.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "common/base/files.h"
#include "common/base/position.h"

#pragma GCC diagnostic push  // stb is not written for our warnings
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
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

namespace {

float from_srgb8(unsigned char byte) {
    float code = static_cast<float>(byte) / 255;
    return code <= 0.04045f ? code / 12.92f : power((code + 0.055f) / 1.055f, 2.4f);
}

std::string extension(const std::string& path) {
    size_t dot = path.find_last_of("./");
    return dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot);
}

// What a pixel that is not finite looks like where it cannot be written as it is: magenta.
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

std::string encode_ppm(const Image& image) {
    return "P6\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n" +
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

uint32_t crc32(std::string_view bytes) {
    uint32_t crc = ~0u;
    for (char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; bit++) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

std::string big_endian(size_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

// A tEXt chunk may hold Latin-1 without NUL; anything else is written as '?'.
std::string text_chunk(const std::string& comment) {
    std::string body = std::string("tEXtComment") + '\0';
    for (char c : comment) body += c >= 32 && c < 127 ? c : '?';
    return big_endian(body.size() - 4) + body + big_endian(crc32(body));
}

// A cursor over a header of words between blanks, for both formats that we read.
struct Header {
    const std::string& path;
    std::string_view bytes;
    size_t at = 0;

    std::string_view word() {
        skip_blanks();
        size_t start = at;
        while (at < bytes.size() && !std::isspace(static_cast<unsigned char>(bytes[at]))) at++;
        return bytes.substr(start, at - start);
    }
    void skip_blanks() {
        while (at < bytes.size()) {
            if (bytes[at] == '#') {
                while (at < bytes.size() && bytes[at] != '\n') at++;
            } else if (std::isspace(static_cast<unsigned char>(bytes[at]))) {
                at++;
            } else {
                return;
            }
        }
    }
    float number() {
        std::string text(word());
        char* end = nullptr;
        float value = std::strtof(text.c_str(), &end);
        if (text.empty() || *end != '\0') fail("a damaged header");
        return value;
    }
    int side() {
        float value = number();
        if (!(value >= 1 && value <= 65536 && value == std::floor(value))) {
            fail("a picture's sides must be whole numbers from 1 to 65536");
        }
        return static_cast<int>(value);
    }
    // What follows the single blank behind the header; it must have `size` bytes.
    std::string_view body(size_t size) {
        std::string_view rest = bytes.substr(std::min(at + 1, bytes.size()));
        if (rest.size() < size) fail("the picture is cut short");
        return rest.substr(0, size);
    }
    [[noreturn]] void fail(const std::string& what) const { ::fail({path}, what); }
};

Image decode_ppm(Header header) {
    int width = header.side(), height = header.side();
    if (header.number() != 255) header.fail("only 8-bit .ppm files (maxval 255) are read");
    std::string_view body =
        header.body(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
    Image image(width, height);
    std::array<float, 256> linear;
    for (size_t i = 0; i < 256; i++) linear[i] = from_srgb8(static_cast<unsigned char>(i));
    for (size_t i = 0; i < image.pixels.size(); i++) {
        auto channel = [&](size_t c) {
            return linear[static_cast<unsigned char>(body[3 * i + c])];
        };
        image.pixels[i] = {channel(0), channel(1), channel(2)};
    }
    return image;
}

Image decode_png(const std::string& path, const std::string& bytes) {
    auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    int size = static_cast<int>(std::min(bytes.size(), size_t{INT32_MAX})), width, height, channels;
    constexpr int64_t most = 1032;  // times smaller is what the format can make of it
    if (!stbi_info_from_memory(data, size, &width, &height, &channels) ||
        int64_t{width} * height > std::min(int64_t{1} << 28, 8 * most * int64_t{size}))
        fail({path}, "a damaged .png picture, or one of more than 2^28 pixels");
    std::unique_ptr<unsigned char, void (*)(void*)> codes(
        stbi_load_from_memory(data, size, &width, &height, &channels, 3), stbi_image_free);
    if (!codes) fail({path}, "a damaged .png picture");
    Image image(width, height);
    for (size_t i = 0; i < image.pixels.size(); i++) {
        const unsigned char* code = codes.get() + 3 * i;
        image.pixels[i] = {from_srgb8(code[0]), from_srgb8(code[1]), from_srgb8(code[2])};
    }
    return image;
}

Image decode_pfm(Header header, size_t channels) {
    int width = header.side(), height = header.side();
    float scale = header.number();
    if (!(scale < 0 || scale > 0)) header.fail("a .pfm file's scale must not be 0");
    size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
    std::string_view body = header.body(4 * channels * pixels);
    Image image(width, height);
    auto value = [&](size_t i) {
        uint32_t bits;
        std::memcpy(&bits, body.data() + 4 * i, 4);
        return std::bit_cast<float>(scale < 0 ? bits : __builtin_bswap32(bits));
    };
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            size_t i = (static_cast<size_t>(height - 1 - y) * static_cast<size_t>(width) +
                        static_cast<size_t>(x)) *
                       channels;
            image.at(x, y) = channels == 1 ? Rgb{value(i), value(i), value(i)}
                                           : Rgb{value(i), value(i + 1), value(i + 2)};
        }
    }
    return image;
}

}  // namespace

bool is_image_path(const std::string& path) {
    std::string kind = extension(path);
    return kind == ".ppm" || kind == ".pfm" || kind == ".png";
}

std::string encode_png(const Image& image, const std::string& comment) {
    std::string pixels = srgb_bytes(image);
    std::string png;
    auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<char*>(data), static_cast<size_t>(size));
    };
    if (!stbi_write_png_to_func(append, &png, image.width, image.height, 3, pixels.data(),
                                3 * image.width)) {
        throw std::bad_alloc();
    }
    constexpr size_t after_header = 8 + 25;  // signature, IHDR
    return png.insert(after_header, text_chunk(comment));
}

void write_image(const std::string& path, const Image& image, const std::string& comment) {
    std::string kind = extension(path);
    if (kind == ".ppm") return write_file_atomically(path, encode_ppm(image));
    if (kind == ".pfm") return write_file_atomically(path, encode_pfm(image));
    if (kind == ".png") return write_file_atomically(path, encode_png(image, comment));
    fail({path}, "a picture's name must end in .ppm, .pfm or .png");
}

Image read_image(const std::string& path) { return decode_image(path, read_file(path)); }

Image decode_image(const std::string& path, const std::string& bytes) {
    if (bytes.starts_with("\x89PNG")) return decode_png(path, bytes);
    Header header{path, bytes};
    std::string_view magic = header.word();
    if (magic == "P6") return decode_ppm(header);
    if (magic == "PF") return decode_pfm(header, 3);
    if (magic == "Pf") return decode_pfm(header, 1);
    header.fail("not a .ppm (P6), .pfm or .png picture");
}

std::string read_comment(const std::string& path) {
    std::string bytes = read_file(path);
    if (!bytes.starts_with("\x89PNG")) return "";
    const std::string key = std::string("Comment") + '\0';
    for (size_t at = 8; at + 8 <= bytes.size();) {
        size_t length = 0;
        for (size_t i = 0; i < 4; i++) length = length << 8 | static_cast<uint8_t>(bytes[at + i]);
        std::string_view body = std::string_view(bytes).substr(at + 8).substr(0, length);
        if (bytes.compare(at + 4, 4, "tEXt") == 0 && body.starts_with(key))
            return std::string(body.substr(key.size()));
        at += 12 + length;
    }
    return "";
}
