#include "common/radiosity/files.h"

#include <algorithm>
#include <cmath>
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

void save_solution(const std::string& path, const std::string& label, const Solution& s) {
    std::string bytes = label;
    auto add = [&](const void* data, size_t size) {
        bytes.append(static_cast<const char*>(data), size);
    };
    add(&s.steps, sizeof s.steps);
    add(&s.escaped, sizeof s.escaped);
    add(s.H.data(), s.H.size() * sizeof(Radiosity));
    add(s.unshot.data(), s.unshot.size() * sizeof(Radiosity));
    uint64_t sum = checksum_of(bytes);
    add(&sum, sizeof sum);
    write_file_atomically(path, bytes);
}

void read_solution(const std::string& path, const std::string& label, Solution& s) {
    std::string bytes = read_file(path);
    size_t numbers = sizeof s.steps + sizeof s.escaped + 2 * s.H.size() * sizeof(Radiosity);
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
    bool whole = bytes.size() == label.size() + numbers + sizeof sum;
    if (whole) std::memcpy(&sum, bytes.data() + label.size() + numbers, sizeof sum);
    if (!whole || sum != checksum_of(std::string_view(bytes).substr(0, label.size() + numbers)))
        fail({path}, "the film is damaged");
    const char* from = bytes.data() + label.size();
    auto take = [&](void* data, size_t size) { std::memcpy(data, from, size), from += size; };
    take(&s.steps, sizeof s.steps);
    take(&s.escaped, sizeof s.escaped);
    take(s.H.data(), s.H.size() * sizeof(Radiosity));
    take(s.unshot.data(), s.unshot.size() * sizeof(Radiosity));
    auto is_light = [](Radiosity x) {
        return std::isfinite(sum_of(x)) && std::min({x.r, x.g, x.b}) >= 0;
    };
    auto all_light = [&](const std::vector<Radiosity>& values) {
        return std::all_of(values.begin(), values.end(), is_light);
    };
    if (!std::isfinite(sum_of(s.escaped)) || !all_light(s.H) || !all_light(s.unshot))
        fail({path}, "the film is damaged: it holds light that is negative or not finite");
}

void write_mesh(const std::string& path, const std::vector<Patch>& patch, const CornerB& B) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(3 * patch.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face " +
        std::to_string(patch.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (size_t i = 0; i < patch.size(); i++) {
        for (size_t c = 0; c < 3; c++) {
            Rgb L = B[i][c] / pi;
            bytes.append(reinterpret_cast<const char*>(&patch[i].p[c]), sizeof(Vec3));
            for (float x : {L.r, L.g, L.b}) bytes += static_cast<char>(to_srgb8(x));
        }
    }
    for (int32_t i = 0; i < static_cast<int32_t>(patch.size()); i++) {
        int32_t corners[] = {3 * i, 3 * i + 1, 3 * i + 2};
        bytes += '\3';
        bytes.append(reinterpret_cast<const char*>(corners), sizeof corners);
    }
    write_file_atomically(path, bytes);
}
