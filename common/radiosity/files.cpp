#include "common/radiosity/files.h"

#include <cstring>

#include "common/base/checksum.h"
#include "common/base/files.h"
#include "common/base/position.h"
#include "common/picture/image.h"

namespace {

uint64_t checksum_of(std::string_view bytes) {
    Checksum sum;
    sum.add(bytes);
    return sum.value();
}

}  // namespace

void save_numbers(const std::string& path, const std::string& label, const Pieces& numbers,
                  FileLock* lock) {
    std::string bytes = label;
    for (auto piece : numbers)
        bytes.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    uint64_t sum = checksum_of(bytes);
    bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    write_file_atomically(path, bytes, lock);
}

void read_numbers(const std::string& path, const std::string& label, const Pieces& numbers) {
    std::string bytes = read_file(path);
    size_t size = label.size();
    for (auto piece : numbers) size += piece.size();
    size_t line = 0;
    if (bytes.compare(0, label.find('\n'), label, 0, label.find('\n')) != 0)
        fail({path}, "no film of radiosity");
    while (line < label.size()) {  // name the first line that differs
        size_t end = label.find('\n', line) + 1;
        std::string found = bytes.substr(line, bytes.find('\n', line) + 1 - line);
        std::string wanted = label.substr(line, end - line);
        if (found != wanted && wanted.starts_with("code "))
            fail({path}, "the film was made by other code of this chapter");
        if (found != wanted) {
            fail({path}, "it is of " + quote(found.substr(0, found.size() - 1)) + ", here it is " +
                             quote(wanted.substr(0, wanted.size() - 1)));
        }
        line = end;
    }
    uint64_t sum = 0;
    bool whole = bytes.size() == size + sizeof sum;
    if (whole) std::memcpy(&sum, bytes.data() + size, sizeof sum);
    if (!whole || sum != checksum_of(std::string_view(bytes).substr(0, size)))
        fail({path}, "the film is damaged");
    const char* from = bytes.data() + label.size();
    for (auto piece : numbers) {
        std::memcpy(piece.data(), from, piece.size());
        from += piece.size();
    }
}

void write_mesh(const std::string& path, const Triangles& triangles, const CornerColours& B) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                        std::to_string(3 * triangles.size()) +
                        "\nproperty float x\nproperty float y\nproperty float z\n"
                        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                        "element face " +
                        std::to_string(triangles.size()) +
                        "\nproperty list uchar int vertex_indices\nend_header\n";
    for (size_t i = 0; i < triangles.size(); i++) {
        for (size_t c = 0; c < 3; c++) {
            Rgb L = B[i][c] / pi;
            bytes.append(reinterpret_cast<const char*>(&triangles[i][c]), sizeof(Vec3));
            for (float x : {L.r, L.g, L.b}) bytes += static_cast<char>(to_srgb8(x));
        }
    }
    for (int32_t i = 0; i < static_cast<int32_t>(triangles.size()); i++) {
        int32_t corners[] = {3 * i, 3 * i + 1, 3 * i + 2};
        bytes += '\3';
        bytes.append(reinterpret_cast<const char*>(corners), sizeof corners);
    }
    write_file_atomically(path, bytes);
}
