#include "common/picture/film.h"

#include <limits>

#include "common/base/error.h"
#include "common/base/files.h"

namespace {

/// The lines that a picture's comment and a film begin with.
constexpr std::string_view picture_line = "picture of path-by-path",
                           first_line = "film of path-by-path, version 9\n";

/// The values as they are in memory.
template <class Values>
std::string_view bytes_of(const Values& values) {
    return {reinterpret_cast<const char*>(std::data(values)), std::size(values) * sizeof values[0]};
}
/// Reads them from the start of some bytes, and takes these away.
template <class Values>
void read(std::string_view& bytes, Values& values) {
    size_t size = std::min(bytes_of(values).size(), bytes.size());
    if (size > 0) std::memcpy(std::data(values), bytes.data(), size);
    bytes.remove_prefix(size);
}

/// What decides which sums a film has.
using Shape = std::array<int, 6>;
Shape shape_of(const Film& film) {
    return {film.width,        film.height,        film.takes_splats(),
            film.has_halves(), film.has_batches(), film.has_audits()};
}

/// Takes the notes away, a line for each, up to an empty line or the end.
Notes read_notes(std::string_view& text) {
    Notes notes;
    while (!text.empty()) {
        std::string line(text.substr(0, text.find('\n')));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        if (line.empty()) break;
        size_t space = std::min(line.find(' '), line.size());
        notes.push_back({line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
    }
    return notes;
}

/// "3 to 7", or "3".
std::string from_to(uint32_t first, uint32_t last) {
    return std::to_string(first) + (last > first ? " to " + std::to_string(last) : "");
}

/// The ranges of both, joined where they touch. Throws where they overlap.
std::vector<SampleRange> joined(const std::vector<SampleRange>& a,
                                const std::vector<SampleRange>& b, const std::string& path) {
    std::vector<SampleRange> all = a, result;
    all.insert(all.end(), b.begin(), b.end());
    std::sort(all.begin(), all.end());
    for (SampleRange r : all) {
        bool same_seed = !result.empty() && result.back().seed == r.seed;
        if (same_seed && r.first < result.back().last)
            fail({path}, text_of({r.seed, r.first, r.first + 1}) + " would count twice");
        if (same_seed && r.first == result.back().last) {
            r.first = result.back().first;
            r.goal = std::max(r.goal, result.back().goal);
            result.pop_back();
        }
        if (r.first == 0 && r.last == r.goal.samples) r.goal.parts = 1;
        result.push_back(r);
    }
    return result;
}

}  // namespace

void PixelSum::raise_to(int channels, int squares_to) {
    for (Sum sum : {red, green, blue, squares}) {
        int by = std::max(0, sum == squares ? squares_to - top_squares : channels - top_channels);
        for (int i = 2; i >= 0 && !std::isnan(bins[0][sum]); i--)
            bins[i][sum] = i >= by ? bins[i - by][sum] : 0;
    }
    top_channels = std::max(top_channels, static_cast<uint8_t>(channels));
    top_squares = std::max(top_squares, static_cast<uint8_t>(squares_to));
}

void PixelSum::add_large(double r, double g, double b, double y2) {
    double numbers[sums] = {r, g, b, y2};
    for (Sum sum : {red, green, blue, squares}) {
        if (std::isfinite(numbers[sum])) continue;
        numbers[sum] = 0;
        for (auto& bin : bins) bin[sum] = std::nan("");
    }
    double largest = std::abs(numbers[0]) + std::abs(numbers[1]) + std::abs(numbers[2]);
    int channels = top_channels, squares_to = top_squares;
    while (!fits(largest, channels)) channels++;
    while (!fits(numbers[squares], squares_to)) squares_to++;
    raise_to(channels, squares_to);
    add_fitting(numbers[0], numbers[1], numbers[2], numbers[3]);
}

void PixelSum::add(const PixelSum& other) {
    PixelSum aligned = other;
    aligned.raise_to(top_channels, top_squares);
    raise_to(aligned.top_channels, aligned.top_squares);
    for (size_t i = 0; i < 3; i++)
        for (Sum sum : {red, green, blue, squares}) bins[i][sum] += aligned.bins[i][sum];
    n += other.n;
}

double PixelSum::m2() const {
    // sum (X - q)^2 = sum X^2 - 2 q sum X + n q^2 with q = mean X. Where the mean is large, almost
    // all of it cancels: so fma() keeps what the products lose by rounding.
    double sum = r() + g() + b(), count = n, q = sum / std::max(count, 1.0);
    double all = std::fma(q, std::fma(count, q, -2 * sum), value(squares));
    return (all < 0 ? 0 : all) / 9;  // keeps NaN
}

void Film::count_as(const Film& whole) {
    for (size_t i = 0; i < pixels_.size(); i++) {
        pixels_[i].n = whole.pixels_[i].n;
        if (has_halves_) audits_[i].n = whole.audits_[i].n;
    }
}

Rgbd Film::mean_of(size_t pixel, double spp) const {
    auto over = [](const PixelSum& p, double n) { return Rgbd{p.r() / n, p.g() / n, p.b() / n}; };
    const PixelSum& a = pixels_[pixel];
    Rgbd c = over(a, std::max(a.n, 1u));
    if (has_halves_ && audits_[pixel].n > 0) {
        Rgbd b = over(audits_[pixel], audits_[pixel].n);
        c = a.n == 0 ? b : 0.5 * (c + b);
    }
    return splats_.empty() ? c : c + over(splats_[pixel], spp);
}

Rgbd Film::mean_channels() const {
    Rgbd sum;
    double all = spp(), seen = 0;
    for (size_t i = 0; i < pixels_.size(); i++) {
        if (count_of(i) == 0) continue;
        sum += mean_of(i, all);
        seen++;
    }
    seen = std::max(seen, 1.0);
    return {sum.r / seen, sum.g / seen, sum.b / seen};
}

Image Film::image() const {
    Image image(width, height);
    double all = spp();
    for (size_t i = 0; i < pixels_.size(); i++) image.pixels[i] = to_rgb(mean_of(i, all));
    return image;
}

Image Film::counts() const {
    Image image(width, height);
    for (size_t i = 0; i < pixels_.size(); i++)
        image.pixels[i] = static_cast<float>(count_of(i)) * Rgb{1, 1, 1};
    return image;
}

void Film::start_halves() {
    has_halves_ = true;
    audits_.assign(pixels_.size(), {});
}

void Film::start_audit() {
    for (bool at_edges : {false, true}) {
        std::vector<size_t> some;
        for (size_t i = 0; i < pixels_.size(); i++) {
            if (pixels_[i].is_edge == at_edges) some.push_back(i);
        }
        size_t one_of = std::clamp<size_t>(some.size() / 64, 1, 256);
        for (size_t first = 0; first < some.size(); first += one_of) {
            size_t size = std::min(one_of, some.size() - first);
            audited_.push_back(some[first + hash32(static_cast<uint32_t>(first)) % size]);
        }
    }
    std::sort(audited_.begin(), audited_.end());
    for (size_t pixel : audited_) pixels_[pixel].is_audited = 1;
    audits_.assign(audited_.size(), {});
}

double Film::variance_of_batches() const {
    double n = 0, sum = 0, count = 0, squares = 0, weights = 0;
    auto is_whole = [&](const PixelSum& b) { return b.n > 0 && b.n % pixels_.size() == 0; };
    for (const PixelSum& b : batches_) {
        if (is_whole(b)) n += b.n, sum += b.n * b.mean(), count++;
    }
    if (count < 2) return std::nan("");
    for (const PixelSum& b : batches_) {
        double w = is_whole(b) ? b.n / n : 0, part = w * (b.mean() - sum / n);
        squares += part * part, weights += w * w;
    }
    return squares / (1 - weights);
}

Film::Error Film::error() const {
    struct Part {
        double v = 0, v2 = 0;                         // sums of v and v^2 over the pixels
        double found = 0, audited = 0, audited2 = 0;  // of the audited: (A - B)^2 / 2, v, v^2
    } parts[2];                                       // elsewhere, at edges
    Error error;
    bool is_known = true;
    double seen = 0, sum_y = 0, sum_y2 = 0;
    auto add_samples = [&](const PixelSum& p) {
        error.squares += p.n < 2 ? 0 : p.m2();
        sum_y += p.n * p.mean(), sum_y2 += p.sum_of_squares();
    };
    for (size_t i = 0; i < pixels_.size(); i++) {
        if (count_of(i) == 0) continue;
        const PixelSum& a = (splats_.empty() ? pixels_ : totals_)[i];
        double v = a.variance_of_mean();
        Part& part = parts[pixels_[i].is_edge];
        add_samples(a);
        is_known &= count_of(i) > 1;
        seen++;
        if (has_halves_ || is_audited(i)) {
            const PixelSum& b = audits_[second_of(i)];
            double both = (v + b.variance_of_mean()) / 2, difference = a.mean() - b.mean();
            part.found += difference * difference / 2;
            part.audited += both, part.audited2 += both * both;
            if (has_halves_) {
                v = both / 2;
                add_samples(b);
                is_known &= std::min(a.n, b.n) > 0 && std::max(a.n, b.n) > 1;
            }
        }
        part.v += v, part.v2 += v * v;
    }
    auto effective = [](double sum, double of_squares) {
        return of_squares > 0 ? sum * sum / of_squares : 0;
    };
    double sum = 0, sum_v = 0, of_pixels = 0, of_audits = 0;
    for (const Part& part : parts) {
        double r = part.audited > 0 ? part.found / part.audited : 1, share = r * part.v;
        sum += share, sum_v += part.v, of_pixels += r * r * part.v2;
        if (part.audited > 0)
            of_audits += share * share * part.audited2 / part.audited / part.audited;
    }
    error.pixels = effective(sum, of_pixels);
    error.audits = effective(sum, of_audits);
    error.samples = effective(sum_y, sum_y2);
    if (has_batches() && seen > 0) {
        double all = variance_of_batches() * seen * seen;
        if (!(all <= sum_v)) sum += all - sum_v;  // NaN stays NaN
    }
    error.standard = is_known && seen > 0 ? std::sqrt(sum) / seen : std::nan("");
    return error;
}

void Film::add(const Film& other) {
    for (size_t k = 0; k < sums().size(); k++)
        for (size_t i = 0; i < sums()[k]->size(); i++) (*sums()[k])[i].add((*other.sums()[k])[i]);
}

size_t Film::empty_pixels() const {
    size_t empty = 0;
    for (size_t i = 0; i < pixels_.size(); i++) empty += count_of(i) == 0;
    return empty;
}

uint64_t Film::samples() const {
    uint64_t sum = 0;
    for (size_t i = 0; i < pixels_.size(); i++) sum += count_of(i);
    return sum;
}

std::string text_of(const SampleRange& r) {
    const char* name = r.last - r.first > 1 ? "samples " : "sample ";
    return name + from_to(r.first, r.last - 1) + " of seed " + std::to_string(r.seed);
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

std::vector<std::string> FilmLabel::missing() const {
    std::vector<std::string> lines;
    auto add_gap = [&](uint32_t from, uint32_t to, const SampleRange& r) {
        if (from >= to) return;
        uint32_t first = r.goal.part_of(from), last = r.goal.part_of(to - 1);
        std::string parts =
            ", part " + from_to(first, last) + " of " + std::to_string(r.goal.parts);
        lines.push_back("missing: " + text_of({r.seed, from, to}) +
                        (r.goal.parts > 1 ? parts : ""));
    };
    for (size_t i = 0; i < samples.size(); i++) {
        const SampleRange& r = samples[i];
        bool is_first = i == 0 || samples[i - 1].seed != r.seed;
        bool is_last = i + 1 == samples.size() || samples[i + 1].seed != r.seed;
        add_gap(is_first ? 0 : samples[i - 1].last, r.first, r);
        if (is_last) add_gap(r.last, r.goal.samples, r);
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
    for (const SampleRange& r : label.samples) {
        std::string seed = std::to_string(r.seed);
        std::string all = from_to(r.first, r.last - 1) + " of seed " + seed;
        notes.push_back(from_the_start ? std::pair{"seed", seed} : std::pair{"samples", all});
    }
    return notes;
}

std::vector<std::string> lines_of(const Notes& notes) {
    std::vector<std::string> lines;
    for (const auto& [name, value] : notes) lines.push_back(name + ' ' + printable(value));
    return lines;
}

std::string comment_of(const Notes& notes) {
    std::string comment(picture_line);
    for (const std::string& line : lines_of(notes)) comment += '\n' + line;
    return comment;
}

Notes notes_in(const std::string& comment) {
    std::string_view lines = comment;
    if (lines.substr(0, lines.find('\n')) != picture_line) return {};
    Notes notes = read_notes(lines);
    notes.erase(notes.begin());
    return notes;
}

void write_film(const std::string& path, const FilmLabel& label, const Film& film) {
    std::string bytes;
    for (const std::string& line : lines_of(label.options)) bytes += line + '\n';
    bytes += '\n';
    bytes += bytes_of(shape_of(film));
    bytes += bytes_of(std::array{uint64_t{label.samples.size()}});
    bytes += bytes_of(label.samples);
    bytes += bytes_of(std::array{label.counts});
    for (const Film::Sums* sums : film.sums()) bytes += bytes_of(*sums);
    Checksum sum;
    sum.add(bytes);
    write_file_atomically(path, [&](std::ostream& file) {
        file << first_line << bytes_of(std::array{sum.value()}) << bytes;
    });
}

LabeledFilm read_film(const std::string& path) {
    const std::string whole = read_file(path, std::numeric_limits<size_t>::max());
    std::string_view file = whole;
    if (!file.starts_with(first_line))
        fail({path}, "not a film, or one by another version of the program");
    file.remove_prefix(first_line.size());
    std::array<uint64_t, 1> written = {};
    read(file, written);
    Checksum sum;
    sum.add(file);
    if (written[0] != sum.value()) fail({path}, "the film is damaged, or cut short");
    FilmLabel label{read_notes(file), {}, {}};
    Shape shape;
    std::array<uint64_t, 1> size;
    std::array<SampleCounts, 1> counts;
    read(file, shape);
    read(file, size);
    label.samples.resize(size[0]);
    read(file, label.samples);
    read(file, counts);
    label.counts = counts[0];
    auto [width, height, takes_splats, has_halves, has_batches, has_audits] = shape;
    Film film(width, height, takes_splats);
    if (has_halves) film.start_halves();
    if (has_batches) film.start_batches();
    for (Film::Sums* sums : film.sums()) {
        read(file, *sums);
        // The pixels at the edges of lamps decide which are audited, and so how many audits follow.
        if (has_audits && sums == &film.pixels()) film.start_audit();
    }
    return {std::move(label), std::move(film)};
}

void check_fits(const std::string& path, const LabeledFilm& film, const Notes& options,
                const Film& sum) {
    const Notes& its_options = film.label.options;
    bool same_names = options.size() == its_options.size();
    for (size_t i = 0; i < options.size() && same_names; i++) {
        const auto& [name, value] = options[i];
        const std::string& its_value = its_options[i].second;
        same_names = name == its_options[i].first;
        if (!same_names || printable(value) == its_value) continue;
        if (name == "code") fail({path}, "the film was made by other code of this chapter");
        if (name == "checksum") fail({path}, "a film of another scene: its files are not the same");
        fail({path}, "its " + name + " is " + quote(its_value) + ", here it is " + quote(value));
    }
    bool same_sums = true;
    for (size_t i = 0; i < sum.sums().size() && !film.label.samples.empty(); i++)
        same_sums &= film.film.sums()[i]->size() == sum.sums()[i]->size();
    if (!same_names || !same_sums) fail({path}, "a film by another version of the program");
}

void add_film(LabeledFilm& sum, const std::string& path, const LabeledFilm& part) {
    check_fits(path, part, sum.label.options, sum.film);
    if (part.label.samples.empty()) return;
    sum.label.samples = joined(sum.label.samples, part.label.samples, path);
    sum.label.counts.add(part.label.counts);
    sum.film.add(part.film);
}
