// PLY meshes: what is read, and what is refused.
#include "common/scene_file/ply.h"

#include <doctest/doctest.h>

#include "tests/support/described.h"
#include "tests/support/folder.h"

namespace {

const std::string square =
    "ply\nformat ascii 1.0\ncomment made by hand\nobj_info nothing\n"
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 .5 0 0 1\n1 0 .5 0 0 1\n\n1 1 5e-1 0 0 1\n0 1 .5 0 0 1\n4 0 1 2 3\n";

std::string refuse(const std::string& bytes) {
    return error_of([&] { parse_ply("mesh.ply", bytes); });
}

}  // namespace

TEST_SUITE("ply") {
    TEST_CASE("input: PLY as text is a square, however it is written, and cut off it is refused") {
        auto check = [](std::string text, const std::string& from, const std::string& to,
                        size_t normals = 4) {
            for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
                text.replace(at, from.size(), to);
            TriangleMesh mesh = parse_ply("mesh.ply", text);
            CHECK(mesh.positions ==
                  std::vector<Vec3>{{0, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0, 1, 0.5f}});
            CHECK(mesh.indices == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
            CHECK(mesh.normals == std::vector<Vec3>(normals, Vec3{0, 0, 1}));
            CHECK(mesh.uvs.empty());
        };
        check(square, "\n", "\r\n");
        check(square, "\n", "\r");
        check(square, "vertex_indices", "vertex_index");
        check(square, " 4 ", "\n4\n");
        check(square, "comment made by hand", "");
        check(square + "what follows is not read", "obj_info nothing\n", "");
        // A place in textures, by all the names that it has.
        for (auto [u, v] : {std::pair("u", "v"),
                            {"s", "t"},
                            {"texture_u", "texture_v"},
                            {"texture_s", "texture_t"}}) {
            std::string text = square;
            for (auto [from, to] : {std::pair("nx", u), {"nz", v}})
                text.replace(text.find(from), 2, to);
            TriangleMesh mesh = parse_ply("mesh.ply", text);
            REQUIRE(mesh.uvs.size() == 4);
            for (Vec2 uv : mesh.uvs) CHECK(uv.x + 2 * uv.y == 2);
        }
        check(square, "float nz", "float u", 0);  // normals and places that are not whole are none
        // A number that is cut short is a number, and so the last one may lose digits.
        for (size_t length = 0; length <= square.rfind('3'); length++) {
            CAPTURE(length);
            CHECK(refuse(square.substr(0, length)) != "");
        }
        CHECK(refuse(square.substr(0, square.size() - 1)) == "");
    }

    TEST_CASE("identity: PLY of any format and types is read as it was written") {
        for (const std::string format : ply_formats)
            for (const PlyScalar& type : ply_scalars)
                for (const PlyScalar& index : ply_scalars) {
                    if (index.is_float) continue;
                    std::string bytes =
                        "ply\nformat " + format + " 1.0\nelement camera 1\nproperty list ";
                    auto put = [&](const PlyScalar& as, double value) {
                        if (format == ply_formats[0]) bytes += std::to_string(int(value)) + ' ';
                        uint64_t bits =
                            !as.is_float   ? static_cast<uint64_t>(static_cast<int64_t>(value))
                            : as.size == 8 ? std::bit_cast<uint64_t>(value)
                                           : std::bit_cast<uint32_t>(static_cast<float>(value));
                        for (size_t i = 0; format != ply_formats[0] && i < as.size; i++) {
                            size_t byte = format == ply_formats[1] ? i : as.size - 1 - i;
                            bytes += static_cast<char>(bits >> (8 * byte) & 255);
                        }
                    };
                    const std::string name = type.name, other = index.other_name;
                    bytes += other + ' ' + name + " values\nelement vertex 3\nproperty " + name +
                             " x\nproperty " + other + " y\nproperty " + type.other_name +
                             " z\nelement face 1\nproperty list " + index.name + ' ' + other +
                             " vertex_indices\nend_header\n";
                    put(index, 2), put(type, 7), put(type, 8);
                    float sign = type.is_signed ? -1 : 1;
                    for (double k : {1, 2, 3})
                        put(type, sign * k), put(index, 10 * k), put(type, 40 * k);
                    for (int value : {3, 2, 0, 1}) put(index, value);
                    CAPTURE(bytes);
                    TriangleMesh mesh = parse_ply("mesh.ply", bytes);
                    CHECK(mesh.positions == std::vector<Vec3>{{sign, 10, 40},
                                                              {2 * sign, 20, 80},
                                                              {3 * sign, 30, 120}});
                    CHECK(mesh.indices == std::vector<uint32_t>{2, 0, 1});
                }
    }

    TEST_CASE("input: every malformed PLY is refused with its message and place") {
        auto cases = read_malformed_cases("tests/support/malformed/ply.txt");
        CHECK(cases.size() >= 30);
        for (const MalformedCase& c : cases) CHECK(refuse(c.input) == c.message);
    }

    TEST_CASE("input: a header that lies makes nothing large, and names the byte") {
        auto little = [](const std::string& elements) {
            return "ply\nformat binary_little_endian 1.0\n" + elements + "end_header\n";
        };
        const std::string vertex = "property float x\nproperty float y\nproperty float z\n",
                          face = "element face 1\nproperty list uchar int vertex_indices\n",
                          one = "element vertex 1\n" + vertex + face, origin(12, '\0'),
                          corners("\3\0\0\0\0\0\0\0\0\0\0\0\0", 13), header = little(one);
        CHECK(refuse(little("element vertex 60000000\n" + vertex + face) + origin)
                  .find(": error: the file ends too early at byte ") == 8);
        CHECK(refuse(little("element big 1\nproperty list uint char values\n" + one) +
                     "\xff\xff\xff\xff" + origin)
                  .find(": error: the file is too short for 4294967295 values") == 8);
        CHECK(refuse(header + origin + "\1") != "");
        CHECK(refuse(header + origin + corners) == "");
    }
}
