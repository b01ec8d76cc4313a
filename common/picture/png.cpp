#include "common/picture/png.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "common/base/position.h"

namespace {

/// The most bytes that stb may ask for at once: a small file can be made to unpack to gigabytes.
thread_local size_t most_memory = 0;

void* limited_realloc(void* old, size_t size) {
    return size > most_memory ? nullptr : std::realloc(old, size);
}

}  // namespace

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

namespace {

constexpr size_t most_bytes = size_t{1} << 30;
constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
constexpr std::string_view comment_key = {"Comment\0", 8};

uint32_t crc32(std::string_view bytes) {
    static const std::array<uint32_t, 256> of_byte = [] {
        std::array<uint32_t, 256> table;
        for (uint32_t i = 0; i < 256; i++) {
            table[i] = i;
            for (int bit = 0; bit < 8; bit++)
                table[i] = (table[i] >> 1) ^ (table[i] & 1 ? 0xedb88320u : 0);
        }
        return table;
    }();
    uint32_t crc = ~0u;
    for (char byte : bytes) crc = (crc >> 8) ^ of_byte[(crc ^ static_cast<uint8_t>(byte)) & 255];
    return ~crc;
}

std::string big_endian(size_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

size_t big_endian_at(std::string_view bytes, size_t at) {
    size_t value = 0;
    for (size_t i = 0; i < 4; i++) value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
    return value;
}

/// Calls visit(kind, data) for each chunk, up to the one that ends the picture.
template <typename Visit>
void for_chunks(const std::string& path, std::string_view bytes, const Visit& visit) {
    std::string_view kind;
    for (size_t at = signature.size(); kind != "IEND";) {
        if (bytes.size() - at < 12 || big_endian_at(bytes, at) > bytes.size() - at - 12)
            fail({path}, "the picture is cut short, or damaged");
        size_t length = big_endian_at(bytes, at);
        kind = bytes.substr(at + 4, 4);
        if (crc32(bytes.substr(at + 4, 4 + length)) != big_endian_at(bytes, at + 8 + length))
            fail({path}, "a damaged .png picture: a checksum is wrong");
        visit(kind, bytes.substr(at + 8, length));
        at += 12 + length;
    }
}

/// Whether a .tga file has fewer pixels than its header says: stb would make them up.
bool tga_is_cut(const std::string& bytes) {
    auto byte = [&](size_t i) { return size_t{static_cast<uint8_t>(bytes[i])}; };
    constexpr size_t header = 18;
    if (bytes.size() < header) return true;
    size_t palette = (byte(5) + 256 * byte(6)) * ((byte(7) + 7) / 8), each = (byte(16) + 7) / 8;
    size_t left = (byte(12) + 256 * byte(13)) * (byte(14) + 256 * byte(15));
    size_t at = header + byte(0) + (byte(1) != 0 ? palette : 0);
    bool is_packed = byte(2) >= 8;
    if (!is_packed) return bytes.size() < at + left * each;
    while (left > 0 && at < bytes.size()) {
        size_t pixels = 1 + (byte(at) & 127);
        at += 1 + (byte(at) & 128 ? 1 : pixels) * each;
        left -= std::min(left, pixels);
    }
    return left > 0 || at > bytes.size();
}

/// Whether a .jpg file has no end, or a Huffman table of more than 256 codes: stb has no room for
/// more. A table stands where the bytes FF C4 do.
bool jpg_is_damaged(const std::string& bytes) {
    auto byte = [&](size_t i) {
        return i < bytes.size() ? size_t{static_cast<uint8_t>(bytes[i])} : 0;
    };
    for (size_t at = 0; (at = bytes.find("\xff\xc4", at)) != std::string::npos; at += 2) {
        size_t table = at + 4, end = at + 2 + 256 * byte(at + 2) + byte(at + 3);
        while (table < end && table < bytes.size()) {
            size_t codes = 0;
            for (size_t i = 1; i <= 16; i++) codes += byte(table + i);
            if (codes > 256) return true;
            table += 17 + codes;
        }
    }
    return bytes.rfind("\xff\xd9") == std::string::npos;
}

/// What stb makes of a file, in linear values.
Image decode(const std::string& path, const std::string& file, float gamma,
             const std::string& damaged) {
    auto* data = reinterpret_cast<const unsigned char*>(file.data());
    int size = static_cast<int>(file.size()), width = 0, height = 0, channels = 0;
    constexpr int64_t most = 1032;  // times smaller is what the .png format can make of it
    most_memory = 1 << 16;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels) ||
        int64_t{width} * height > std::min(int64_t{most_pixels}, 8 * most * int64_t{size}))
        fail({path}, damaged + ", or one of more than 2^28 pixels");
    size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
    most_memory += 2 * file.size() + 32 * pixels;
    // With 16 bits for all: 257 times a code of 8 bits, of 65535, is the same float.
    std::unique_ptr<uint16_t, void (*)(void*)> codes(
        stbi_load_16_from_memory(data, size, &width, &height, &channels, 3), stbi_image_free);
    if (!codes) fail({path}, damaged);
    std::vector<float> linear(65536);
    for (size_t i = 0; i < linear.size(); i++) {
        linear[i] = to_linear(static_cast<float>(i) / 65535, gamma);
    }
    Image image(width, height);
    for (size_t i = 0; i < pixels; i++) {
        const uint16_t* code = codes.get() + 3 * i;
        image.pixels[i] = {linear[code[0]], linear[code[1]], linear[code[2]]};
    }
    return image;
}

}  // namespace

std::string png_chunk(const std::string& kind_and_data) {
    return big_endian(kind_and_data.size() - 4) + kind_and_data + big_endian(crc32(kind_and_data));
}

bool is_gzip(const std::string& bytes) { return bytes.starts_with("\x1f\x8b"); }

std::string unpack_gzip(const std::string& path, const std::string& bytes) {
    auto byte = [&](size_t i) {
        return i < bytes.size() ? uint32_t{static_cast<uint8_t>(bytes[i])} : 0;
    };
    auto end_of_text = [&](size_t at) {
        size_t end = bytes.find('\0', at);
        return end == std::string::npos ? bytes.size() : end + 1;
    };
    // The header: ten bytes, and by the bits of the fourth an extra field, a name and a comment.
    size_t at = 10;
    if (byte(3) & 4) at += 2 + byte(at) + 256 * byte(at + 1);
    for (uint32_t flag : {8u, 16u})
        if (byte(3) & flag) at = end_of_text(at);
    if (byte(3) & 2) at += 2;
    constexpr size_t most = 1032, behind = 8;  // times larger; a checksum and the length
    if (at + behind > bytes.size() || byte(2) != 8u || bytes.size() > most_bytes)
        fail({path}, "not whole, or larger than 1 GB: packed by gzip");
    most_memory = (1 << 16) + most * bytes.size();
    int size = 0;
    std::unique_ptr<char, void (*)(void*)> text(
        stbi_zlib_decode_noheader_malloc(bytes.data() + at,
                                         static_cast<int>(bytes.size() - behind - at), &size),
        std::free);
    auto little = [&](size_t i) {
        return byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24;
    };
    std::string_view unpacked(text.get(), text ? static_cast<size_t>(size) : 0);
    size_t tail = bytes.size() - behind;
    if (!text || unpacked.size() != little(tail + 4) || crc32(unpacked) != little(tail))
        fail({path}, "damaged: gzip's checksum is another");
    return std::string(unpacked);
}

bool is_png(const std::string& bytes) { return bytes.starts_with(signature); }

std::string encode_png(int width, int height, const std::string& codes,
                       const std::string& comment) {
    std::string png;
    auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<char*>(data), static_cast<size_t>(size));
    };
    if (!stbi_write_png_to_func(append, &png, width, height, 3, codes.data(), 3 * width)) {
        throw std::bad_alloc();
    }
    constexpr size_t after_header = signature.size() + 25;  // IHDR
    return png.insert(after_header, png_chunk("tEXt" + std::string(comment_key) + comment));
}

Image decode_png(const std::string& path, const std::string& bytes, float gamma) {
    std::string file(signature);  // without empty parts, which stb copies to nowhere
    for_chunks(path, bytes, [&](std::string_view kind, std::string_view data) {
        if (kind == "IEND" || !data.empty())
            file += png_chunk(std::string(kind) + std::string(data));
    });
    return decode(path, file, gamma, "a damaged .png picture");
}

bool is_jpg(const std::string& bytes) { return bytes.starts_with("\xff\xd8\xff"); }

Image decode_jpg_or_tga(const std::string& path, const std::string& bytes, float gamma) {
    bool is_cut = is_jpg(bytes) ? jpg_is_damaged(bytes) : tga_is_cut(bytes);
    if (is_cut || bytes.size() > most_bytes) fail({path}, "the picture is cut short, or too large");
    return decode(path, bytes, gamma, "a damaged picture, or of a kind that is not read");
}

std::string png_comment(const std::string& path, const std::string& bytes) {
    std::string comment;
    for_chunks(path, bytes, [&](std::string_view kind, std::string_view data) {
        if (comment.empty() && kind == "tEXt" && data.starts_with(comment_key))
            comment = data.substr(comment_key.size());
    });
    return comment;
}
