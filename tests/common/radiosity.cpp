// Files and display of radiosity, and scenes that it refuses.
#include <doctest/doctest.h>

#include <cstring>

#include "common/base/files.h"
#include "common/path/sampler.h"
#include "common/picture/image.h"
#include "common/radiosity/files.h"
#include "common/radiosity/refuse.h"
#include "tests/support/folder.h"
#include "tests/support/scenes.h"

TEST_SUITE("radiosity files and display") {
    TEST_CASE("identity: numbers are read back bit for bit, and only by their own label") {
        TemporaryFolder folder;
        const std::string label = "radiosity of something\ncode 12\nscene 34\n\n",
                          file = folder / "a";
        std::vector<double> a = {1, 2, 3, 4, 5, 1e-300}, b = {0.1}, c(6), d(1);
        auto pieces = [](std::vector<double>& x, std::vector<double>& y) {
            return Pieces{std::as_writable_bytes(std::span(x)),
                          std::as_writable_bytes(std::span(y))};
        };
        save_numbers(file, label, pieces(a, b));
        read_numbers(file, label, pieces(c, d));
        CHECK(a == c);
        CHECK(b == d);
        auto error = [&](const std::string& wanted) {
            return error_of([&] { read_numbers(file, wanted, pieces(c, d)); });
        };
        CHECK(error("radiosity of other things\ncode 12\nscene 34\n\n") ==
              file + ": error: no film of radiosity");
        CHECK(error("radiosity of something\ncode 13\nscene 34\n\n") ==
              file + ": error: the film was made by other code of this chapter");
        CHECK(error("radiosity of something\ncode 12\nscene 35\n\n") ==
              file + ": error: it is of \"scene 34\", here it is \"scene 35\"");
        for (size_t size : {size_t{0}, size_t{5}, size_t{7}}) {
            c.resize(size);
            CHECK(error(label) == file + ": error: the film is damaged");
        }
    }

    TEST_CASE("truth: a mesh has each corner's place and colour, and faces in their order") {
        TemporaryFolder folder;
        Triangles triangles = {{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                               {{{5, 0, 0}, {6, 0, 0}, {5, 0, 1}}}};
        CornerColours B = {{{{pi, 0, 0}, {0, pi / 2, 0}, {0, 0, pi / 4}}},
                           {{{0, 0, 0}, {9, 9, 9}, {pi / 8, pi / 8, 0}}}};
        write_mesh(folder / "a.ply", triangles, B);
        std::string bytes = read_file(folder / "a.ply");
        const std::string head =
            "ply\nformat binary_little_endian 1.0\nelement vertex 6\nproperty float x\nproperty "
            "float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar "
            "blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
        REQUIRE(bytes.starts_with(head));
        REQUIRE(bytes.size() == head.size() + 6 * 15 + 2 * 13);
        const char* at = bytes.data() + head.size();
        for (size_t v = 0; v < 6; v++, at += 15) {
            Vec3 corner;
            std::memcpy(&corner, at, sizeof corner);
            CHECK(corner == triangles[v / 3][v % 3]);
            Rgb L = B[v / 3][v % 3] / pi;
            CHECK(static_cast<uint8_t>(at[12]) == to_srgb8(L.r));
            CHECK(static_cast<uint8_t>(at[13]) == to_srgb8(L.g));
            CHECK(static_cast<uint8_t>(at[14]) == to_srgb8(L.b));
        }
        for (int32_t i = 0; i < 6; i++) {
            if (i % 3 == 0) CHECK(*at++ == 3);
            CHECK(std::memcmp(at, &i, 4) == 0);
            at += 4;
        }
    }

    TEST_CASE("identity: no corner is negative, and a triangle cut off at 0 keeps its mean") {
        // A grid of 6 x 6 squares, most of them nearly black.
        Triangles triangles;
        for (float x = 0; x < 6; x++)
            for (float y = 0; y < 6; y++) {
                Vec3 a = {x, y, 0}, b = {x + 1, y, 0}, c = {x + 1, y + 1, 0}, d = {x, y + 1, 0};
                triangles.push_back({{a, b, c}}), triangles.push_back({{a, c, d}});
            }
        int cut_off = 0;
        for (uint32_t seed = 0; seed < 20; seed++) {
            CAPTURE(seed);
            std::vector<Rgb> own;
            for (uint32_t i = 0; i < triangles.size(); i++) {
                float u = to_unit_float(hash32(seed, i));
                own.push_back(u < 0.5f ? Rgb{0.1f, 0.5f, 0.01f} : Rgb{u, 9 * u * u, 50 * u});
            }
            auto everywhere = [](uint32_t, uint32_t) { return true; };
            CornerColours corner = smooth_corners(triangles, own, 1e-3f, everywhere, 1);
            // Smoothing is linear: of colours that are higher by 100, nothing is cut off.
            std::vector<Rgb> higher = own;
            for (Rgb& b : higher) b += Rgb{100, 100, 100};
            CornerColours uncut = smooth_corners(triangles, higher, 1e-3f, everywhere, 1);
            for (size_t i = 0; i < triangles.size(); i++)
                for (float Rgb::*channel : {&Rgb::r, &Rgb::g, &Rgb::b}) {
                    float mean = 0, least = infinity;
                    for (Rgb b : corner[i])
                        mean += b.*channel / 3, least = std::min(least, b.*channel);
                    CHECK(least >= 0);
                    float sum = 0, lowest = infinity;
                    for (Rgb b : uncut[i])
                        sum += b.*channel - 100, lowest = std::min(lowest, b.*channel - 100);
                    float below = sum / 3 - lowest, keep = std::min(own[i].*channel / below, 1.0f);
                    for (size_t c = 0; c < 3 && lowest < -1e-4f; c++) {
                        float off = uncut[i][c].*channel - 100 - sum / 3;
                        CHECK(std::abs(corner[i][c].*channel - own[i].*channel - keep * off) <
                              2e-4f);
                    }
                    if (least > 1e-6f * mean) continue;
                    cut_off++;
                    CHECK(mean == doctest::Approx(own[i].*channel).epsilon(1e-4).scale(0));
                }
        }
        CHECK(cut_off > 100);
    }

    TEST_CASE("truth: a surface of one colour stays so, whatever the sizes of its triangles") {
        Triangles triangles;
        for (float x : {1.0f, 2.0f, 4.0f, 8.0f}) {
            Vec3 a = {x, 0, 0}, b = {2 * x, 0, 0}, c = {2 * x, 3, 0}, d = {x, 3, 0};
            triangles.push_back({{a, b, c}}), triangles.push_back({{a, c, d}});
        }
        Rgb own = {0.5f, 1, 20};
        auto everywhere = [](uint32_t, uint32_t) { return true; };
        for (const auto& corners :
             smooth_corners(triangles, std::vector<Rgb>(8, own), 1e-3f, everywhere, 1)) {
            for (Rgb b : corners)
                for (float Rgb::*channel : {&Rgb::r, &Rgb::g, &Rgb::b})
                    CHECK(b.*channel == doctest::Approx(own.*channel).epsilon(1e-5).scale(0));
        }
    }

    TEST_CASE("input: mirrors of any shape are refused, with the place of their material") {
        for (const char* shape : {"Shape \"sphere\"", "Shape \"disk\""}) {
            Scene scene = world_of("AreaLightSource \"diffuse\"\n" + square(0, true) +
                                   "  Material \"conductor\"\n" + shape);
            CHECK(error_of([&] { refuse(scene); }) ==
                  "test.pbrt:7:3: error: radiosity knows diffuse surfaces alone (LD*E): a mirror "
                  "sends light on by direction");
        }
    }
}
