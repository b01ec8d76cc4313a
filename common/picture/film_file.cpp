#include "common/picture/film_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/base/checksum.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/system.h"

namespace {

/// The line that a film's file begins with, and what of it is the same in all versions.
constexpr std::string_view any_version = "film of path-by-path, version ",
                           first_line = "film of path-by-path, version 7\n";

std::string_view bytes_of(const std::vector<PixelSum>& sums) {
    return {reinterpret_cast<const char*>(sums.data()), sums.size() * sizeof(PixelSum)};
}

/// What decides which sums a film has.
std::array<int, 6> shape_of(const Film& film) {
    return {film.width,        film.height,        film.takes_splats(),
            film.has_halves(), film.has_batches(), film.has_audits()};
}

/// The file, ready to be read after its first line. Throws where it is not whole.
std::ifstream whole_film(const std::string& path) {
    check_film_is_file(path);
    errno = 0;
    std::ifstream file(file_path(path), std::ios::binary);
    if (!file) fail({path}, std::string("cannot read: ") + std::strerror(errno));
    std::string piece(1 << 16, '\0');
    auto next = [&](uint64_t most) {
        file.read(piece.data(),
                  static_cast<std::streamsize>(std::min<uint64_t>(most, piece.size())));
        return std::string_view(piece).substr(0, static_cast<size_t>(file.gcount()));
    };
    std::string_view line = next(first_line.size());
    if (!line.starts_with(any_version)) fail({path}, "not a film");
    if (line != first_line) fail({path}, "a film by another version of the program");
    Checksum sum;
    sum.add(line);
    uint64_t written = 0, left = std::filesystem::file_size(file_path(path)) - line.size();
    while (left > sizeof written && file) {
        line = next(left - sizeof written);
        sum.add(line);
        left -= line.size();
    }
    file.read(reinterpret_cast<char*>(&written), sizeof written);
    if (!file || written != sum.value()) fail({path}, "the film is damaged, or cut short");
    file.seekg(first_line.size());
    return file;
}

}  // namespace

void write_film(const std::string& path, const FilmLabel& label, const Film& film) {
    NewFile file(path);
    Checksum checksum;
    auto write = [&](std::string_view bytes) {
        checksum.add(bytes);
        file.write(bytes);
    };
    write(first_line);
    write(label.text() + "size");
    for (int number : shape_of(film)) write(' ' + std::to_string(number));
    write("\n\n");
    for (const Film::Sums* sums : film.sums()) write(bytes_of(*sums));
    uint64_t sum = checksum.value();
    file.write({reinterpret_cast<const char*>(&sum), sizeof sum});
    file.commit();
}

void check_film_is_file(const std::string& path) {
    std::error_code none;
    std::filesystem::file_status status = std::filesystem::status(file_path(path), none);
    if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
    fail({path}, "a film must be a file: what this is cannot be read and replaced");
}

LabeledFilm read_film(const std::string& path) {
    std::ifstream file = whole_film(path);
    FilmLabel label;
    std::string line, word;
    std::istringstream size;
    for (; std::getline(file, line) && !line.empty(); label.add_line(line)) size.str(line);
    int width = 0, height = 0;
    bool takes_splats = false, has_halves = false, has_batches = false, has_audits = false;
    size >> word >> width >> height >> takes_splats >> has_halves >> has_batches >> has_audits;
    Film film(width, height, takes_splats);
    if (has_halves) film.start_halves();
    if (has_batches) film.start_batches();
    for (Film::Sums* sums : film.sums()) {
        file.read(reinterpret_cast<char*>(sums->data()),
                  static_cast<std::streamsize>(bytes_of(*sums).size()));
        // The pixels at the edges of lamps decide which are audited, and so how many audits follow.
        if (has_audits && sums == &film.pixels()) film.start_audit();
    }
    return {std::move(label), std::move(film)};
}

void check_options(const std::string& path, const FilmLabel& label, const Notes& options) {
    for (size_t i = 0; i < std::max(options.size(), label.options.size()); i++) {
        if (i >= options.size() || i >= label.options.size() ||
            options[i].first != label.options[i].first) {
            fail({path}, "a film by another version of the program");
        }
        const auto& [name, value] = options[i];
        const std::string& its_value = label.options[i].second;
        if (printable(value) == its_value) continue;
        if (name == "code") fail({path}, "the film was made by other code of this chapter");
        if (name == "checksum") fail({path}, "a film of another scene: its files are not the same");
        fail({path}, "its " + name + " is " + quote(its_value) + ", here it is " + quote(value));
    }
}

void check_sums(const std::string& path, const Film& film, const Film& sum) {
    if (shape_of(film) != shape_of(sum)) fail({path}, "a film by another version of the program");
    for (size_t i = 0; i < sum.pixels().size(); i++) {
        if (film.pixels()[i].is_edge != sum.pixels()[i].is_edge)
            fail({path}, "it has other pixels at the edges of lamps");
        if (film.count_of(i) + sum.count_of(i) > PixelSum::most)
            fail({path}, "more than 2^28 samples of a pixel, in all");
    }
}

void add_film(LabeledFilm& sum, const std::string& path, const LabeledFilm& part) {
    check_options(path, part.label, sum.label.options);
    check_sums(path, part.film, sum.film);
    sum.label.add(part.label, path);
    sum.film.add(part.film);
}
