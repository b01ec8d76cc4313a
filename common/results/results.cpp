#include "common/results/results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/json.h"
#include "common/base/percent.h"
#include "common/base/position.h"
#include "common/base/report.h"
#include "common/options/command_line.h"
#include "common/picture/notes.h"
#include "common/rendering/film_keeping.h"
#include "common/results/class_sheet.h"
#include "common/results/warnings.h"
#include "common/scene/origin.h"

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
    Rgb mean_rgb = r.film.mean_rgb();
    double sum = r.film.mean() * static_cast<double>(r.film.samples());
    double pixels = static_cast<double>(r.film.pixels().size());
    JsonObject json;
    json.add("scene", scene.origin->file);
    json.add("chapter", options.name);
    json.add("width", r.film.width);
    json.add("height", r.film.height);
    json.add("spp", r.film.spp());
    json.add("max_depth", scene.max_depth);
    json.add("seed", uint64_t{options.seed});
    json.add("notes", lines_of(notes_of(scene, options, r)));
    std::vector<std::string> stand_ins;
    for (const UsedStandIn& used : scene.origin->stand_ins)
        stand_ins.push_back(printable(used.text()));
    if (!stand_ins.empty()) json.add("stand_ins", stand_ins);
    json.add("threads", options.threads);
    json.add("seconds", s.seconds);
    json.add("samples_per_second", per_second(r.film.samples(), s.samples_before, s));
    json.add("rays", s.rays);
    json.add("rays_per_second", per_second(s.rays, s.rays_before, s));
    json.add("mean", r.film.mean());
    json.add("mean_rgb",
             std::vector<double>{double{mean_rgb.r}, double{mean_rgb.g}, double{mean_rgb.b}});
    json.add("standard_error", r.film.standard_error());
    json.add("samples_not_finite", s.not_finite);
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
    std::printf("%s  %s  %dx%d  %s spp%s\n", options.name.c_str(),
                printable(scene.origin->file).c_str(), r.film.width, r.film.height,
                json_number(r.film.spp()).c_str(), s.interrupted ? " (interrupted)" : "");
    for (const UsedStandIn& used : scene.origin->stand_ins) {
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

/// The files of a render. What is to be said of each that was written is added to `told`.
class Outputs {
public:
    Outputs(const Scene& scene, const RenderOptions& options, const Rendering& r)
        : scene_(scene), options_(options), r_(r) {
        if (!options.film.empty()) add(options.film, [&] { save_film(scene, options, r); });
        for (const std::string& path : options.out) add_image(path, [&] { return r.film.image(); });
        for (const auto& [path, picture] : options.pictures)
            add_image(path, [&, &picture = picture] { return picture(r.film); });
        if (!options.split.empty()) add_classes();
        if (options.stats.empty()) return;
        add(options.stats,
            [&] { write_file_atomically(options.stats, stats_json(scene, options, r)); });
    }

    /// Throws InputError for those that could not be written.
    void write() { write_outputs(std::move(outputs_)); }
    const std::string& told() const { return told_; }

private:
    void add(const std::string& path, const std::function<void()>& write,
             const std::string& note = "") {
        outputs_.push_back({path, [=, this] {
                                bool is_large = r_.film.pixels().size() >= 1 << 20;
                                if (is_large && !options_.quiet) tell("writing " + path + "\n");
                                write();
                                told_ += "wrote " + path + note + "\n";
                            }});
    }
    void add_image(const std::string& path, const std::function<Image()>& image,
                   const std::string& note = "") {
        add(
            path,
            [=, this] { write_image(path, image(), comment_of(notes_of(scene_, options_, r_))); },
            note);
    }

    /// A picture of each class as .pfm and .png, and all of them as one sheet.
    void add_classes() {
        for (const auto& [path_class, film] : r_.classes) {
            std::string name = options_.split + "/" + path_class;
            auto write = [this, &path_class = path_class, &film = film](const std::string& path) {
                write_image(path, film.image(),
                            comment_of(notes_of(scene_, options_, r_, path_class)));
            };
            add(
                name + ".pfm", [=] { write(name + ".pfm"); },
                "  mean " + (std::isfinite(film.mean()) ? json_number(film.mean()) : "unknown"));
            outputs_.push_back({name + ".png", [=] { write(name + ".png"); }});
        }
        add_image(
            options_.split + "/classes.png", [this] { return class_sheet(r_.classes); },
            "  all of them with their shares; each also as .png");
    }

    const Scene& scene_;
    const RenderOptions& options_;
    const Rendering& r_;
    std::vector<Output> outputs_;
    std::string told_;
};

}  // namespace

std::string mean_and_error(const Film& film) {
    double mean = film.mean(), error = film.standard_error();
    if (!std::isfinite(mean)) return "mean unknown: not all samples are finite";
    char text[800];
    if (std::isnan(error)) {
        std::snprintf(text, sizeof text, "mean %.6f, standard error unknown%s", mean,
                      film.spp() > 1 ? "" : " (1 sample)");
    } else {
        std::snprintf(text, sizeof text, "mean %.6f +- %.6f", mean, error);
    }
    return text;
}

/// The command without the options that --explain does not accept.
std::string without_film(std::string command) {
    for (const char* option : {" --film", " --part"}) {  // and --film-every
        for (size_t at; (at = command.find(option)) != std::string::npos;) {
            size_t value = command.find_first_of("= ", at + 1) + 1;
            bool quoted = command[value] == '\'';
            size_t end = command.find(quoted ? '\'' : ' ', value + 1) + (quoted ? 1 : 0);
            command.erase(at, end - at);
        }
    }
    return command;
}

int write_results(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    std::string errors = r.error.empty() ? "" : r.error + "\n";
    Outputs outputs(scene, options, r);
    try {
        outputs.write();
    } catch (const InputError& error) {
        errors += error.what() + std::string("\n");
    }
    if (!options.quiet) {
        print_summary(scene, options, r);
        std::fputs(outputs.told().c_str(), stdout);
    }
    if (r.stats.not_finite > 0) {
        errors += "error: " + std::to_string(r.stats.not_finite) +
                  " samples were not finite; to see one: " + without_film(options.command) +
                  " --explain " + std::to_string(r.stats.bad_x) + ',' +
                  std::to_string(r.stats.bad_y) + ',' + std::to_string(r.stats.bad_sample) + '\n';
    }
    tell(errors);
    if (!errors.empty()) return 1;
    return r.stats.interrupted ? 3 : 0;
}
