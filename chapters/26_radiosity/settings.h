// What the user asks for beside what all programs know.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "chapters/26_radiosity/variants.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/system.h"
#include "common/options/command_line.h"
#include "common/results/outputs.h"

namespace ch26 {

enum class Solver : uint8_t { southwell, gauss_seidel, jacobi };

/// What the user asks for beside what all programs know.
struct Settings {
    size_t patches = 5000;
    FormFactors way = FormFactors::contour;
    Solver solver = Solver::southwell;
    Show show = Show::smooth;
    uint64_t shots = 0;  // at most; 0: until little is unshot
    uint64_t every = 0;  // shots from one picture to the next; 0: none
    std::string mesh;    // .ply; empty: none
};

/// The options that set them.
inline std::vector<Option> own_options(Settings& s) {
    auto choice = [](const char* name, auto& value, const std::vector<std::string>& words) {
        return [=, &value](const std::string& text) {
            value = static_cast<std::decay_t<decltype(value)>>(parse_choice(name, text, words));
        };
    };
    auto number = [](const char* name, auto& value, int64_t most) {
        return [=, &value](const std::string& text) {
            value = static_cast<std::decay_t<decltype(value)>>(parse_integer(name, text, 1, most));
        };
    };
    return {
        {"patches", "N", "at least so many, beside those of spheres and disks (default 5000)",
         number("patches", s.patches, 1000000), "5000"},
        {"form-factors", "WAY", "point, chance or contour (default)",
         choice("form-factors", s.way, {"point", "chance", "contour"}), "contour"},
        {"solver", "KIND", "southwell (default: progressive), gauss-seidel or jacobi",
         choice("solver", s.solver, {"southwell", "gauss-seidel", "jacobi"}), "southwell"},
        {"show", "HOW", "constant patches, smooth (default), or a final gather",
         choice("show", s.show, {"constant", "smooth", "gather"}), "smooth"},
        {"shots", "N", "at most so many (default: until patches wait for 0.1 % of their light)",
         number("shots", s.shots, 1 << 30), "enough"},
        {"every", "K", "write a picture after each K shots: NAME-000100.png, ...",
         number("every", s.every, 1 << 30)},
        {"mesh", "FILE.ply", "also write the patches with their colours", [&](const auto& text) {
             if (!has_ending(text, ".ply")) fail_value("mesh", text, "a .ply file");
             s.mesh = text;
         }}};
}

/// Throws UsageError for what belongs to shots alone.
inline void check_together(const RenderOptions& options, const Settings& s) {
    if (s.solver == Solver::southwell) return;
    const char* name = !options.film.empty() ? "film"
                       : s.shots > 0         ? "shots"
                       : s.every > 0         ? "every"
                                             : nullptr;
    if (name) {
        throw UsageError(std::string("error: --") + name +
                         " is of shots: it needs --solver southwell");
    }
}

/// "out/room.png" with shots 100: "out/room-000100.png".
inline std::string numbered(const std::string& path, uint64_t shots) {
    char number[24];
    std::snprintf(number, sizeof number, "-%06llu", static_cast<unsigned long long>(shots));
    size_t dot = path.rfind('.');
    return path.substr(0, dot) + number + path.substr(dot);
}

/// Whether a file in the folder of the first picture has the name of one that --every may write.
inline bool is_numbered(const std::string& name, const std::string& path, const Settings& s) {
    std::string file = file_name(file_path(path).filename());
    size_t dot = file.rfind('.');
    if (name.size() <= dot || name.compare(0, dot, file, 0, dot) != 0) return false;
    uint64_t shots = std::strtoull(name.c_str() + dot + 1, nullptr, 10);
    bool is_written = shots > 0 && shots % s.every == 0 && (s.shots == 0 || shots <= s.shots);
    return is_written && name == numbered(file, shots);
}

/// Throws now what writing would throw later.
inline void check_all_outputs(const Scene& scene, const RenderOptions& options, const Settings& s) {
    std::vector<std::string> mesh;
    if (!s.mesh.empty()) mesh.push_back(s.mesh);
    IsWritten is_on_the_way;
    if (s.every > 0) {
        is_on_the_way = [&](const std::string& name) {
            return is_numbered(name, options.out[0], s);
        };
    }
    check_outputs(scene, options, mesh, is_on_the_way);
}

}  // namespace ch26
