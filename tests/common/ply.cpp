// PLY meshes: what is read, and what is refused.
#include "common/scene_file/ply.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/folder.h"
#include "tests/support/malformed.h"

namespace {

// The square of two ways to write it: two triangles over four corners with normals.
const std::vector<Vec3> corners = {{0, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0, 1, 0.5f}};

const std::string ascii_square =
    "ply\nformat ascii 1.0\ncomment made by hand\nobj_info nothing\n"
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 .5 0 0 1\n1 0 .5 0 0 1\n\n1 1 5e-1 0 0 1\n0 1 .5 0 0 1\n4 0 1 2 3\n";

void check_square(const TriangleMesh& mesh, bool with_normals) {
    CHECK(mesh.positions == corners);
    CHECK(mesh.indices == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
    CHECK(mesh.normals == std::vector<Vec3>(with_normals ? 4 : 0, Vec3{0, 0, 1}));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
        text.replace(at, from.size(), to);
    }
    return text;
}

std::string refuse(const std::string& bytes) {
    return error_of([&] { parse_ply("mesh.ply", bytes); });
}

}  // namespace

TEST_SUITE("ply") {
    TEST_CASE("input: PLY as text") {
        check_square(parse_ply("mesh.ply", ascii_square), true);
        check_square(parse_ply("mesh.ply", replaced(ascii_square, "\n", "\r\n")), true);
        check_square(parse_ply("mesh.ply", replaced(ascii_square, "\n", "\r")), true);
        check_square(
            parse_ply("mesh.ply", replaced(ascii_square, "vertex_indices", "vertex_index")), true);
        check_square(parse_ply("mesh.ply", replaced(ascii_square, " 4 ", "\n4\n")), true);
        check_square(parse_ply("mesh.ply", ascii_square + "what follows is not read"), true);
        // Normals that are not whole are none.
        check_square(parse_ply("mesh.ply", replaced(ascii_square, "float nz", "float curvature")),
                     false);
        // Without the last line end.
        check_square(parse_ply("mesh.ply", ascii_square.substr(0, ascii_square.size() - 1)), true);
    }

    TEST_CASE("input: faces of fewer than three corners are left out and counted, as in pbrt") {
        const std::string face = "4 0 1 2 3\n";
        std::string degenerate = replaced(replaced(ascii_square, "face 1", "face 5"), face,
                                          "0\n" + face + "2 0 1\n0\n1 3\n");
        TriangleMesh mesh = parse_ply("mesh.ply", degenerate);
        check_square(mesh, true);
        CHECK(mesh.faces_left_out == 4);
        CHECK(parse_ply("mesh.ply", ascii_square).faces_left_out == 0);
    }

    TEST_CASE("input: a mesh beyond the limits is refused before there is memory for it") {
        Limits limits;
        limits.vertices = 3;
        auto refuse_beyond = [&] {
            return error_of([&] { parse_ply("mesh.ply", ascii_square, limits); });
        };
        CHECK(refuse_beyond() == "mesh.ply:5:9: error: more than 3 vertex elements");
        limits.vertices = 4;
        CHECK(refuse_beyond() == "");
        limits.primitives = 0;
        CHECK(refuse_beyond() == "mesh.ply:12:9: error: more than 0 face elements");
    }

    TEST_CASE("input: every malformed PLY is refused with its message and place") {
        auto cases = read_malformed_cases("tests/support/malformed/ply.txt");
        CHECK(cases.size() >= 30);
        for (const MalformedCase& c : cases) CHECK(refuse(c.input) == c.message);
        CHECK(refuse("\x1f\x8b\x08") == "mesh.ply: error: compressed by gzip: unpack it first");
        CHECK(refuse("ply\nformat ascii 1.0\nelement vertex \xff\n") ==
              "mesh.ply:3:16: error: expected how many elements there are, not \"?\"");
    }

    TEST_CASE("input: a PLY that is cut off anywhere is refused") {
        // A number that is cut short is a number, and so the last one may lose digits.
        size_t last = ascii_square.rfind('3');
        for (size_t length = 0; length <= last; length++) {
            CAPTURE(length);
            CHECK(refuse(ascii_square.substr(0, length)) != "");
        }
    }

    TEST_CASE("input: damaged bytes are refused with the byte where reading stopped") {
        auto little = [](const std::string& elements, const std::string& body) {
            return "ply\nformat binary_little_endian 1.0\n" + elements + "end_header\n" + body;
        };
        const std::string vertex =
            "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
        const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
        const std::string origin(12, '\0');
        std::string header = little(vertex + face, "");
        auto at = [&](size_t offset) {
            return " at byte " + std::to_string(header.size() + offset);
        };

        CHECK(refuse(header + origin + std::string("\3\0\0\0\0\0\0\0\0\0\0\0\0", 13)) == "");
        CHECK(refuse(header + std::string("\0\0\xc0\x7f", 4) + origin.substr(4) + "\3") ==
              "mesh.ply: error: a vertex is not finite" + at(4));
        CHECK(refuse(header + origin + std::string("\3\0\0\0\0\1\0\0\0\0\0\0\0", 13)) ==
              "mesh.ply: error: vertex 1 of a face does not exist: there are 1" + at(21));
        // A header that lies makes nothing large: a count, an empty element, a list.
        CHECK(refuse(little("element vertex 999999999999999\nproperty float x\nproperty float y\n"
                            "property float z\n" +
                                face,
                            origin)) ==
              "mesh.ply:3:9: error: the file is too short for 999999999999999 \"vertex\" elements");
        CHECK(refuse(little("element nothing 999999999999999\n" + vertex + face,
                            origin + std::string("\3\0\0\0\0\0\0\0\0\0\0\0\0", 13))) == "");
        CHECK(refuse(little("element big 1\nproperty list uint char values\n" + vertex + face,
                            "\xff\xff\xff\xff" + origin))
                  .starts_with("mesh.ply: error: the file is too short for a list of this length"));
    }
}
