#include "common/results/results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/json.h"
#include "common/base/percent.h"
#include "common/base/position.h"
#include "common/base/regex.h"
#include "common/options/command_line.h"
#include "common/picture/finite_part.h"
#include "common/picture/notes.h"
#include "common/rendering/film_keeping.h"
#include "common/results/class_sheet.h"
#include "common/results/warnings.h"

namespace {

/// Samples per second (or rays per second) of this run only.
double per_second(uint64_t all, uint64_t before, const RenderStats& s) {
    return static_cast<double>(all - before) / s.seconds;
}

/// The notes of a picture. A picture of one class of paths has the notes of a render with --paths.
Notes notes_of(const Scene& scene, const RenderOptions& options, const Rendering& r,
               const std::string& path_class = "") {
    RenderOptions whole = options;
    if (!path_class.empty()) whole.paths = path_class;
    return notes_of(label_of(scene, whole, r), r.film.spp());
}

std::string stats_json(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    const RenderStats& s = r.stats;
    FinitePart finite = finite_part(r.film);
    double sum = r.film.mean() * static_cast<double>(r.film.samples());
    double pixels = static_cast<double>(r.film.pixels().size());
    JsonObject json;
    json.add("scene", scene.file);
    json.add("chapter", options.name);
    json.add("width", r.film.width);
    json.add("height", r.film.height);
    json.add("spp", r.film.spp());
    json.add("max_depth", scene.max_depth);
    json.add("seed", uint64_t{options.seed});
    json.add("notes", lines_of(notes_of(scene, options, r)));
    std::vector<std::string> stand_ins;
    for (const UsedStandIn& used : scene.stand_ins) stand_ins.push_back(printable(used.text()));
    if (!stand_ins.empty()) json.add("stand_ins", stand_ins);
    json.add("threads", options.threads);
    json.add("seconds", s.seconds);
    json.add("samples_per_second", per_second(r.film.samples(), s.samples_before, s));
    json.add("rays", s.rays);
    json.add("rays_per_second", per_second(s.rays, s.rays_before, s));
    json.add("mean", finite.mean);
    json.add("mean_rgb",
             std::vector<double>{double{finite.rgb.r}, double{finite.rgb.g}, double{finite.rgb.b}});
    json.add("standard_error", finite.error);
    json.add("samples_not_finite", s.not_finite);
    json.add("pixels_not_finite_share", 1 - finite.share);
    json.add("paths_cut_by_depth", s.paths_cut);
    json.add("largest_sample", s.largest);
    json.add("largest_sample_share", sum > 0 ? s.largest / sum : 0);
    json.add("effective_samples", r.film.effective_samples());
    json.add("empty_pixels_share", static_cast<double>(r.film.empty_pixels()) / pixels);
    json.add("warnings", warnings_of(scene, options, r));
    if (s.first_radius > 0) json.add("first_radius", s.first_radius);
    json.add("interrupted", s.interrupted);
    return json.text();
}

void print_summary(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    const RenderStats& s = r.stats;
    double samples = static_cast<double>(r.film.samples());
    std::printf("%s  %s  %dx%d  %s spp%s\n", options.name.c_str(), printable(scene.file).c_str(),
                r.film.width, r.film.height, json_number(r.film.spp()).c_str(),
                s.interrupted ? " (interrupted)" : "");
    for (const UsedStandIn& used : scene.stand_ins) {
        std::printf("stand-in: %s\n", printable(used.text()).c_str());
    }
    std::printf("%s\n", mean_and_error(r.film).c_str());
    for (const std::string& line : warnings_of(scene, options, r)) {
        std::printf("warning: %s\n", line.c_str());
    }
    if (s.first_radius > 0) std::printf("first radius %.3g m\n", s.first_radius);
    std::printf("%.2f s, %.2f M samples/s, %.2f M rays/s, %d threads\n", s.seconds,
                per_second(r.film.samples(), s.samples_before, s) / 1e6,
                per_second(s.rays, s.rays_before, s) / 1e6, options.threads);
    if (s.paths_cut > 0) {
        std::printf("depth limit %d cut %s of the paths\n", scene.max_depth,
                    percent(static_cast<double>(s.paths_cut) / samples).c_str());
    }
}

/// Writes the results one by one; if one fails, the others are still written. Prints a message
/// before steps that may take some time.
class Writer {
public:
    Writer(bool quiet, bool is_large) : quiet_(quiet), is_large_(is_large) {}

    template <typename Write>
    void write(const std::string& path, const Write& write, const std::string& note = "") {
        try {
            if (!quiet_ && is_large_) std::fprintf(stderr, "writing %s\n", path.c_str());
            write();
            if (!quiet_) std::printf("wrote %s%s\n", path.c_str(), note.c_str());
        } catch (const InputError& error) {
            std::fprintf(stderr, "%s\n", error.what());
            failed_ = true;
        } catch (const std::bad_alloc&) {
            std::fprintf(stderr, "%s: error: cannot write: out of memory\n", path.c_str());
            failed_ = true;
        }
    }
    bool failed() const { return failed_; }

private:
    const bool quiet_, is_large_;
    bool failed_ = false;
};

/// A picture of each class as .pfm and .png, and all of them as one sheet.
void write_classes(const Scene& scene, const RenderOptions& options, const Rendering& r,
                   Writer& writer) {
    for (const auto& [path_class, film] : r.classes) {
        std::string name = options.split + "/" + path_class;
        writer.write(
            name + ".pfm",
            [&, &path_class = path_class, &film = film] {
                for (const char* kind : {".png", ".pfm"}) {
                    write_image(name + kind, film.image(),
                                comment_of(notes_of(scene, options, r, path_class)));
                }
            },
            "  " + (std::isfinite(film.mean()) ? "mean " + json_number(film.mean())
                                               : mean_and_error(film)));
    }
    std::string path = options.split + "/classes.png";
    writer.write(
        path,
        [&] { write_image(path, class_sheet(r.classes), comment_of(notes_of(scene, options, r))); },
        "  all of them with their shares; each also as .png");
}

bool write_files(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    Writer writer(options.quiet, r.film.pixels().size() >= 1 << 20);
    if (!options.film.empty()) {
        writer.write(options.film, [&] { save_film(scene, options, r); });
    }
    for (const auto& [path, write] : r.files) writer.write(path, write);
    Image image = r.film.image();
    Notes notes = notes_of(scene, options, r);
    for (const std::string& path : options.out) {
        writer.write(path, [&] { write_image(path, image, comment_of(notes)); });
    }
    for (const auto& [path, picture] : options.pictures) {
        writer.write(path, [&, &path = path, &picture = picture] {
            write_image(path, picture(r.film), comment_of(notes));
        });
    }
    if (!options.split.empty()) write_classes(scene, options, r, writer);
    if (!options.stats.empty()) {
        writer.write(options.stats,
                     [&] { write_file_atomically(options.stats, stats_json(scene, options, r)); });
    }
    return !writer.failed();
}

}  // namespace

std::string mean_and_error(const Film& film) {
    FinitePart finite = finite_part(film);
    if (finite.share == 0) return "mean unknown: every pixel has samples that are not finite";
    std::string of_others = finite.share == 1
                                ? ""
                                : " without the " + percent(1 - finite.share) +
                                      " of the pixels that have samples that are not finite";
    char text[800];
    if (std::isnan(finite.error)) {
        std::snprintf(text, sizeof text, "mean %.6f, standard error unknown%s", finite.mean,
                      film.spp() > 1 ? "" : " (1 sample)");
    } else {
        std::snprintf(text, sizeof text, "mean %.6f +- %.6f", finite.mean, finite.error);
    }
    return text + of_others;
}

int write_results(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    if (!options.quiet) print_summary(scene, options, r);
    bool all_written = write_files(scene, options, r);
    flush_stdout();  // while signals are still handled
    if (r.stats.not_finite == 0 && all_written) return r.stats.interrupted ? 3 : 0;
    if (r.stats.not_finite == 0) return 1;
    // The command without the options that --explain does not accept.
    const char* film_words = " --(film|film-every|part)(=| )('[^']*'|[^ ]*)";
    std::string command = replace_each(options.command, film_words, "");
    std::fprintf(stderr, "error: %llu samples were not finite; to see one: %s --explain %d,%d,%d\n",
                 static_cast<unsigned long long>(r.stats.not_finite), command.c_str(),
                 r.stats.bad_x, r.stats.bad_y, r.stats.bad_sample);
    return 1;
}
