#include "common/picture/film_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/system.h"
#include "common/base/text.h"

namespace {

/// The lines that a picture's comment and a film begin with, and what is the same in all versions.
constexpr const char* picture_line = "picture of path-by-path";
const std::string option = "option ";  // before each of a film
constexpr std::string_view any_version = "film of path-by-path, version ",
                           first_line = "film of path-by-path, version 8\n";

/// The values as they are in memory.
template <class Values>
std::string_view bytes_of(const Values& values) {
    return {reinterpret_cast<const char*>(std::data(values)), std::size(values) * sizeof values[0]};
}

/// What decides which sums a film has.
using Shape = std::array<int, 6>;
Shape shape_of(const Film& film) {
    return {film.width,        film.height,        film.takes_splats(),
            film.has_halves(), film.has_batches(), film.has_audits()};
}

/// The notes, a line for each, up to an empty line or the end; behind `prefix` in each line.
Notes read_notes(std::istream& lines, std::string_view prefix = "") {
    Notes notes;
    for (std::string line; std::getline(lines, line) && !line.empty();) {
        line.erase(0, prefix.size());
        size_t space = std::min(line.find(' '), line.size());
        notes.push_back({line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
    }
    return notes;
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

/// The samples 0 to goal.samples - 1 that are missing.
std::vector<SampleRange> gaps(const std::vector<SampleRange>& samples, const Goal& goal) {
    std::vector<SampleRange> result;
    uint32_t next = 0;
    for (const SampleRange& r : samples) {
        if (r.seed != goal.seed || next >= goal.samples) continue;
        if (r.first > next) result.push_back({goal.seed, next, std::min(r.first, goal.samples)});
        next = r.last;
    }
    if (next < goal.samples) result.push_back({goal.seed, next, goal.samples});
    return result;
}

/// The ranges of both, joined where they touch. Throws where they overlap.
std::vector<SampleRange> joined(const std::vector<SampleRange>& a,
                                const std::vector<SampleRange>& b, const std::string& path) {
    std::vector<SampleRange> all = a, result;
    all.insert(all.end(), b.begin(), b.end());
    std::sort(all.begin(), all.end());
    for (const SampleRange& r : all) {
        bool same_seed = !result.empty() && result.back().seed == r.seed;
        if (same_seed && r.first < result.back().last) {
            fail({path}, text_of({r.seed, r.first, r.first + 1}) + " would count twice");
        } else if (same_seed && r.first == result.back().last) {
            result.back().last = r.last;
        } else {
            result.push_back(r);
        }
    }
    return result;
}

}  // namespace

std::string text_of(const SampleRange& r) {
    std::string last = r.last - 1 > r.first ? " to " + std::to_string(r.last - 1) : "";
    return (last.empty() ? "sample " : "samples ") + std::to_string(r.first) + last + " of seed " +
           std::to_string(r.seed);
}

std::string SampleAt::text() const {
    return std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(number);
}

void SampleCounts::add(const SampleCounts& other) {
    rays += other.rays;
    paths_cut += other.paths_cut;
    photons += other.photons;
    inner_photons += other.inner_photons;
    largest = std::max(largest, other.largest);
    if (other.not_finite > 0) bad = not_finite == 0 ? other.bad : std::min(bad, other.bad);
    not_finite += other.not_finite;
}

void FilmLabel::keep_open_goals() {
    std::sort(goals.begin(), goals.end());
    std::vector<Goal> open;
    for (const Goal& goal : goals) {
        if (!open.empty() && open.back().seed == goal.seed) open.pop_back();
        open.push_back(goal);
    }
    std::erase_if(open, [&](const Goal& goal) { return gaps(samples, goal).empty(); });
    goals = open;
}

std::vector<std::string> FilmLabel::missing() const {
    std::vector<std::string> lines;
    for (const Goal& goal : goals) {
        for (const SampleRange& gap : gaps(samples, goal)) {
            uint32_t first = goal.part_of(gap.first), last = goal.part_of(gap.last - 1);
            std::string to = last > first ? " to " + std::to_string(last) : "";
            std::string parts =
                ", part " + std::to_string(first) + to + " of " + std::to_string(goal.parts);
            lines.push_back("missing: " + text_of(gap) + (goal.parts > 1 ? parts : ""));
        }
    }
    return lines;
}

Notes notes_of(const FilmLabel& label, double spp) {
    Notes notes;
    for (const auto& [name, value] : label.options) {
        if (name != "code" && !value.empty()) notes.push_back({name, value});
    }
    if (!label.samples.empty()) notes.push_back({"spp", json_number(spp)});
    bool from_the_start = label.samples.size() == 1 && label.samples[0].first == 0;
    if (from_the_start) notes.push_back({"seed", std::to_string(label.samples[0].seed)});
    for (const SampleRange& r : label.samples) {
        if (from_the_start) break;
        notes.push_back({"samples", std::to_string(r.first) + " to " + std::to_string(r.last - 1) +
                                        " of seed " + std::to_string(r.seed)});
    }
    return notes;
}

std::vector<std::string> lines_of(const Notes& notes) {
    std::vector<std::string> lines;
    for (const auto& [name, value] : notes) lines.push_back(name + ' ' + printable(value));
    return lines;
}

std::string comment_of(const Notes& notes) {
    std::string comment = picture_line;
    for (const std::string& line : lines_of(notes)) comment += '\n' + line;
    return comment;
}

Notes notes_in(const std::string& comment) {
    std::istringstream lines(comment);
    std::string line;
    if (!std::getline(lines, line) || line != picture_line) return {};
    return read_notes(lines);
}

void write_film(const std::string& path, const FilmLabel& label, const Film& film) {
    write_file_atomically(path, [&](std::ostream& file) {
        Checksum checksum;
        auto write = [&](std::string_view bytes) {
            checksum.add(bytes);
            file << bytes;
        };
        write(first_line);
        for (const std::string& line : lines_of(label.options)) write(option + line + '\n');
        write("\n");
        uint64_t sizes[] = {label.samples.size(), label.goals.size()};
        write(bytes_of(shape_of(film)));
        write(bytes_of(sizes));
        write(bytes_of(label.samples));
        write(bytes_of(label.goals));
        write(bytes_of(std::array{label.counts}));
        for (const Film::Sums* sums : film.sums()) write(bytes_of(*sums));
        file << bytes_of(std::array{checksum.value()});
    });
}

void check_film_is_file(const std::string& path) {
    std::error_code none;
    std::filesystem::file_status status = std::filesystem::status(file_path(path), none);
    if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
    fail({path}, "a film must be a file: what this is cannot be read and replaced");
}

LabeledFilm read_film(const std::string& path) {
    std::ifstream file = whole_film(path);
    auto read = [&](auto& values) {
        std::string_view bytes = bytes_of(values);
        file.read(const_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    };
    FilmLabel label{read_notes(file, option), {}, {}, {}};
    Shape shape;
    uint64_t sizes[2];
    std::array<SampleCounts, 1> counts;
    read(shape);
    read(sizes);
    label.samples.resize(sizes[0]);
    label.goals.resize(sizes[1]);
    read(label.samples);
    read(label.goals);
    read(counts);
    label.counts = counts[0];
    auto [width, height, takes_splats, has_halves, has_batches, has_audits] = shape;
    Film film(width, height, takes_splats);
    if (has_halves) film.start_halves();
    if (has_batches) film.start_batches();
    for (Film::Sums* sums : film.sums()) {
        read(*sums);
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
    FilmLabel& label = sum.label;
    label.samples = joined(label.samples, part.label.samples, path);
    label.counts.add(part.label.counts);
    label.goals.insert(label.goals.end(), part.label.goals.begin(), part.label.goals.end());
    label.keep_open_goals();
    sum.film.add(part.film);
}
