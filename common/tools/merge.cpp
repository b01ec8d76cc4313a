// merge OUT FILM...: adds the films of parts of one render, or of renders with different seeds.
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/json.h"
#include "common/picture/notes.h"
#include "common/render/command_line.h"
#include "common/render/render.h"
#include "common/render/warnings.h"

namespace {

std::vector<std::string> warnings_of(const LabeledFilm& sum) {
    std::vector<std::string> lines = sum.label.missing();
    for (const std::string& line : warnings_of(sum.film, sum.label.counts)) lines.push_back(line);
    return lines;
}

std::string stats_json(const LabeledFilm& sum) {
    const auto& [label, film] = sum;
    JsonObject json;
    json.add("notes", lines_of(notes_of(label, film.spp())));
    json.add("spp", film.spp());
    json.add("rays", label.counts.rays);
    json.add("mean", film.mean());
    json.add("standard_error", film.standard_error());
    json.add("samples_not_finite", label.counts.not_finite);
    json.add("warnings", warnings_of(sum));
    return json.text();
}

void write_sum(const std::string& path, const LabeledFilm& sum) {
    if (is_image_path(path))
        return write_image(path, sum.film.image(), comment_of(notes_of(sum.label, sum.film.spp())));
    FileLock lock(path);
    write_film(path, sum.label, sum.film);
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        std::vector<std::string> words;
        std::string stats;
        parse_options(
            argc, argv, "OUT FILM...",
            "Adds films of one scene, by one chapter with the same options: parts of one render, "
            "or renders\nwith different seeds. OUT is a .film, or a .pfm, .ppm or .png picture of "
            "all their samples.\nParts make the same bytes as the whole, in any order. The same "
            "samples twice are refused.",
            {text_option("stats", "FILE.json", "write samples, mean and standard error", stats)},
            [&](const std::string& word) { words.push_back(word); });
        if (words.size() < 2)
            throw UsageError("error: name what to write, and the films to add; --help says how");
        std::string out = words[0];
        std::vector<std::string> films(words.begin() + 1, words.end()), written = {out};
        if (!is_image_path(out) && !has_ending(out, film_ending))
            throw UsageError("error: OUT is a .film, .pfm, .ppm or .png file");
        if (!stats.empty()) written.push_back(stats);
        check_outputs(written, films);

        LabeledFilm sum = read_film(films[0]);
        for (size_t i = 1; i < films.size(); i++) add_film(sum, films[i], read_film(films[i]));
        std::vector<Output> outputs = {{out, [&] { write_sum(out, sum); }}};
        if (!stats.empty())
            outputs.push_back({stats, [&] { write_file_atomically(stats, stats_json(sum)); }});
        write_outputs(outputs);
        std::printf("%zu films  %dx%d  %s spp\n%s\n", films.size(), sum.film.width, sum.film.height,
                    json_number(sum.film.spp()).c_str(), mean_and_error(sum.film).c_str());
        for (const std::string& line : warnings_of(sum)) std::printf("warning: %s\n", line.c_str());
        std::printf("wrote %s\n", out.c_str());
        const SampleCounts& counts = sum.label.counts;
        if (counts.not_finite == 0) return 0;
        std::fprintf(stderr,
                     "error: %llu samples were not finite; to see one, render with --seed %u "
                     "--explain %d,%d,%d\n",
                     static_cast<unsigned long long>(counts.not_finite), counts.bad_seed,
                     counts.bad_x, counts.bad_y, counts.bad_sample);
        return 1;
    });
}
