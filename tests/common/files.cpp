// Files that are whole or not there, and pictures on disk.
#include "common/base/files.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>

#include "common/picture/image.h"
#include "tests/support/folder.h"

namespace fs = std::filesystem;

namespace {

/// The picture whose every channel has a value of its own, negative, tiny and huge ones too.
Image numbered(int width, int height) {
    Image image(width, height);
    for (size_t i = 0; i < image.pixels.size(); i++) {
        float v = static_cast<float>(i);
        image.pixels[i] = {v + 0.25f, -v * 1e-20f, (v + 1) * 1e20f};
    }
    return image;
}

bool same_bits(const Image& a, const Image& b) {
    return a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Rgb)) == 0;
}

float big_endian_float(float x) {
    return std::bit_cast<float>(__builtin_bswap32(std::bit_cast<uint32_t>(x)));
}

std::string bytes_of(const std::vector<float>& values) {
    return {reinterpret_cast<const char*>(values.data()), 4 * values.size()};
}

uint32_t big_endian_at(const std::string& bytes, size_t at) {
    uint32_t value = 0;
    for (size_t i = 0; i < 4; i++) value = value << 8 | static_cast<uint8_t>(bytes.at(at + i));
    return value;
}

/// The checksum of a PNG chunk, by long division of polynomials: one bit after the other.
uint32_t png_crc(const std::string& bytes) {
    uint32_t remainder = 0xffffffff;
    for (char byte : bytes) {
        for (int bit = 0; bit < 8; bit++) {
            bool out = (remainder & 1) != ((static_cast<uint8_t>(byte) >> bit) & 1);
            remainder = remainder >> 1 ^ (out ? 0xedb88320 : 0);
        }
    }
    return ~remainder;
}

struct Chunk {
    std::string type, data;
};

/// The chunks of a PNG; fails where their lengths or checksums are wrong.
std::vector<Chunk> png_chunks(const std::string& png) {
    REQUIRE(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
    std::vector<Chunk> chunks;
    for (size_t at = 8; at < png.size();) {
        size_t length = big_endian_at(png, at);
        REQUIRE(at + 12 + length <= png.size());
        CHECK(big_endian_at(png, at + 8 + length) == png_crc(png.substr(at + 4, 4 + length)));
        chunks.push_back({png.substr(at + 4, 4), png.substr(at + 8, length)});
        at += 12 + length;
    }
    return chunks;
}

std::string png_chunk(const std::string& kind, const std::string& data) {
    auto number = [](size_t n) {
        std::string bytes;
        for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(n >> shift & 255);
        return bytes;
    };
    return number(data.size()) + kind + data + number(png_crc(kind + data));
}

/// A PNG file, one pixel high.
std::string png_of(int width, int depth, int kind, const std::string& packed) {
    std::string header = {static_cast<char>(width >> 24),
                          static_cast<char>(width >> 16),
                          static_cast<char>(width >> 8),
                          static_cast<char>(width),
                          0,
                          0,
                          0,
                          1,
                          static_cast<char>(depth),
                          static_cast<char>(kind),
                          0,
                          0,
                          0};
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + png_chunk("IDAT", packed) +
           png_chunk("IEND", "");
}

/// In the form of zlib, but not packed: one block of fewer than 256 bytes.
std::string zlib_of(const std::string& bytes) {
    uint32_t a = 1, b = 0;
    for (char c : bytes) a = (a + static_cast<uint8_t>(c)) % 65521, b = (b + a) % 65521;
    char n = static_cast<char>(bytes.size());
    std::string packed = {'\x78', 1, 1, n, 0, static_cast<char>(~n), '\xff'};
    packed += bytes;
    for (uint32_t sum : {b, a}) packed += {static_cast<char>(sum >> 8), static_cast<char>(sum)};
    return packed;
}

}  // namespace

TEST_SUITE("files") {
    TEST_CASE("files: what is written is what is read, bytes of all values too") {
        TemporaryFolder folder;
        std::string bytes;
        for (int i = 0; i < 3000000; i++) bytes += static_cast<char>(i * 7 / 256 + i);
        write_file_atomically(folder / "a", bytes);
        CHECK(read_file(folder / "a") == bytes);
        write_file_atomically(folder / "a", "");
        CHECK(read_file(folder / "a").empty());
        CHECK(folder.names() == std::set<std::string>{"a"});
    }

    TEST_CASE("files: a write-protected file is not replaced, not even for root") {
        TemporaryFolder folder;
        std::string file = folder / "f", link = folder / "link", expected;
        std::vector<std::string> names = {file};
        if (make_link("f", link)) names.push_back(link);
        for (unsigned mode : {0444u, 0400u, 0555u}) {
            write_file_atomically(file, "precious");
            ::chmod(file.c_str(), static_cast<mode_t>(mode));
            for (const std::string& name : names) {
                expected = name + ": error: cannot write: it is write-protected";
                CHECK(error_of([&] { check_writable(name); }) == expected);
                CHECK(error_of([&] { check_outputs({name}); }) == expected);
                CHECK(error_of([&] { write_file_atomically(name, "x"); }).starts_with(expected));
            }
            CHECK(read_file(file) == "precious");
            ::chmod(file.c_str(), 0644);
        }
    }

    TEST_CASE("files: what cannot be put in its place stays beside it, and the error names it") {
        TemporaryFolder folder;
        std::string f = folder / "f", begin = f + ": error: cannot write: ";
        std::string middle = "; what was to be written is ";
        for (std::string bytes : {"first", "second"}) {
            // Somebody protects the file, or makes a folder of its name, while it is written.
            for (bool is_folder : {false, true}) {
                ::chmod(f.c_str(), 0644);
                fs::remove(f);
                NewFile file(f);
                file.write(bytes);
                if (is_folder) {
                    fs::create_directories(f);
                } else {
                    write_file_atomically(f, "old");
                    ::chmod(f.c_str(), 0444);
                }
                std::string error = error_of([&] { file.commit(); });
                CHECK(error.starts_with(begin));
                size_t at = error.find(middle);
                REQUIRE(at != std::string::npos);
                std::string kept = error.substr(at + middle.size());
                CHECK(kept.starts_with(f + ".kept-"));
                CHECK(read_file(kept) == bytes);
                if (!is_folder) CHECK(read_file(f) == "old");
            }
        }
        ::chmod(f.c_str(), 0644);
        // One file, however often the same process fails.
        CHECK(folder.names().size() == 2);
        fs::remove(f);
        write_file_atomically(f, "third");
        CHECK(folder.names().size() == 2);  // and no later run removes it
    }

    TEST_CASE("files: no output is an input, or another output, under whatever name") {
        TemporaryFolder folder;
        fs::create_directory(folder / "d");
        for (const char* name : {"a", "b"}) write_file_atomically(folder / name, name);
        fs::create_hard_link(folder / "a", folder / "d/same_as_a");
        std::vector<std::string> names = {"a", "./a", "d/../a", "d/same_as_a"};
        if (make_link("../a", folder / "d/to_a")) names.push_back("d/to_a");
        std::vector<std::string> inputs = {folder / "b", folder / "a"};
        for (const std::string& name : names) {
            CAPTURE(name);
            std::string error = error_of([&] {
                check_outputs({folder / "c", folder / name}, inputs);
            });
            CHECK(error.starts_with("error: '" + folder / name + "' is an input"));
            CHECK(error.ends_with(", and would be overwritten"));
            CHECK(error_of([&] {
                      check_outputs({folder / "a", folder / name});
                  }) == "error: '" + folder / "a" + "' and '" + folder / name + "' are one file");
        }
        CHECK(error_of([&] { check_outputs({folder / "c", folder / "d/a"}, inputs); }) == "");
        CHECK(read_file(folder / "a") == "a");
    }

    TEST_CASE("files: asking whether a file can be written changes nothing") {
        TemporaryFolder folder;
        write_file_atomically(folder / "f", "x");
        check_writable(folder / "f");
        check_writable(folder / "g");
        check_writable(null_device);
        CHECK(read_file(folder / "f") == "x");
        CHECK(folder.names() == std::set<std::string>{"f"});
    }

    TEST_CASE("files: what cannot be read is an error") {
        TemporaryFolder folder;
        CHECK(error_of([&] { read_file(folder / "none"); }) ==
              folder / "none" + ": error: cannot read: No such file or directory");
        CHECK(error_of([&] { read_file(folder.path()); }) ==
              folder.path() + ": error: cannot read: Is a directory");
        // A file that opens but does not read: this process's memory at address 0.
        if (!exists_here("/proc/self/mem")) return;
        CHECK(error_of([] { read_file("/proc/self/mem"); }) ==
              "/proc/self/mem: error: cannot read: Input/output error");
    }
}

TEST_SUITE("pictures on disk") {
    TEST_CASE("identity: a .pfm picture is read back bit for bit") {
        TemporaryFolder folder;
        for (auto [w, h] : {std::pair(1, 1), std::pair(7, 3), std::pair(2, 5)}) {
            Image image = numbered(w, h);
            image.pixels.back() = {infinity, -0.0f, std::numeric_limits<float>::denorm_min()};
            write_image(folder / "a.pfm", image, "");
            CHECK(same_bits(read_image(folder / "a.pfm"), image));
        }
    }

    TEST_CASE("truth: a .pfm file has its bottom row first, little endian") {
        TemporaryFolder folder;
        Image image(2, 2);
        image.at(0, 0) = {1, 2, 3};
        image.at(1, 0) = {4, 5, 6};
        image.at(0, 1) = {7, 8, 9};
        image.at(1, 1) = {10, 11, 12};
        write_image(folder / "a.pfm", image, "");
        CHECK(read_file(folder / "a.pfm") ==
              "PF\n2 2\n-1.0\n" + bytes_of({7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6}));
        CHECK(read_file(folder / "a.pfm").substr(12, 4) == std::string("\0\0\xe0\x40", 4));  // 7
    }

    TEST_CASE(
        "truth: the scale of a .pfm file multiplies its values, and its sign is their order") {
        // As pbrt-v4 reads it: |scale| times the value; below 0: little endian.
        TemporaryFolder folder;
        const std::vector<float> values = {0.5f, 1.25f, 3};
        std::vector<float> swapped;
        for (float v : values) swapped.push_back(big_endian_float(v));
        for (auto [text, scale] : {std::pair("1", 1.0f),
                                   {"2.0", 2},
                                   {"0.25", 0.25f},
                                   {".5", 0.5f},
                                   {"1e3", 1000},
                                   {"+3", 3},
                                   {"1.000000", 1},
                                   {"1e-30", 1e-30f},
                                   {"1e30", 1e30f}}) {
            for (const char* kind : {"PF", "Pf"}) {
                for (bool is_little : {true, false}) {
                    std::string name = std::string(is_little ? "-" : "") + text;
                    if (name == "-+3") continue;
                    CAPTURE(name);
                    size_t n = kind[1] == 'F' ? 1 : 3;  // pixels
                    Image image = decode_image(
                        "a.pfm", std::string(kind) + "\n" + std::to_string(n) + " 1\n" + name +
                                     "\n" + bytes_of(is_little ? values : swapped));
                    REQUIRE(image.pixels.size() == n);
                    Rgb last = image.pixels[n - 1], first = image.pixels[0];
                    CHECK(first.r == scale * 0.5f);
                    CHECK(last.b == scale * 3);
                    CHECK(last.g == scale * (n == 1 ? 1.25f : 3));
                }
            }
        }
    }

    TEST_CASE("truth: one blank ends a header, or CR LF; pixels may begin with such bytes") {
        std::string pixel = bytes_of({1.5f});
        pixel[0] = '\n', pixel[1] = '\r';  // in the last digits
        for (const char* end : {"\n", "\r\n", "\r", " "}) {
            CAPTURE(end);
            std::string header = "Pf" + std::string(end) + "1 1" + end + "-1" + end;
            CHECK(decode_image("a.pfm", header + pixel).at(0, 0).r ==
                  doctest::Approx(1.5).epsilon(1e-3).scale(0));
        }
    }

    TEST_CASE("truth: codes of sRGB, and what lies outside them") {
        // From IEC 61966-2-1: linear below 0.0031308, then 1.055 x^(1/2.4) - 0.055.
        CHECK(to_srgb8(0) == 0);
        CHECK(to_srgb8(1) == 255);
        CHECK(to_srgb8(0.5f) == 188);
        CHECK(to_srgb8(0.18f) == 118);
        CHECK(to_srgb8(0.003f) == 10);
        CHECK(to_srgb8(0.2158605f) == 128);
        CHECK(to_srgb8(-1) == 0);
        CHECK(to_srgb8(7) == 255);
        CHECK(to_srgb8(std::nanf("")) == 0);
        CHECK(to_srgb8(infinity) == 255);
    }

    TEST_CASE("identity: each of the 256 codes of a .ppm file is read and written as itself") {
        TemporaryFolder folder;
        std::string ppm = "P6\n# a comment\n16 16\n255\n";
        for (int i = 0; i < 256; i++) ppm += std::string(3, static_cast<char>(i));
        write_file_atomically(folder / "a.ppm", ppm);
        write_image(folder / "b.ppm", read_image(folder / "a.ppm"), "");
        std::string written = read_file(folder / "b.ppm");
        CHECK(written.starts_with("P6\n16 16\n255\n"));
        CHECK(written.substr(written.size() - 768) == ppm.substr(ppm.size() - 768));
    }

    TEST_CASE("truth: a .ppm file has its top row first") {
        TemporaryFolder folder;
        Image image(1, 2);
        image.at(0, 0) = {1, 0, 0};
        image.at(0, 1) = {0, 0.5f, 1};
        write_image(folder / "a.ppm", image, "");
        CHECK(read_file(folder / "a.ppm") == std::string("P6\n1 2\n255\n\xff\0\0\0\xbc\xff", 17));
    }

    TEST_CASE("failure: a pixel that is not finite is NaN in a .pfm, and magenta in a .ppm") {
        TemporaryFolder folder;
        Image image(2, 1);
        image.at(0, 0) = {std::nanf(""), 0, 0};
        image.at(1, 0) = {0, infinity, 0};
        write_image(folder / "a.pfm", image, "");
        write_image(folder / "a.ppm", image, "");
        CHECK(same_bits(read_image(folder / "a.pfm"), image));
        CHECK(read_file(folder / "a.ppm").substr(11) == std::string("\xff\0\xff\xff\0\xff", 6));
    }

    TEST_CASE("truth: a .png file holds the picture's size, a comment, and right checksums") {
        TemporaryFolder folder;
        write_image(folder / "a.png", numbered(300, 7),
                    "build/07 --paths 'L\xc3\xa4' \n --seed 1\x1b");
        std::vector<Chunk> chunks = png_chunks(read_file(folder / "a.png"));
        REQUIRE(chunks.size() >= 4);
        CHECK(chunks[0].type == "IHDR");
        CHECK(big_endian_at(chunks[0].data, 0) == 300);
        CHECK(big_endian_at(chunks[0].data, 4) == 7);
        CHECK(chunks[0].data.substr(8) == std::string("\x08\x02\0\0\0", 5));  // 8 bits, RGB
        CHECK(chunks[1].type == "tEXt");
        CHECK(chunks[1].data == std::string("Comment\0", 8) +
                                    "build/07 --paths 'L?"
                                    "?' \n --seed 1?");
        for (size_t i = 2; i + 1 < chunks.size(); i++) CHECK(chunks[i].type == "IDAT");
        CHECK(chunks.back().type == "IEND");
    }

    TEST_CASE("identity: a PNG that was written is read again, and no byte may be missing") {
        TemporaryFolder folder;
        Image image(5, 3);
        for (size_t i = 0; i < image.pixels.size(); i++) {
            float x = static_cast<float>(i) / 15;
            image.pixels[i] = {x, x * x, 1 - x};
        }
        write_image(folder / "a.png", image, "a comment");
        write_image(folder / "a.ppm", image, "");
        CHECK(read_image(folder / "a.png").pixels == read_image(folder / "a.ppm").pixels);
        std::string png = read_file(folder / "a.png");
        size_t end_of_pixels = png.find("IEND") - 8;
        for (size_t size = 8; size < end_of_pixels; size++) {
            CAPTURE(size);
            write_file_atomically(folder / "b.png", png.substr(0, size));
            CHECK_THROWS_AS(read_image(folder / "b.png"), InputError);
        }
    }

    TEST_CASE("input: one wrong bit anywhere in a .png file is an error") {
        Image image(5, 3);
        for (size_t i = 0; i < image.pixels.size(); i++)
            image.pixels[i] = Rgb{1, 1, 1} * (static_cast<float>(i) / 15);
        const std::string png = encode_png(image, "a comment");
        CHECK(decode_image("a.png", png).width == 5);
        for (size_t bit = 0; bit < 8 * png.size(); bit++) {
            std::string damaged = png;
            damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ 1 << bit % 8);
            CAPTURE(bit);
            CHECK_THROWS_AS(decode_image("a.png", damaged), InputError);
        }
    }

    TEST_CASE("truth: .png files of 16 bits, of grey, and with transparency are read") {
        auto sample = [](int code, int most) {
            return from_srgb(static_cast<float>(code) / static_cast<float>(most));
        };
        auto read = [](int width, int depth, int kind, const std::string& row) {
            return decode_image("a.png", png_of(width, depth, kind, zlib_of('\0' + row))).pixels;
        };
        // 16 bits, the high byte first: neither is lost.
        CHECK(read(1, 16, 2, std::string("\x12\x34\x80\x01\xff\xfe", 6)) ==
              std::vector<Rgb>{
                  {sample(0x1234, 65535), sample(0x8001, 65535), sample(0xfffe, 65535)}});
        CHECK(read(2, 8, 0, "\x40\xff") ==
              std::vector<Rgb>{Rgb{1, 1, 1} * sample(0x40, 255), Rgb{1, 1, 1}});
        CHECK(read(3, 1, 0, "\xa0") == std::vector<Rgb>{{1, 1, 1}, {0, 0, 0}, {1, 1, 1}});
        // A part of the pixels may be empty.
        std::string png = png_of(1, 8, 0, zlib_of(std::string("\0\xff", 2)));
        png.insert(png.find("IDAT") - 4, png_chunk("IDAT", ""));
        CHECK(decode_image("a.png", png).pixels == std::vector<Rgb>{{1, 1, 1}});
        // Transparency is left out, as in pbrt.
        CHECK(read(1, 8, 6, std::string("\x10\x20\x30\0", 4)) ==
              std::vector<Rgb>{{sample(16, 255), sample(32, 255), sample(48, 255)}});
        CHECK(read(1, 8, 4, std::string("\x10\0", 2)) ==
              std::vector<Rgb>{Rgb{1, 1, 1} * sample(16, 255)});
    }

    TEST_CASE("input: damaged pictures are errors") {
        TemporaryFolder folder;
        constexpr const char* cut = "the picture is cut short";
        constexpr const char* sides = "a picture's sides must be whole numbers from 1 to 65536";
        constexpr const char* scale = "a .pfm file's scale must be a finite number other than 0";
        struct {
            std::string bytes, error;
        } cases[] = {
            {"", "not a .ppm (P6), .pfm, .png, .jpg or .tga picture"},
            {"P3\n1 1\n255\n0 0 0\n", "not a .ppm (P6), .pfm, .png, .jpg or .tga picture"},
            {"\x89PNG\r\n\x1a\n", "the picture is cut short, or damaged"},
            {"P6", cut},
            {"P6 # 4 4 255 ", cut},
            {"P6\n1 1\n255\n00", cut},
            {"P6\n16384 16384\n255\n", cut},
            {"PF\n1 1\n-1\n" + std::string(11, 'x'), cut},
            {"Pf\n1 1\n-1\r\nxx", cut},
            {"P6\nx 4\n255\n", sides},
            {"P6\n0 4\n255\n", sides},
            {"P6\nnan 4\n255\n", sides},
            {"P6\n65537 4\n255\n", sides},
            {"P6\n65536 65536\n255\n", "a picture of more than 2^28 pixels"},
            {"Pf\n65536 4097\n-1\n", "a picture of more than 2^28 pixels"},
            {"P6\n1 1\n65535\n000000", "only 8-bit .ppm files (maxval 255) are read"},
            {"P6\n1 1\n0\n000000", "only 8-bit .ppm files (maxval 255) are read"},
            {"PF\n1 1\n0\n" + std::string(12, 'x'), scale},
            {"PF\n1 1\nnan\n" + std::string(12, 'x'), scale},
            {"PF\n1 1\n1e-99\n" + std::string(12, 'x'), scale},
            {"P6\n1 1\n255\n0001", "1 byte is left over after the pixels"},
            {"P6\n1 1\n255\n\r000", "1 byte is left over after the pixels"},
            {"PF\n1 1\n-1\n" + std::string(12 + 77, 'x'),
             "77 bytes are left over after the pixels"},
            {"Pf\n1 1\n-1\r\n" + std::string(6, 'x'), "3 bytes are left over after the pixels"},
            {"P5 1 1 255 000", "not a .ppm (P6), .pfm, .png, .jpg or .tga picture"},
            {"\xff\xd8\xff 1 1 255 000", "the picture is cut short, or too large"},
        };
        for (const auto& c : cases) {
            write_file_atomically(folder / "a", c.bytes);
            CHECK(error_of([&] { read_image(folder / "a"); }) ==
                  folder / "a" + ": error: " + c.error);
        }
    }

    TEST_CASE("input: a picture needs an extension that is known") {
        for (const char* path : {"a", "a.jpg", "a.ppm.gz", "ppm", "a.ppm/b", ""}) {
            CHECK_FALSE(is_image_path(path));
            CHECK(error_of([&] { write_image(path, Image(1, 1), ""); }) ==
                  std::string(path) + ": error: a picture's name must end in .ppm, .pfm or .png");
        }
        for (const char* path : {"a.ppm", "b/a.pfm", "a.b.png", ".ppm"}) CHECK(is_image_path(path));
    }
}
