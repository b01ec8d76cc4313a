#include "common/program/results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/base/files.h"
#include "common/base/percent.h"

namespace {

std::string number(double value) {
    if (!std::isfinite(value)) return "null";
    char text[64];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::string quoted(const std::string& text) {
    std::string json = "\"";
    for (char c : text) {
        if (c == '"' || c == '\\') json += '\\';
        if (static_cast<unsigned char>(c) < 32) {
            json += ' ';
        } else {
            json += c;
        }
    }
    return json + "\"";
}

double largest_share(const Rendering& r) {
    double sum = r.film.mean() * static_cast<double>(r.film.samples());
    return sum > 0 ? r.stats.largest / sum : 0;
}

/// How many of the pixels have no sample.
double empty_share(const Film& film) {
    auto empty = [](const PixelSum& p) { return p.n == 0; };
    const std::vector<PixelSum>& pixels = film.pixels();
    return static_cast<double>(std::count_if(pixels.begin(), pixels.end(), empty)) /
           static_cast<double>(pixels.size());
}

std::string stats_json(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    const RenderStats& s = r.stats;
    Rgb mean = r.film.mean_rgb();
    double samples = static_cast<double>(r.film.samples());
    std::string json = "{\n";
    auto add = [&](const char* name, const std::string& value) {
        json += json.size() > 2 ? ",\n  \"" : "  \"";
        json += name;
        json += "\": ";
        json += value;
    };
    add("scene", quoted(scene.file));
    add("chapter", quoted(options.name));
    add("width", std::to_string(r.film.width));
    add("height", std::to_string(r.film.height));
    add("spp", number(r.film.spp()));
    add("max_depth", std::to_string(scene.max_depth));
    add("seed", std::to_string(options.seed));
    add("threads", std::to_string(options.threads));
    add("seconds", number(s.seconds));
    add("samples_per_second", number(samples / s.seconds));
    add("rays", std::to_string(s.rays));
    add("rays_per_second", number(static_cast<double>(s.rays) / s.seconds));
    add("mean", number(r.film.mean()));
    std::string rgb = "[";
    rgb += number(double{mean.r}) + ", " + number(double{mean.g}) + ", " + number(double{mean.b});
    add("mean_rgb", rgb + "]");
    add("standard_error", number(r.film.standard_error()));
    add("samples_not_finite", std::to_string(s.not_finite));
    add("paths_cut_by_depth", std::to_string(s.paths_cut));
    add("largest_sample", number(s.largest));
    add("largest_sample_share", number(largest_share(r)));
    add("effective_samples", number(r.film.effective_samples()));
    add("empty_pixels_share", number(empty_share(r.film)));
    add("interrupted", s.interrupted ? "true" : "false");
    return json + "\n}\n";
}

void print_summary(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    const RenderStats& s = r.stats;
    double samples = static_cast<double>(r.film.samples());
    std::printf("%s  %s  %dx%d  %s spp%s\n", options.name.c_str(), scene.file.c_str(), r.film.width,
                r.film.height, number(r.film.spp()).c_str(), s.interrupted ? " (interrupted)" : "");
    double error = r.film.standard_error();
    if (std::isnan(error)) {
        std::printf("mean %.6f, standard error unknown%s\n", r.film.mean(),
                    r.film.spp() > 1 ? "" : " (1 sample)");
    } else {
        std::printf("mean %.6f +- %.6f\n", r.film.mean(), error);
    }
    if (double share = empty_share(r.film); share > 0) {
        std::printf("warning: it ended before %.3g %% of the pixels had a sample: they are black\n",
                    100 * share);
    }
    std::printf("%.2f s, %.2f M samples/s, %.2f M rays/s, %d threads\n", s.seconds,
                samples / s.seconds / 1e6, static_cast<double>(s.rays) / s.seconds / 1e6,
                options.threads);
    if (s.paths_cut > 0) {
        std::printf("depth limit %d cut %s of the paths\n", scene.max_depth,
                    percent(static_cast<double>(s.paths_cut) / samples).c_str());
    }
    if (largest_share(r) > 0.01) {
        std::printf("warning: one sample carries %s of the whole picture\n",
                    percent(largest_share(r)).c_str());
    }
    for (const std::string& path : options.out) std::printf("wrote %s\n", path.c_str());
}

void write_classes(const RenderOptions& options, const Rendering& r) {
    for (const auto& [path_class, film] : r.classes) {
        write_image(options.split + "/" + path_class + ".pfm", film.image(), options.command);
        if (!options.quiet) {
            std::printf("wrote %s/%s.pfm  mean %.6g\n", options.split.c_str(), path_class.c_str(),
                        film.mean());
        }
    }
}

}  // namespace

int write_results(const Scene& scene, const RenderOptions& options, const Rendering& r) {
    Image image = r.film.image();
    for (const std::string& path : options.out) write_image(path, image, options.command);
    if (!options.split.empty()) write_classes(options, r);
    if (!options.stats.empty()) {
        write_file_atomically(options.stats, stats_json(scene, options, r));
    }
    if (!options.quiet) print_summary(scene, options, r);
    if (r.stats.not_finite == 0) return r.stats.interrupted ? 3 : 0;
    std::fprintf(stderr, "error: %llu samples were not finite; to see one: %s --explain %d,%d,%d\n",
                 static_cast<unsigned long long>(r.stats.not_finite), options.command.c_str(),
                 r.stats.bad_x, r.stats.bad_y, r.stats.bad_sample);
    return 1;
}
