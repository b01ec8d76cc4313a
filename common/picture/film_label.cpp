#include "common/picture/film_label.h"

#include <algorithm>
#include <bit>
#include <sstream>
#include <tuple>

#include "common/base/position.h"

namespace {

/// The samples 0 to goal.samples - 1 that are missing.
std::vector<SampleRange> gaps(const std::vector<SampleRange>& samples, const Goal& goal) {
    std::vector<SampleRange> result;
    uint32_t next = 0;
    auto r = std::lower_bound(samples.begin(), samples.end(), SampleRange{goal.seed, 0, 0});
    for (; r != samples.end() && r->seed == goal.seed && r->first < goal.samples; r++) {
        if (r->first > next) result.push_back({goal.seed, next, r->first});
        next = r->last;
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
    uint64_t samples = 0;
    for (const SampleRange& r : all) {
        samples += r.last - r.first;
        bool same_seed = !result.empty() && result.back().seed == r.seed;
        if (same_seed && r.first < result.back().last) {
            fail({path}, "sample " + std::to_string(r.first) + " of seed " +
                             std::to_string(r.seed) + " would count twice");
        }
        if (same_seed && r.first == result.back().last) {
            result.back().last = r.last;
        } else {
            result.push_back(r);
        }
    }
    if (samples > PixelSum::most) fail({path}, "more than 2^28 samples of a pixel, in all");
    return result;
}

/// Whether no number can lead astray: a label may have been changed together with its checksum.
bool is_possible(const FilmShape& shape, const FilmLabel& label) {
    bool is_right = shape.width > 0 && shape.height > 0 && shape.width <= 65536 &&
                    shape.height <= 65536 && int64_t{shape.width} * shape.height <= 1 << 28 &&
                    shape.kind >= 0 && shape.kind <= 4;
    for (const SampleRange& r : label.samples)
        is_right &= r.first < r.last && r.last <= PixelSum::most;
    for (const Goal& g : label.goals) is_right &= g.parts >= 1 && g.parts <= g.samples;
    return is_right;
}

void parse_line(const std::string& line, FilmLabel& label, FilmShape& shape) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "option") {
        auto& [name, value] = label.options.emplace_back();
        words >> name;
        words.get();
        std::getline(words, value);
    } else if (kind == "samples") {
        SampleRange& r = label.samples.emplace_back();
        words >> r.first >> r.last >> r.seed;
    } else if (kind == "goal") {
        Goal& goal = label.goals.emplace_back();
        words >> goal.samples >> goal.parts >> goal.seed;
    } else if (kind == "counts") {
        SampleCounts& c = label.counts;
        uint64_t largest = 0;
        words >> c.rays >> c.paths_cut >> c.photons >> c.inner_photons >> c.not_finite >>
            c.bad_seed >> c.bad_sample >> c.bad_y >> c.bad_x >> largest;
        c.largest = std::bit_cast<double>(largest);
    } else if (kind == "size") {
        words >> shape.width >> shape.height >> shape.kind >> shape.takes_splats;
    }
}

}  // namespace

std::string text_of(const SampleRange& r) {
    std::string last = r.last - 1 > r.first ? " to " + std::to_string(r.last - 1) : "";
    return (last.empty() ? "sample " : "samples ") + std::to_string(r.first) + last + " of seed " +
           std::to_string(r.seed);
}

void SampleCounts::add_not_finite(uint32_t seed, int sample, int y, int x) {
    if (not_finite++ > 0 &&
        std::tie(bad_seed, bad_sample, bad_y, bad_x) < std::tie(seed, sample, y, x)) {
        return;
    }
    bad_seed = seed, bad_sample = sample, bad_y = y, bad_x = x;
}

void SampleCounts::add(const SampleCounts& other) {
    rays += other.rays;
    paths_cut += other.paths_cut;
    photons += other.photons;
    inner_photons += other.inner_photons;
    largest = std::max(largest, other.largest);
    if (other.not_finite == 0) return;
    add_not_finite(other.bad_seed, other.bad_sample, other.bad_y, other.bad_x);
    not_finite += other.not_finite - 1;
}

void FilmLabel::keep_open_goals() {
    std::sort(goals.begin(), goals.end());
    std::vector<Goal> open;
    for (size_t i = 0; i < goals.size(); i++) {
        bool is_largest = i + 1 == goals.size() || goals[i + 1].seed != goals[i].seed;
        if (is_largest && !gaps(samples, goals[i]).empty()) open.push_back(goals[i]);
    }
    goals = open;
}

void FilmLabel::add(const FilmLabel& other, const std::string& path) {
    samples = joined(samples, other.samples, path);
    counts.add(other.counts);
    goals.insert(goals.end(), other.goals.begin(), other.goals.end());
    keep_open_goals();
}

std::vector<std::string> FilmLabel::missing() const {
    std::vector<std::string> lines;
    for (const Goal& goal : goals) {
        std::string of_all = '/' + std::to_string(goal.parts);
        for (const SampleRange& gap : gaps(samples, goal)) {
            uint32_t first = goal.part_of(gap.first), last = goal.part_of(gap.last - 1);
            std::string line =
                text_of(gap) + (gap.last - gap.first > 1 ? " are" : " is") + " missing";
            if (last > first) {
                line += ": parts " + std::to_string(first) + of_all + " to " +
                        std::to_string(last) + of_all;
            } else if (goal.parts > 1) {
                line += ": part " + std::to_string(first) + of_all;
            }
            lines.push_back(line);
        }
    }
    return lines;
}

FilmShape shape_of(const Film& film) {
    int audits = film.has_audits();
    int kind = film.has_batches() ? 3 + audits : film.has_halves() ? 2 : audits;
    return {film.width, film.height, kind, film.takes_splats()};
}

std::string label_text(const FilmLabel& label, const FilmShape& shape) {
    std::ostringstream text;
    text << film_version;
    for (const auto& [name, value] : label.options) {
        text << "option " << name << ' ' << printable(value) << '\n';
    }
    for (const SampleRange& r : label.samples) {
        text << "samples " << r.first << ' ' << r.last << ' ' << r.seed << '\n';
    }
    for (const Goal& goal : label.goals) {
        text << "goal " << goal.samples << ' ' << goal.parts << ' ' << goal.seed << '\n';
    }
    const SampleCounts& c = label.counts;
    text << "counts " << c.rays << ' ' << c.paths_cut << ' ' << c.photons << ' ' << c.inner_photons
         << ' ' << c.not_finite << ' ' << c.bad_seed << ' ' << c.bad_sample << ' ' << c.bad_y << ' '
         << c.bad_x << ' ' << std::bit_cast<uint64_t>(c.largest) << '\n';
    text << "size " << shape.width << ' ' << shape.height << ' ' << shape.kind << ' '
         << shape.takes_splats << "\n\n";
    return text.str();
}

std::pair<FilmLabel, FilmShape> parse_label(const std::string& path, const std::string& text) {
    FilmLabel label;
    FilmShape shape;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) parse_line(line, label, shape);
    // Only what was written in this very form was read right.
    bool is_right = label_text(label, shape) == text && is_possible(shape, label);
    if (!is_right) fail({path}, "a film whose label cannot be read");
    return {std::move(label), shape};
}
