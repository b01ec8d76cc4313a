#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/progress.h"
#include "common/base/system.h"
#include "common/picture/drawing.h"
#include "common/render/render.h"
#include "common/scene/prepare.h"

namespace {

/// Samples per second (or rays per second) of this run only.
double per_second(uint64_t all, uint64_t before, const RenderStats& s) {
    return static_cast<double>(all - before) / s.seconds;
}

/// The statistics as one level of JSON, a line for each value.
std::string stats_json(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    const RenderStats& s = r.stats;
    Rgb mean = r.film.mean_rgb();
    double pixels = static_cast<double>(r.film.pixels().size());
    std::string lines;
    auto add = [&](const std::string& name, const std::string& value) {
        lines += (lines.empty() ? "  " : ",\n  ") + json_quoted(name) + ": " + value;
    };
    auto add_texts = [&](const std::string& name, std::vector<std::string> texts) {
        for (std::string& text : texts) text = json_quoted(text);
        add(name, '[' + listed(texts) + ']');
    };
    add("scene", json_quoted(scene.origin->file));
    add("spp", json_number(r.film.spp()));
    add_texts("notes", lines_of(notes_of(label_of(scene, options, &r), r.film.spp())));
    add("threads", std::to_string(options.threads));
    add("seconds", json_number(s.seconds));
    add("rays", std::to_string(s.rays));
    add("rays_per_second", json_number(per_second(s.rays, s.rays_before, s)));
    add("mean", json_number(r.film.mean()));
    add("mean_rgb", '[' + json_number(double{mean.r}) + ", " + json_number(double{mean.g}) + ", " +
                        json_number(double{mean.b}) + ']');
    add("standard_error", json_number(r.film.standard_error()));
    add("samples_not_finite", std::to_string(s.not_finite));
    add("paths_cut_by_depth", std::to_string(s.paths_cut));
    add("largest_sample", json_number(s.largest));
    add("largest_sample_at", json_quoted(s.largest_at ? s.largest_at->text() : ""));
    add("effective_samples", json_number(r.film.error().samples));
    add("empty_pixels_share", json_number(static_cast<double>(r.film.empty_pixels()) / pixels));
    add_texts("warnings", warnings_of(scene, options, r));
    add("interrupted", s.interrupted ? "true" : "false");
    return "{\n" + lines + "\n}\n";
}

void print_summary(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    const RenderStats& s = r.stats;
    double samples = static_cast<double>(r.film.samples());
    std::printf("%s  %s  %dx%d  %s spp%s\n", options.name.c_str(),
                printable(scene.origin->file).c_str(), r.film.width, r.film.height,
                json_number(r.film.spp()).c_str(), s.interrupted ? " (interrupted)" : "");
    for (const UsedStandIn& used : scene.origin->stand_ins)
        std::printf("stand-in: %s\n", printable(used.text()).c_str());
    std::printf("%s\n", mean_and_error(r.film).c_str());
    for (const std::string& line : warnings_of(scene, options, r))
        std::printf("warning: %s\n", line.c_str());
    if (s.first_radius > 0) std::printf("first radius %.3g m\n", s.first_radius);
    std::printf("%.2f s, %.2f M samples/s, %.2f M rays/s, %d threads\n", s.seconds,
                per_second(r.film.samples(), s.samples_before, s) / 1e6,
                per_second(s.rays, s.rays_before, s) / 1e6, options.threads);
    if (s.paths_cut > 0)
        std::printf("depth limit %d cut %s of the paths\n", scene.max_depth,
                    percent(static_cast<double>(s.paths_cut) / samples).c_str());
}

/// A tile for each class, brightest first, with its name and its share of the light. A dark class
/// is shown 2, 4, ... up to 64 times as bright, and its tile says so.
Image class_sheet(const std::map<std::string, Film>& classes) {
    constexpr int most_width = 320;  // pixels, of a tile
    std::multimap<double, const std::string*> order;
    double all = 0;
    for (const auto& [name, film] : classes) {
        double mean = std::isnan(film.mean()) ? 0 : film.mean();
        order.insert({-mean, &name});
        all += mean;
    }
    std::vector<Tile> tiles;
    for (const auto& [minus_mean, name] : order) {
        Image image = classes.at(*name).image();
        int times = 1;
        while (times < 64 && 2 * times * minus_mean >= order.begin()->first) times *= 2;
        for (Rgb& p : image.pixels) p *= static_cast<float>(times);
        int n = (std::max(image.width, image.height) + most_width - 1) / most_width;
        std::string shown = times == 1 ? "" : std::to_string(times) + "x as bright";
        tiles.push_back({shrunk(image, n), {*name + "  " + percent(-minus_mean / all), shown}});
    }
    double columns = std::ceil(std::sqrt(static_cast<double>(tiles.size())));
    return sheet(tiles, std::max(1, static_cast<int>(columns)));
}

/// The files of a render. What is to be said of each that was written is added to `told`.
std::vector<Output> outputs_of(const Scene& scene, const RenderOptions& options, const Rendering& r,
                               std::string& told) {
    std::vector<Output> outputs;
    auto add = [&](const std::string& path, const std::function<void()>& write,
                   const std::string& more = "") {
        outputs.push_back({path, [=, &told] {
                               write();
                               told += "wrote " + path + more + "\n";
                           }});
    };
    // A picture of one class of paths has the notes of a render with --paths.
    auto picture = [&](const std::string& path, const std::function<Image()>& image,
                       const std::string& path_class = "") {
        return [=, &scene, &options, &r] {
            RenderOptions whole = options;
            if (!path_class.empty()) whole.paths = path_class;
            FilmLabel label = label_of(scene, whole, &r);
            write_image(path, image(), comment_of(notes_of(label, r.film.spp())));
        };
    };
    if (!options.film.empty()) add(options.film, [&] { save_film(scene, options, r); });
    for (const std::string& path : options.out)
        add(path, picture(path, [&] { return r.film.image(); }));
    for (const auto& [path, image] : options.pictures)
        add(path, picture(path, [&, &image = image] { return image(r.film); }));
    for (const auto& [path_class, film] : r.classes) {
        std::string name = options.split + "/" + path_class;
        auto image = [&film = film] { return film.image(); };
        std::string mean = std::isfinite(film.mean()) ? json_number(film.mean()) : "unknown";
        add(name + ".pfm", picture(name + ".pfm", image), "  mean " + mean);
        outputs.push_back({name + ".png", picture(name + ".png", image, path_class)});
    }
    std::string sheet = options.split + "/classes.png";
    if (!options.split.empty())
        add(sheet, picture(sheet, [&] { return class_sheet(r.classes); }),
            "  all of them with their shares; each also as .png");
    if (!options.stats.empty())
        add(options.stats,
            [&] { write_file_atomically(options.stats, stats_json(scene, options, r)); });
    return outputs;
}

}  // namespace

std::string drawing_path(const RenderOptions& options) {
    return file_name(file_path(options.out[0]).replace_extension(".svg"));
}

void check_outputs(const Scene& scene, const RenderOptions& options) {
    std::vector<std::string> inputs(scene.origin->files.begin(), scene.origin->files.end());
    if (options.explain) return check_outputs({drawing_path(options)}, inputs);
    if (!options.film.empty()) check_writable(options.film);  // not to go on without it
    if (!options.split.empty()) make_folder(options.split);
    std::vector<std::string> files;
    std::string told;
    for (const Output& output : outputs_of(scene, options, {Film(1, 1), {}, {}}, told))
        files.push_back(output.first);
    check_outputs(files, inputs);
}

std::string mean_and_error(const Film& film) {
    double mean = film.mean(), error = film.standard_error();
    if (!std::isfinite(mean)) return "mean unknown: not all samples are finite";
    const char* why = film.spp() > 1 ? "" : " (1 sample)";
    if (std::isnan(error)) return format("mean %f, standard error unknown%s", mean, why);
    return format("mean %f +- %f", mean, error);
}

int write_results(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    std::string errors, told;
    try {
        write_outputs(outputs_of(scene, options, r, told));
    } catch (const InputError& error) {
        errors += error.what() + std::string("\n");
    }
    if (!options.quiet) {
        print_summary(scene, options, r);
        std::fputs(told.c_str(), stdout);
    }
    if (r.stats.not_finite > 0)
        errors += "error: " + std::to_string(r.stats.not_finite) +
                  " samples were not finite; to see one: " + options.command + " --explain " +
                  r.stats.bad.text() + '\n';
    tell(errors);
    if (!errors.empty()) return 1;
    return r.stats.interrupted ? 3 : 0;
}

std::string aligned(const Table& table) {
    std::vector<std::vector<std::string>> lines = table.rows;
    lines.insert(lines.begin(), table.columns);
    std::vector<size_t> widths(table.columns.size());
    for (const auto& cells : lines)
        for (size_t c = 0; c < cells.size(); c++) widths[c] = std::max(widths[c], cells[c].size());
    std::string text;
    for (const auto& cells : lines) {
        for (size_t c = 0; c < cells.size(); c++) {
            std::string space(widths[c] - cells[c].size(), ' ');
            text += c == 0 ? cells[c] + space : "  " + space + cells[c];
        }
        text.erase(text.find_last_not_of(' ') + 1);
        text += '\n';
    }
    return text;
}

double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
    double n = static_cast<double>(x.size()), u = 0, v = 0, uv = 0, uu = 0;
    for (size_t i = 0; i < x.size(); i++) {
        double log_x = std::log(x[i]), log_y = std::log(y[i]);
        u += log_x;
        v += log_y;
        uv += log_x * log_y;
        uu += log_x * log_x;
    }
    return n < 2 ? NAN : (n * uv - u * v) / (n * uu - u * u);
}

void write_results(const TableOptions& options, const Table& table, const std::string& notes,
                   const Image& picture) {
    if (!options.quiet) std::printf("%s\n%s", aligned(table).c_str(), notes.c_str());
    std::vector<Output> outputs;
    for (const std::string& path : options.out)
        outputs.push_back({path, [&] { write_image(path, picture, options.comment); }});
    write_outputs(outputs);
}
