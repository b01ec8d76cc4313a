// merge OUT FILM...: adds the films of parts of one render, or of renders with different seeds.
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/text.h"
#include "common/picture/film_label.h"
#include "common/render/command_line.h"
#include "common/render/render.h"
#include "common/render/warnings.h"

namespace {

struct MergeOptions {
    std::string out;
    std::vector<std::string> films;
};

MergeOptions parse(int argc, char** argv) {
    MergeOptions o;
    std::vector<std::string> words;
    parse_options(argc, argv, "OUT FILM...",
                  "Adds films of one scene, by one chapter with the same options: parts of one "
                  "render, or renders\nwith different seeds. OUT is a .film, or a .pfm, .ppm or "
                  ".png picture of all their samples.\nParts make the same bytes as the whole, in "
                  "any order. The same samples twice are refused.",
                  {}, [&](const std::string& word) { words.push_back(word); });
    if (words.size() < 2) {
        throw UsageError("error: name what to write, and the films to add; --help says how");
    }
    o.out = words[0];
    o.films.assign(words.begin() + 1, words.end());
    if (!is_image_path(o.out) && !has_ending(o.out, film_ending)) {
        throw UsageError("error: OUT is a .film, .pfm, .ppm or .png file");
    }
    check_outputs({o.out}, o.films);
    return o;
}

void print_summary(const MergeOptions& o, const LabeledFilm& sum) {
    const auto& [label, film] = sum;
    std::printf("%zu films  %dx%d  %s spp\n%s\n", o.films.size(), film.width, film.height,
                json_number(film.spp()).c_str(), mean_and_error(film).c_str());
    std::vector<std::string> lines = label.missing();
    for (const std::string& line : warnings_of(film, label.counts)) lines.push_back(line);
    for (const std::string& line : lines) std::printf("warning: %s\n", line.c_str());
    std::printf("wrote %s\n", o.out.c_str());
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MergeOptions o = parse(argc, argv);
        LabeledFilm sum = read_film(o.films[0]);
        for (size_t i = 1; i < o.films.size(); i++) {
            add_film(sum, o.films[i], read_film(o.films[i]));
        }
        if (is_image_path(o.out)) {
            write_image(o.out, sum.film.image(), comment_of(notes_of(sum.label, sum.film.spp())));
        } else {
            FileLock lock(o.out);
            write_film(o.out, sum.label, sum.film);
        }
        print_summary(o, sum);
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
