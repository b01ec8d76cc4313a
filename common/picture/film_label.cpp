#include "common/picture/film_label.h"

#include <algorithm>
#include <bit>
#include <sstream>
#include <tuple>

#include "common/base/error.h"
#include "common/base/text.h"

namespace {

constexpr const char* first_line = "picture of path-by-path";

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
    for (const Goal& goal : goals) {
        if (!open.empty() && open.back().seed == goal.seed) open.pop_back();
        open.push_back(goal);
    }
    std::erase_if(open, [&](const Goal& goal) { return gaps(samples, goal).empty(); });
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

std::string FilmLabel::text() const {
    std::ostringstream text;
    for (const auto& [name, value] : options)
        text << "option " << name << ' ' << printable(value) << '\n';
    for (const SampleRange& r : samples)
        text << "samples " << r.seed << ' ' << r.first << ' ' << r.last << '\n';
    for (const Goal& goal : goals)
        text << "goal " << goal.seed << ' ' << goal.samples << ' ' << goal.parts << '\n';
    const SampleCounts& c = counts;
    text << "counts " << c.rays << ' ' << c.paths_cut << ' ' << c.photons << ' ' << c.inner_photons
         << ' ' << c.not_finite << ' ' << c.bad_seed << ' ' << c.bad_sample << ' ' << c.bad_y << ' '
         << c.bad_x << ' ' << std::bit_cast<uint64_t>(c.largest) << '\n';
    return text.str();
}

void FilmLabel::add_line(const std::string& line) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "option") {
        auto& [name, value] = options.emplace_back();
        words >> name;
        words.get();
        std::getline(words, value);
    } else if (kind == "samples") {
        SampleRange& r = samples.emplace_back();
        words >> r.seed >> r.first >> r.last;
    } else if (kind == "goal") {
        Goal& goal = goals.emplace_back();
        words >> goal.seed >> goal.samples >> goal.parts;
    } else if (kind == "counts") {
        SampleCounts& c = counts;
        uint64_t largest = 0;
        words >> c.rays >> c.paths_cut >> c.photons >> c.inner_photons >> c.not_finite >>
            c.bad_seed >> c.bad_sample >> c.bad_y >> c.bad_x >> largest;
        c.largest = std::bit_cast<double>(largest);
    }
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
    std::string comment = first_line;
    for (const std::string& line : lines_of(notes)) comment += '\n' + line;
    return comment;
}

Notes notes_in(const std::string& comment) {
    std::istringstream lines(comment);
    std::string line;
    Notes notes;
    if (!std::getline(lines, line) || line != first_line) return {};
    while (std::getline(lines, line)) {
        size_t space = std::min(line.find(' '), line.size());
        notes.push_back({line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
    }
    return notes;
}

std::string value_of(const Notes& notes, const std::string& name) {
    for (const auto& [its_name, value] : notes) {
        if (its_name == name) return value;
    }
    return "";
}
