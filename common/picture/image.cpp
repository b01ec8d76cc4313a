#include "common/picture/image.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>

#include "common/base/files.h"
#include "common/base/numbers.h"
#include "common/base/position.h"
#include "common/base/system.h"
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

// A cursor over a header of words between blanks, for both formats that have one.
struct Header {
    const std::string& path;
    std::string_view bytes;
    size_t at = 0;

    std::string_view word() {
        skip_blanks();
        size_t start = at;
        while (at < bytes.size() && !is_blank(bytes[at])) at++;
        return bytes.substr(start, at - start);
    }
    static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
    void skip_blanks() {
        while (at < bytes.size()) {
            if (bytes[at] == '#') {
                while (at < bytes.size() && bytes[at] != '\n' && bytes[at] != '\r') at++;
            } else if (is_blank(bytes[at])) {
                at++;
            } else {
                return;
            }
        }
    }
    /// NaN for a word that is no number.
    double number() {
        std::string_view text = word();
        if (text.empty()) fail(cut_short);
        return to_number(text).value_or(NAN);
    }
    /// An image of the size that comes next.
    Image image() {
        double width = number(), height = number();
        for (double side : {width, height}) {
            if (side >= 1 && side <= 65536 && side == std::floor(side)) continue;
            fail("a picture's sides must be whole numbers from 1 to 65536");
        }
        if (width * height > most_pixels) fail("a picture of more than 2^28 pixels");
        Image sized;  // its pixels wait until the file is known to have them
        sized.width = static_cast<int>(width), sized.height = static_cast<int>(height);
        return sized;
    }
    /// The bytes after the header, `each` for a pixel: all of them. One blank ends the
    /// header, or CR LF where the file then has the right size.
    std::string_view body(Image& image, size_t each) {
        size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
        size_t size = each * pixels;
        std::string_view rest = bytes.substr(at);
        if (rest.starts_with("\r\n") && rest.size() == size + 2) rest.remove_prefix(1);
        if (rest.size() < size + 1) fail(cut_short);
        size_t more = rest.size() - size - 1;
        if (more > 0) {
            fail(std::to_string(more) + (more == 1 ? " byte is" : " bytes are") +
                 " left over after the pixels");
        }
        image.pixels.resize(pixels);
        return rest.substr(1);
    }
    [[noreturn]] void fail(const std::string& what) const { ::fail({path}, what); }

    static constexpr const char* cut_short = "the picture is cut short";
};

Image decode_ppm(Header header, float gamma) {
    Image image = header.image();
    if (header.number() != 255) header.fail("only 8-bit .ppm files (maxval 255) are read");
    std::string_view body = header.body(image, 3);
    std::array<float, 256> linear;
    for (size_t i = 0; i < 256; i++) {
        linear[i] = to_linear(static_cast<float>(i) / 255, gamma);
    }
    for (size_t i = 0; i < image.pixels.size(); i++) {
        auto channel = [&](size_t c) {
            return linear[static_cast<unsigned char>(body[3 * i + c])];
        };
        image.pixels[i] = {channel(0), channel(1), channel(2)};
    }
    return image;
}

/// The sign of the scale is the order of bytes; its magnitude multiplies all values, as in pbrt.
Image decode_pfm(Header header, size_t channels) {
    Image image = header.image();
    float scale = static_cast<float>(header.number());
    if (!std::isfinite(scale) || scale == 0) {
        header.fail("a .pfm file's scale must be a finite number other than 0");
    }
    std::string_view body = header.body(image, 4 * channels);
    auto value = [&](size_t i) {
        uint32_t bits;
        std::memcpy(&bits, body.data() + 4 * i, 4);
        return std::bit_cast<float>(scale < 0 ? bits : __builtin_bswap32(bits)) * std::abs(scale);
    };
    for (int y = 0; y < image.height; y++) {
        for (int x = 0; x < image.width; x++) {
            size_t i =
                (static_cast<size_t>(image.height - 1 - y) * static_cast<size_t>(image.width) +
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
    if (is_png(bytes)) return decode_png(path, bytes, gamma);
    if (is_jpg(bytes) || has_ending(path, ".tga")) return decode_jpg_or_tga(path, bytes, gamma);
    if (bytes.starts_with("\x76\x2f\x31\x01")) {
        fail({path}, "an .exr picture: pbrt makes a .pfm of it, by imgtool convert --outfile " +
                         path.substr(0, path.rfind('.')) + ".pfm " + path);
    }
    Header header{path, bytes};
    std::string_view magic = header.word();
    if (magic == "P6") return decode_ppm(header, gamma);
    if (magic == "PF") return decode_pfm(header, 3);
    if (magic == "Pf") return decode_pfm(header, 1);
    header.fail("not a .ppm (P6), .pfm, .png, .jpg or .tga picture");
}

std::string decode_comment(const std::string& path, const std::string& bytes) {
    if (is_png(bytes)) return png_comment(path, bytes);
    std::string_view rest = bytes;
    if (!rest.starts_with("P6\n")) return "";
    rest.remove_prefix(3);
    std::string comment;
    while (rest.starts_with("# ")) {
        size_t end = std::min(rest.find('\n'), rest.size() - 1);
        comment += rest.substr(2, end - 1);  // with its end
        rest.remove_prefix(end + 1);
    }
    return comment;
}
