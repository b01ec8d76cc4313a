#include "common/picture/film_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/base/checksum.h"
#include "common/base/files.h"
#include "common/base/position.h"
#include "common/base/system.h"

namespace {

constexpr size_t longest_label = 1 << 20;  // bytes

std::string_view bytes_of(const std::vector<PixelSum>& sums) {
    return {reinterpret_cast<const char*>(sums.data()), sums.size() * sizeof(PixelSum)};
}

/// All sums in a film's file, in order.
std::array<const std::vector<PixelSum>*, 5> sums_of(const Film& film) {
    return {&film.pixels(), &film.audits(), &film.splats(), &film.totals(), &film.batches()};
}

/// Reads a film from beginning to end, and computes its checksum.
class FilmReader {
public:
    explicit FilmReader(const std::string& path) : path_(path) {
        std::error_code none;
        bool is_folder = std::filesystem::is_directory(file_path(path), none);
        if (!is_folder) check_film_is_file(path);
        errno = 0;
        file_.open(file_path(path), std::ios::binary);
        if (is_folder || !file_) refuse_to_read(is_folder ? EISDIR : errno);
    }

    LabeledFilm read();

private:
    [[noreturn]] void refuse(const std::string& why) const { fail({path_}, why); }
    [[noreturn]] void refuse_numbers() const {
        refuse("the film is damaged: its numbers contradict each other");
    }

    [[noreturn]] void refuse_to_read(int error) const {
        refuse(std::string("cannot read: ") + std::strerror(error));
    }

    /// The next bytes, as many as there are up to `size`.
    size_t read_some(char* to, size_t size) {
        errno = 0;
        file_.read(to, static_cast<std::streamsize>(size));
        if (file_.bad()) refuse_to_read(errno);
        return static_cast<size_t>(file_.gcount());
    }
    std::string read_text();
    void read_sums(std::vector<PixelSum>& sums);
    void read_pixels(Film& film, const FilmShape& shape);

    std::string path_;
    std::ifstream file_;
    Checksum checksum_;
};

std::string FilmReader::read_text() {
    std::string text;
    auto begins_with = [&](std::string_view line) {
        return text.starts_with(line.substr(0, text.size()));
    };
    while (!text.ends_with("\n\n")) {
        char c;
        if (text.size() > longest_label) refuse("a film whose label cannot be read");
        if (!begins_with(film_any_version)) refuse("not a film");
        if (!begins_with(film_version)) refuse("a film by another version of the program");
        if (read_some(&c, 1) == 0) refuse(text.empty() ? "not a film" : "the film is cut short");
        text += c;
    }
    checksum_.add(text);
    return text;
}

void FilmReader::read_sums(std::vector<PixelSum>& sums) {
    size_t size = sums.size() * sizeof(PixelSum);
    if (read_some(reinterpret_cast<char*>(sums.data()), size) < size) {
        refuse("the film is cut short");
    }
    checksum_.add(bytes_of(sums));
}

/// The pixels; those at the edges of lamps decide which are audited, and so how many audits follow.
void FilmReader::read_pixels(Film& film, const FilmShape& shape) {
    read_sums(film.pixels());
    std::vector<bool> audited;
    for (const PixelSum& p : film.pixels()) {
        if (std::max(p.is_edge, p.is_audited) > shape.has_audits()) refuse_numbers();
        audited.push_back(p.is_audited);
    }
    if (shape.has_audits()) film.start_audit();
    for (size_t i = 0; i < audited.size(); i++) {
        if (film.is_audited(i) != audited[i]) refuse_numbers();
    }
}

LabeledFilm FilmReader::read() {
    auto [label, shape] = parse_label(path_, read_text());
    // Ask first whether there are so many bytes: a label alone must not take all memory.
    uint64_t pixels = static_cast<uint64_t>(shape.width) * static_cast<uint64_t>(shape.height);
    uint64_t least = pixels * (shape.takes_splats ? 3 : 1) + (shape.kind == 2 ? pixels : 0);
    if (size_of(path_) < least * sizeof(PixelSum)) refuse("the film is cut short");
    Film film(shape.width, shape.height, shape.takes_splats);
    if (shape.kind == 2) film.start_halves();
    if (shape.has_batches()) film.start_batches();
    read_pixels(film, shape);
    for (std::vector<PixelSum>* sums :
         {&film.audits(), &film.splats(), &film.totals(), &film.batches()}) {
        read_sums(*sums);
    }
    uint64_t written = 0;
    char more;
    if (read_some(reinterpret_cast<char*>(&written), 8) < 8) refuse("the film is cut short");
    if (written != checksum_.value() || read_some(&more, 1) > 0) {
        refuse("the film is damaged: its checksum is wrong");
    }
    for (const std::vector<PixelSum>* all : sums_of(film)) {
        for (const PixelSum& p : *all) {
            bool has_flags = p.is_edge || p.is_audited;
            if (!p.is_possible() || (has_flags && all != &film.pixels())) refuse_numbers();
        }
    }
    return {std::move(label), std::move(film)};
}

}  // namespace

void write_film(const std::string& path, const FilmLabel& label, const Film& film) {
    NewFile file(path);
    Checksum checksum;
    std::string text = label_text(label, shape_of(film));
    auto write = [&](std::string_view bytes) {
        checksum.add(bytes);
        file.write(bytes);
    };
    write(text);
    for (const std::vector<PixelSum>* sums : sums_of(film)) write(bytes_of(*sums));
    uint64_t sum = checksum.value();
    file.write({reinterpret_cast<const char*>(&sum), sizeof sum});
    file.write_through();
    file.commit();
}

uint64_t largest_size(const Film& film) {
    uint64_t bytes = 1 << 13;  // of the label
    for (const std::vector<PixelSum>* sums : sums_of(film)) bytes += bytes_of(*sums).size();
    return bytes;
}

void check_film_is_file(const std::string& path) {
    std::error_code none;
    std::filesystem::file_status status = std::filesystem::status(file_path(path), none);
    if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
    fail({path}, "a film must be a file: what this is cannot be read and replaced");
}

LabeledFilm read_film(const std::string& path) { return FilmReader(path).read(); }

void check_options(const std::string& path, const FilmLabel& label,
                   const std::vector<std::pair<std::string, std::string>>& options) {
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
        const PixelSum &a = film.pixels()[i], &b = sum.pixels()[i];
        if (a.is_edge != b.is_edge) fail({path}, "it has other pixels at the edges of lamps");
        bool fits = a.n + b.n <= PixelSum::most;
        if (sum.has_halves()) fits &= film.audits()[i].n + sum.audits()[i].n <= PixelSum::most;
        if (!fits) fail({path}, "more than 2^28 samples of a pixel, in all");
    }
}

void add_film(LabeledFilm& sum, const std::string& path, const LabeledFilm& part) {
    check_options(path, part.label, sum.label.options);
    check_sums(path, part.film, sum.film);
    sum.label.add(part.label, path);
    sum.film.add(part.film);
}
