// Files that are whole or not there, and pictures on disk.
#include "common/base/files.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
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

}  // namespace

TEST_SUITE("files") {
    TEST_CASE("files: what is written is what is read, bytes of all values too") {
        TemporaryFolder folder;
        std::string bytes;
        for (int i = 0; i < 3000000; i++) bytes += static_cast<char>(i * 7 / 256 + i);
        for (const std::string& content : {bytes, std::string()}) {
            write_file_atomically(folder / "a", content);
            CHECK(read_file(folder / "a") == content);
        }
        check_writable(folder / "a");
        check_writable(folder / "b");
        check_writable(null_device);
        CHECK(folder.names() == std::set<std::string>{"a"});
    }

    TEST_CASE("files: what cannot be put in its place stays beside it, and the error names it") {
        TemporaryFolder folder;
        std::string f = folder / "f";
        // Somebody makes a folder of its name, or protects the file, while it is written.
        for (std::string bytes : {"first", "second"}) {
            std::string error = error_of([&] {
                write_file_atomically(f, [&](std::ostream& file) {
                    file << bytes;
                    if (bytes == "first") {
                        fs::create_directory(f);
                    } else {
                        std::ofstream(f) << "old";
                        ::chmod(f.c_str(), 0444);
                    }
                });
            });
            CHECK(error.starts_with(f + ": error: cannot write: "));
            CHECK(error.ends_with("; what was to be written is " + f + ".part"));
            CHECK(read_file(f + ".part") == bytes);
            if (bytes == "first") fs::remove(f);
        }
        CHECK(read_file(f) == "old");
        ::chmod(f.c_str(), 0644);
        write_file_atomically(f, "third");
        CHECK(folder.names() == std::set<std::string>{"f"});
    }

    TEST_CASE("files: two do not write the same file at once; what a kill left is overwritten") {
        TemporaryFolder folder;
        std::string f = folder / "f", why = f + ": error: another program is writing it";
        for (const char* left : {".part", ".lock", ".part.lock"})
            std::ofstream(f + left) << "of a run that was killed";
        write_file_atomically(f, [&](std::ostream& file) {
            file << "half of i";
            CHECK(error_of([&] { write_file_atomically(f, "by another"); }) == why);
            file << "t";
        });
        CHECK(read_file(f) == "half of it");
        {
            FileLock lock = lock_of(f);
            CHECK(error_of([&] { lock_of(f); }) == why);
            write_file_atomically(f, "by the owner");
        }
        CHECK(folder.names() == std::set<std::string>{"f"});
    }

    TEST_CASE("files: no output is another one, or an input, by another name or a hard link") {
        TemporaryFolder folder;
        write_file_atomically(folder / "a", "a");
        fs::create_hard_link(folder / "a", folder / "b");
        CHECK(error_of([&] { check_outputs({folder / "c", folder / "./c"}); }) != "");
        CHECK(error_of([&] { check_outputs({folder / "b"}, {folder / "a"}); }) != "");
        CHECK(error_of([&] { check_outputs({folder / "c"}, {folder / "a"}); }) == "");
        CHECK(error_of([&] { check_outputs({folder.path()}); }) != "");  // none can be written
    }

    TEST_CASE("files: what cannot be read is an error") {
        TemporaryFolder folder;
        CHECK(error_of([&] { read_file(folder / "none"); }) ==
              folder / "none" + ": error: cannot read: No such file or directory");
        CHECK(error_of([&] { read_file(folder.path()); }) ==
              folder.path() + ": error: cannot read: Is a directory");
    }

    TEST_CASE(
        "identity: a .pfm file keeps all bits, its bottom row first; a .ppm file its top row") {
        TemporaryFolder folder;
        for (auto [w, h] : {std::pair(1, 1), std::pair(7, 3), std::pair(2, 5)}) {
            Image image = numbered(w, h);
            image.pixels.back() = {infinity, -0.0f, std::numeric_limits<float>::denorm_min()};
            write_image(folder / "a.pfm", image, "");
            CHECK(same_bits(read_image(folder / "a.pfm"), image));
        }
        Image image(1, 3);
        image.pixels = {{1, 0, 0}, {0, 0.5f, 1}, {0, infinity, 0}};  // the last one is magenta
        for (const char* name : {"a.pfm", "a.ppm"}) write_image(folder / name, image, "");
        CHECK(read_file(folder / "a.pfm") ==
              "PF\n1 3\n-1.0\n" + bytes_of({0, infinity, 0, 0, 0.5f, 1, 1, 0, 0}));
        CHECK(read_file(folder / "a.ppm") ==
              std::string("P6\n1 3\n255\n\xff\0\0\0\xbc\xff\xff\0\xff", 20));
    }

    TEST_CASE(
        "truth: the scale of a .pfm file multiplies its values, and its sign is their order") {
        // As pbrt-v4 reads it: |scale| times the value; below 0: little endian. One blank ends the
        // header; the first value begins with such bytes.
        std::vector<float> values = {std::bit_cast<float>(0x3f000d0au), 1.25f, 3}, swapped;
        for (float v : values) swapped.push_back(big_endian_float(v));
        for (auto [text, scale] : {std::pair("1", 1.0f), {".25", 0.25f}, {"1e-30", 1e-30f}})
            for (const std::string kind : {"PF", "Pf"})
                for (const std::string blank : {"\n", "\r", " "})
                    for (const std::string sign : {"-", ""}) {
                        size_t n = kind == "PF" ? 1 : 3;  // pixels
                        std::string header = kind + blank + std::to_string(n) + " 1" + blank + sign;
                        Image image =
                            decode_image("a.pfm", header + text + blank +
                                                      bytes_of(sign == "-" ? values : swapped));
                        REQUIRE(image.pixels.size() == n);
                        CHECK(image.pixels[0].r == scale * values[0]);
                        CHECK(image.pixels[n - 1].g == scale * values[n == 1 ? 1 : 2]);
                        CHECK(image.pixels[n - 1].b == scale * 3);
                    }
    }

    TEST_CASE("truth: codes of sRGB, what lies outside them, and a .ppm file with all 256") {
        // From IEC 61966-2-1: linear below 0.0031308, then 1.055 x^(1/2.4) - 0.055.
        for (auto [x, code] : {std::pair(0.5f, 188),
                               {0.18f, 118},
                               {0.003f, 10},
                               {0.2158605f, 128},
                               {-1.0f, 0},
                               {7.0f, 255},
                               {std::nanf(""), 0},
                               {infinity, 255}})
            CHECK(to_srgb8(x) == code);
        TemporaryFolder folder;
        std::string ppm = "P6\n# a comment\n16 16\n255\n";
        for (int i = 0; i < 256; i++) ppm += std::string(3, static_cast<char>(i));
        write_image(folder / "b.ppm", decode_image("a.ppm", ppm), "");
        CHECK(read_file(folder / "b.ppm") == "P6\n16 16\n255\n" + ppm.substr(ppm.size() - 768));
    }

    TEST_CASE("truth: a .png file holds the picture, a comment without commands, and checksums") {
        Image image(5, 3);
        for (size_t i = 0; i < image.pixels.size(); i++)
            image.pixels[i] = Rgb{1, 0.25f, 0} * (static_cast<float>(i) / 15);
        std::string png = encode_png(image, "build/07 --paths 'L\xc3\xa4' \n --seed 1\x1b");
        CHECK(png.find(std::string("IHDR\0\0\0\5\0\0\0\3\x08\x02\0\0\0", 17)) == 12);
        CHECK(png.find(std::string("tEXtComment\0", 12) + "build/07 --paths 'L?"
                                                          "?' \n --seed 1?") == 37);
        CHECK(png.ends_with("IEND\xae\x42\x60\x82"));  // the checksum that all PNGs end with
        TemporaryFolder folder;
        write_image(folder / "a.ppm", image, "");
        CHECK(decode_image("a.png", png).pixels == read_image(folder / "a.ppm").pixels);
        for (size_t size = 8; size < png.find("IEND") - 8; size++)
            CHECK_THROWS_AS(decode_image("a.png", png.substr(0, size)), InputError);
        for (size_t bit = 0; bit < 8 * png.size(); bit++) {
            std::string damaged = png;
            damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ 1 << bit % 8);
            CHECK_THROWS_AS(decode_image("a.png", damaged), InputError);
        }
    }
}
