// What surrounds the lesson: the solution on disk, the mesh, pictures on the way, and the report.
#pragma once
#include <cstdio>
#include <filesystem>

#include "chapters/20_radiosity/estimator.h"
#include "chapters/20_radiosity/tessellate.h"
#include "common/base/checksum.h"
#include "common/base/files.h"
#include "common/base/percent.h"
#include "common/path/trace.h"
#include "common/picture/image.h"
#include "common/program/progress.h"
#include "common/program/render.h"
#include "common/program/results.h"
#include "common/program/tile_renderer.h"

namespace ch20 {

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
    auto choice = [](const char* name, auto& value, std::vector<std::string> words) {
        return [=, &value](const std::string& text) {
            value = static_cast<std::decay_t<decltype(value)>>(parse_choice(name, text, words));
        };
    };
    auto number = [](const char* name, auto& value, int64_t low) {
        return [=, &value](const std::string& text) {
            value =
                static_cast<std::decay_t<decltype(value)>>(parse_integer(name, text, low, 1 << 30));
        };
    };
    return {
        {"patches", "N", "at least so many (default 5000)", number("patches", s.patches, 1)},
        {"form-factors", "WAY", "point, chance or contour (default)",
         choice("form-factors", s.way, {"point", "chance", "contour"})},
        {"solver", "KIND", "southwell (default: progressive), gauss-seidel or jacobi",
         choice("solver", s.solver, {"southwell", "gauss-seidel", "jacobi"})},
        {"show", "HOW", "constant patches, smooth (default), or a final gather",
         choice("show", s.show, {"constant", "smooth", "gather"})},
        {"shots", "N", "at most so many (default: until 0.1 % of the light is unshot)",
         number("shots", s.shots, 1)},
        {"every", "K", "write a picture after each K shots: NAME-000100.png, ...",
         number("every", s.every, 1)},
        {"mesh", "FILE.ply", "also write the patches with their colours", [&](const auto& text) {
             if (!text.ends_with(".ply")) fail_value("mesh", text, "a .ply file");
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

/// Throws now what writing would throw later.
inline void check_all_outputs(const RenderOptions& options, const Settings& s) {
    check_outputs(options);
    if (s.mesh.empty()) return;
    check_outputs({s.mesh}, options.scene);
}

/// What a film of radiosity is of: all that decides the solution, but not how far it is.
inline std::string film_label(const Scene& scene, const RenderOptions& options,
                              const Settings& settings, size_t patches) {
    const char* ways[] = {"point", "chance", "contour"};
    char checksum[17];
    std::snprintf(checksum, sizeof checksum, "%016llx",
                  static_cast<unsigned long long>(scene.files_checksum));
    return std::string("radiosity of path-by-path, version 1\nscene ") + checksum + "\npatches " +
           std::to_string(patches) + "\nform-factors " + ways[static_cast<size_t>(settings.way)] +
           "\nseed " + std::to_string(options.seed) + "\n\n";
}

inline uint64_t checksum_of(std::string_view bytes) {
    Checksum sum;
    sum.add(bytes);
    return sum.value();
}

/// Writes the state of the shots: label, numbers, checksum. Throws InputError.
inline void save_solution(const std::string& path, const std::string& label, const Solution& s) {
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

/// Reads it into a solution of as many patches. Throws InputError for what is of something else, or
/// damaged.
inline void read_solution(const std::string& path, const std::string& label, Solution& s) {
    std::string bytes = read_file(path);
    size_t numbers = sizeof s.steps + sizeof s.escaped + 2 * s.H.size() * sizeof(Radiosity);
    size_t line = 0;
    if (bytes.compare(0, label.find('\n'), label, 0, label.find('\n')) != 0)
        fail({path}, "no film of radiosity");
    while (line < label.size()) {  // name the first line that differs
        size_t end = label.find('\n', line) + 1;
        std::string found = bytes.substr(line, bytes.find('\n', line) + 1 - line);
        std::string wanted = label.substr(line, end - line);
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
}

/// The solution as a mesh with a colour at each corner: .ply, binary, sRGB.
inline void write_mesh(const std::string& path, const Shown& shown) {
    const std::vector<Patch>& patch = shown.patches->patch;
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(3 * patch.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face " +
        std::to_string(patch.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (size_t i = 0; i < patch.size(); i++) {
        for (size_t c = 0; c < 3; c++) {
            Rgb L = shown.B[i][c] / pi;
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

/// "out/room.png" with shots 100: "out/room-000100.png".
inline std::string numbered(const std::string& path, uint64_t shots) {
    char number[24];
    std::snprintf(number, sizeof number, "-%06llu", static_cast<unsigned long long>(shots));
    size_t dot = path.rfind('.');
    return path.substr(0, dot) + number + path.substr(dot);
}

/// One run of the program: patches, solution, pictures.
class Run {
public:
    Run(const Scene& scene, const RenderOptions& options, const Settings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          limit_(options.time),
          patches_(
              std::make_shared<Patches>(make_patches(scene, settings.patches, options.threads))),
          rows_(scene, *patches_, settings.way, options.seed, options.threads) {
        refuse_no_loss(scene, *patches_);
        options_.film.clear(), options_.time = 0;  // they are of the solution, not of a picture
        film_ = options.film;
    }

    int run() {
        tell_costs();
        settings_.solver == Solver::southwell ? refine() : sweep();
        tell_result();
        double seconds = limit_.elapsed();
        bool stopped = limit_.interrupted();
        if (stopped) options_.time = 0.5;  // s: a picture soon
        Shown shown = shown_now(settings_.show);
        if (!settings_.mesh.empty()) write_mesh(settings_.mesh, shown);
        Rendering picture = render_film(scene_, options_, trace_with<trace>(shown));
        picture.stats.seconds += seconds;
        if (stopped) picture.stats.interrupted = true;
        return write_results(scene_, options_, picture);
    }

private:
    size_t n() const { return patches_->patch.size(); }
    Shown shown_now(Show how) const {
        return show(scene_, patches_, solution_, how, options_.threads);
    }

    /// Says what memory and time all form factors take, before they are worked out.
    void tell_costs() {
        auto begin = limit_.elapsed();
        constexpr size_t tried = 3;
        for (size_t i = 0; i < tried && n() > 0; i++) rows_.row(i * (n() - 1) / tried);
        double seconds = (limit_.elapsed() - begin) / tried * static_cast<double>(n());
        if (rows_.keeps()) seconds /= 2;  // each pair once
        double size = static_cast<double>(n());
        if (settings_.solver != Solver::southwell && !rows_.keeps()) {
            throw UsageError("error: --solver: the matrix of " + std::to_string(n()) +
                             " patches has more than 1 GiB; southwell needs none");
        }
        if (options_.quiet) return;
        std::printf(
            "%zu patches in %s room: %.3g million form factors, %.3g MB%s, about %.2g s for all\n",
            n(), patches_->closed ? "a closed" : "an open", size * size / 1e6,
            static_cast<double>(rows_.bytes()) / 1e6,
            rows_.keeps() ? "" : " (too many to keep: rows are worked out again)", seconds);
        std::fflush(stdout);
    }

    /// Progressive refinement, from the film if there is one.
    void refine() {
        const std::vector<Patch>& patch = patches_->patch;
        start(patch, solution_);
        std::string label = film_label(scene_, options_, settings_, n());
        std::error_code none;
        if (!film_.empty() && std::filesystem::exists(film_, none))
            read_solution(film_, label, solution_);
        Progress progress(options_.quiet);
        double saved = limit_.elapsed(), first = share_to_come(patch, solution_), last = 1;
        while (!limit_.reached() && (settings_.shots == 0 || solution_.steps < settings_.shots)) {
            // Asked after the same shots in whatever runs they are done.
            if (solution_.steps % 16 == 0) last = share_to_come(patch, solution_);
            if (settings_.shots == 0 && last < enough) break;
            if (!shoot(
                    *patches_, [&](size_t i) { return rows_.row(i); }, solution_))
                break;
            double by_share = std::log(last / first) / std::log(enough / first);
            double by_shots = settings_.shots == 0 ? 0
                                                   : static_cast<double>(solution_.steps) /
                                                         static_cast<double>(settings_.shots);
            progress.show(std::max(by_share, by_shots), limit_.elapsed());
            if (settings_.every > 0 && solution_.steps % settings_.every == 0) write_picture();
            if (!film_.empty() && limit_.elapsed() - saved > options_.film_every) {
                save_solution(film_, label, solution_);
                saved = limit_.elapsed();
            }
        }
        if (!film_.empty()) save_solution(film_, label, solution_);
    }
    void write_picture() {
        RenderOptions quiet = options_;
        quiet.quiet = true;
        Image image =
            render_film(scene_, quiet, trace_with<trace>(shown_now(Show::smooth))).film.image();
        write_image(numbered(options_.out[0], solution_.steps), image, options_.command);
    }

    /// The whole matrix, repaired, and sweeps over it.
    void sweep() {
        const std::vector<Patch>& patch = patches_->patch;
        Progress progress(options_.quiet);
        for (size_t i = 0; i < n() && !limit_.reached(); i++) {
            rows_.row(i);
            double left = 1 - static_cast<double>(i + 1) / static_cast<double>(n());
            progress.show(1 - left * left, limit_.elapsed());
        }
        solution_.H.resize(n());
        if (limit_.reached()) return;
        Matrix m = make_matrix(rows_, n());
        repair(m, patch, patches_->closed);
        auto stop = [&](double) { return limit_.reached(); };
        if (settings_.solver == Solver::jacobi) {
            solve(m, patch, 1e-10, solution_, sweep_jacobi, stop);
        } else {
            solve(m, patch, 1e-10, solution_, sweep_gauss_seidel, stop);
        }
        solution_.escaped = escaped_by(m, patch, solution_);
    }

    void tell_result() const {
        if (options_.quiet || n() == 0) return;
        const Faults& f = rows_.faults();
        std::printf(
            "row sums %.4f to %.4f before their repair; the two ends of a pair are %s apart\n",
            f.lowest, f.highest, percent(f.all > 0 ? f.apart / f.all : 0).c_str());
        Balance b = balance_of(patches_->patch, solution_);
        auto share = [&](double x) { return percent(std::max(0.0, x / b.emitted)); };  // not -0
        std::printf("%llu %s: of %.4g W %s absorbed, %s out of the room, %s unshot (off by %.1g)\n",
                    static_cast<unsigned long long>(solution_.steps),
                    settings_.solver == Solver::southwell ? "shots" : "sweeps", b.emitted,
                    share(b.absorbed).c_str(), share(b.escaped).c_str(), share(b.unshot).c_str(),
                    std::abs(b.error()));
    }

    static constexpr double enough = 1e-3;  // of the light: may be unshot at the end

    const Scene& scene_;
    RenderOptions options_;
    Settings settings_;
    std::string film_;
    Limit limit_;
    std::shared_ptr<Patches> patches_;
    Rows rows_;
    Solution solution_;
};

}  // namespace ch20
