#include "common/picture/film_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <tuple>

#include "common/base/checksum.h"
#include "common/base/files.h"
#include "common/base/position.h"

namespace {

constexpr const char* first_line = "film of path-by-path, version 3";
constexpr size_t longest_label = 1 << 20;  // bytes

/// 0: the pixels alone; 1: with audits; 2: with a second half of each pixel; 3: with batches.
int kind_of(const Film& film) {
    return film.has_batches() ? 3 : film.has_halves() ? 2 : film.has_audits();
}

/// The lines of text at the beginning, up to the empty one.
std::string text_of(const FilmLabel& label, const Film& film) {
    std::ostringstream text;
    text << first_line << '\n';
    for (const auto& [name, value] : label.options) {
        text << "option " << name << ' ' << printable(value) << '\n';
    }
    for (const SampleRange& r : label.samples) {
        text << "samples " << r.first << ' ' << r.last << ' ' << r.seed << '\n';
    }
    const SampleCounts& c = label.counts;
    text << "counts " << c.rays << ' ' << c.paths_cut << ' ' << c.not_finite << ' ' << c.bad_seed
         << ' ' << c.bad_sample << ' ' << c.bad_y << ' ' << c.bad_x << ' '
         << std::bit_cast<uint64_t>(c.largest) << '\n';
    text << "size " << film.width << ' ' << film.height << ' ' << kind_of(film) << ' '
         << film.takes_splats() << "\n\n";
    return text.str();
}

std::string_view bytes_of(const std::vector<PixelSum>& sums) {
    return {reinterpret_cast<const char*>(sums.data()), sums.size() * sizeof(PixelSum)};
}

/// All that a film's file holds, in its order.
std::array<const std::vector<PixelSum>*, 5> sums_of(const Film& film) {
    return {&film.pixels(), &film.audits(), &film.splats(), &film.totals(), &film.batches()};
}

/// Reads a film from the beginning to the end, and adds up its checksum.
class FilmReader {
public:
    explicit FilmReader(const std::string& path) : path_(path) {
        if (std::error_code none; std::filesystem::is_directory(path, none))
            errno = EISDIR;
        else
            fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
        if (fd_ < 0) refuse(std::string("cannot read: ") + std::strerror(errno));
    }
    ~FilmReader() { ::close(fd_); }
    FilmReader(const FilmReader&) = delete;
    FilmReader& operator=(const FilmReader&) = delete;

    LabeledFilm read();

private:
    [[noreturn]] void refuse(const std::string& why) const { fail({path_}, why); }
    [[noreturn]] void refuse_label() const { refuse("a film whose label cannot be read"); }

    /// The next bytes, as many as there are up to `size`.
    size_t read_some(char* to, size_t size) {
        size_t done = 0;
        while (done < size) {
            ssize_t n = ::read(fd_, to + done, std::min<size_t>(size - done, 1 << 20));
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) refuse(std::string("cannot read: ") + std::strerror(errno));
            if (n == 0) break;
            done += static_cast<size_t>(n);
        }
        return done;
    }
    void read_sums(std::vector<PixelSum>& sums);
    std::string read_text();
    void read_line(const std::string& line);
    void check(const Film& film) const;

    std::string path_;
    int fd_ = -1;
    Checksum checksum_;
    FilmLabel label_;
    int width_ = 0, height_ = 0, kind_ = 0;
    bool takes_splats_ = false;
};

std::string FilmReader::read_text() {
    std::string text;
    while (!text.ends_with("\n\n")) {
        bool begins = text.starts_with(first_line) ||
                      (!text.empty() && std::string_view(first_line).starts_with(text));
        char c;
        if (text.size() > longest_label) refuse_label();
        if (!begins && !text.empty()) refuse("not a film");
        if (read_some(&c, 1) == 0) refuse(begins ? "the film is cut short" : "not a film");
        text += c;
    }
    checksum_.add(text);
    return text;
}

void FilmReader::read_line(const std::string& line) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "option") {
        std::string name, value;
        words >> name;
        words.get();
        std::getline(words, value);
        label_.options.push_back({name, value});
        return;
    }
    if (kind == "samples") {
        SampleRange r;
        words >> r.first >> r.last >> r.seed;
        label_.samples.push_back(r);
    } else if (kind == "counts") {
        SampleCounts& c = label_.counts;
        uint64_t largest = 0;
        words >> c.rays >> c.paths_cut >> c.not_finite >> c.bad_seed >> c.bad_sample >> c.bad_y >>
            c.bad_x >> largest;
        c.largest = std::bit_cast<double>(largest);
    } else if (kind == "size") {
        words >> width_ >> height_ >> kind_ >> takes_splats_;
    } else if (line != first_line) {
        refuse_label();
    }
    if (line != first_line && words.fail()) refuse_label();
}

void FilmReader::read_sums(std::vector<PixelSum>& sums) {
    size_t size = sums.size() * sizeof(PixelSum);
    if (read_some(reinterpret_cast<char*>(sums.data()), size) < size) {
        refuse("the film is cut short");
    }
    checksum_.add(bytes_of(sums));
}

/// Throws where a film, though its checksum is right, is none that was written by write_film().
void FilmReader::check(const Film& film) const {
    uint64_t most = 0;
    for (size_t i = 0; i < label_.samples.size(); i++) {
        const SampleRange& r = label_.samples[i];
        if (r.first >= r.last || (i > 0 && r <= label_.samples[i - 1])) refuse_label();
        most += r.last - r.first;
    }
    if (most > PixelSum::most) refuse_label();
    if (film.has_halves()) most = PixelSum::most;  // they are shared out as the chapter likes
    for (const std::vector<PixelSum>* sums : sums_of(film)) {
        bool is_batches = sums == &film.batches();  // of many pixels
        for (const PixelSum& p : *sums) {
            if ((p.n > most && !is_batches) || !p.has_valid_tops()) refuse_label();
        }
    }
}

LabeledFilm FilmReader::read() {
    std::istringstream text(read_text());
    for (std::string line; std::getline(text, line) && !line.empty();) read_line(line);
    bool is_size = width_ > 0 && height_ > 0 && width_ <= 65536 && height_ <= 65536 &&
                   int64_t{width_} * height_ <= 1 << 28;
    if (!is_size || kind_ < 0 || kind_ > 3) refuse_label();
    // Ask first whether there are so many bytes: a label alone must not take all memory.
    struct stat file = {};
    uint64_t least =
        static_cast<uint64_t>(width_) * static_cast<uint64_t>(height_) * sizeof(PixelSum);
    if (takes_splats_) least *= 3;
    if (::fstat(fd_, &file) != 0 || static_cast<uint64_t>(file.st_size) < least) {
        refuse("the film is cut short");
    }
    Film film(width_, height_, takes_splats_);
    read_sums(film.pixels());
    if (kind_ == 1) film.start_audit();
    if (kind_ == 2) film.start_halves();
    if (kind_ == 3) film.start_batches();
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
    check(film);
    return {std::move(label_), std::move(film)};
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

}  // namespace

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
    largest = std::max(largest, other.largest);
    if (other.not_finite == 0) return;
    add_not_finite(other.bad_seed, other.bad_sample, other.bad_y, other.bad_x);
    not_finite += other.not_finite - 1;
}

void write_film(const std::string& path, const FilmLabel& label, const Film& film) {
    NewFile file(path);
    Checksum checksum;
    std::string text = text_of(label, film);
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
        if (value == its_value) continue;
        if (name == "scene") fail({path}, "a film of another scene: its files are not the same");
        fail({path}, "its " + name + " is " + quote(its_value) + ", here it is " + quote(value));
    }
}

void add_film(LabeledFilm& sum, const std::string& path, const LabeledFilm& part) {
    check_options(path, part.label, sum.label.options);
    bool same_size = part.film.width == sum.film.width && part.film.height == sum.film.height &&
                     kind_of(part.film) == kind_of(sum.film) &&
                     part.film.takes_splats() == sum.film.takes_splats();
    if (!same_size) fail({path}, "a film by another version of the program");
    sum.label.samples = joined(sum.label.samples, part.label.samples, path);
    sum.label.counts.add(part.label.counts);
    sum.film.add(part.film);
}
