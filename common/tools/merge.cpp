// merge OUT FILM...: adds the films of parts of one render, or of renders with different seeds.
#include <cstdio>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/base/text.h"
#include "common/render/render.h"

static int merge(const std::string& out, const std::vector<std::string>& films) {
    check_outputs({out}, films);
    LabeledFilm sum = read_film(films[0]);
    for (size_t i = 1; i < films.size(); i++) add_film(sum, films[i], read_film(films[i]));
    const auto& [label, film] = sum;
    if (is_image_path(out)) {
        write_image(out, film.image(), comment_of(notes_of(label, film.spp())));
    } else {
        FileLock lock = lock_of(out);
        write_film(out, label, film);
    }
    std::printf("%zu films  %dx%d  %s spp\n%s\n", films.size(), film.width, film.height,
                json_number(film.spp()).c_str(), mean_and_error(film).c_str());
    std::vector<std::string> lines = label.missing();
    for (const std::string& line : warnings_of(film, label.counts)) lines.push_back(line);
    for (const std::string& line : lines) std::printf("warning: %s\n", line.c_str());
    std::printf("wrote %s\n", out.c_str());
    const SampleCounts& counts = label.counts;
    if (counts.not_finite == 0) return 0;
    tell("error: " + std::to_string(counts.not_finite) +
         " samples were not finite; to see one, render with --seed " +
         std::to_string(counts.bad.seed) + " --explain " + counts.bad.text() + '\n');
    return 1;
}

int main(int argc, char** argv) {
    return run_program([&] {
        std::vector<std::string> words;
        parse_options(argc, argv, "OUT FILM...",
                      "Adds films of one scene, by one chapter with the same options: parts of one "
                      "render, or renders\nwith different seeds. OUT is a .film, or a .pfm, .ppm "
                      "or .png picture of all their samples.\nParts make the same bytes as the "
                      "whole, in any order. The same samples twice are refused.",
                      {}, [&](const std::string& word) { words.push_back(word); });
        if (words.size() < 2)
            throw UsageError("error: name what to write, and the films to add; --help says how");
        if (!is_image_path(words[0]) && !has_ending(words[0], film_ending))
            throw UsageError("error: OUT is a .film, .pfm, .ppm or .png file");
        return merge(words[0], {words.begin() + 1, words.end()});
    });
}
