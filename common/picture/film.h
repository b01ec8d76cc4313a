// The film: sums of the samples of each pixel, which are the same in any order; and the estimated
// error of the picture. Films on disk, to be continued or merged later; and what describes them.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "common/base/hash.h"
#include "common/base/text.h"
#include "common/picture/image.h"

/// The samples of one pixel so far: their number, the sum of each channel, and the sum of the
/// squares of their brightness. The bits of the sums do not depend on the order of the samples, nor
/// on whether they were added one by one or as partial sums.
///
/// A number x is cut in pieces, each a multiple of its bin's unit and at most 2^25 of them:
///
///   unit_t = 2^(26 t - 364);   piece_t = (x + M) - M,  M = 1.5 2^52 unit_t;   x -= piece_t
///
/// (M is so large that x + M is rounded to the unit.) Each sum has three bins, in which the pieces
/// are added without any rounding; smaller pieces are left out. The first bin is t = `top`, which
/// depends only on the largest number so far.
///
/// error   at most 2^-53 of the largest number for each number added, like rounding to double; for
///         n above 2^28 the sums are rounded as usual
/// NaN     a channel becomes and stays NaN if one of its numbers is not finite
/// source  Demmel, Nguyen 2013, "Fast reproducible floating-point summation"
/// tested by  "identity: a pixel's sums have the same bits in any order and any grouping"
struct PixelSum {
    enum Sum { red, green, blue, squares, sums };
    static constexpr uint32_t most = 1u << 28;  // samples

    double bins[3][sums] = {};
    uint8_t top_channels = 2, top_squares = 2;
    uint8_t is_edge = 0, is_audited = 0;  // 0 or 1; see Film::start_audit()
    uint32_t n = 0;

    void add(Rgb L) {
        double r{L.r}, g{L.g}, b{L.b}, y = r + g + b;
        add_numbers(r, g, b, y * y);
        n++;
    }
    /// Adds part of a sample, to the channels only.
    void add_part(Rgb L) { add_numbers(double{L.r}, double{L.g}, double{L.b}, 0); }
    void add(const PixelSum& other);

    double r() const { return value(red); }
    double g() const { return value(green); }
    double b() const { return value(blue); }
    /// The mean of the brightness Y (the average of the channels), sum Y^2, sum (Y - mean)^2.
    double mean() const { return (r() + g() + b()) / 3 / std::max(1.0, static_cast<double>(n)); }
    double sum_of_squares() const { return value(squares) / 9; }
    double m2() const;
    double variance_of_mean() const { return n < 2 ? 0 : m2() / (n - 1.0) / n; }

private:
    double value(Sum sum) const { return bins[0][sum] + bins[1][sum] + bins[2][sum]; }
    /// 2^power times the unit of the bins that begin at `top`.
    static double units(int top, int power) {
        return std::bit_cast<double>(static_cast<uint64_t>(1023 + 26 * top - 364 + power) << 52);
    }
    static bool fits(double x, int top) { return x < units(top, 25); }
    void add_numbers(double r, double g, double b, double y2) {
        bool all_fit =
            fits(std::abs(r) + std::abs(g) + std::abs(b), top_channels) && fits(y2, top_squares);
        if (!all_fit) return add_large(r, g, b, y2);
        add_fitting(r, g, b, y2);
    }
    void add_fitting(double r, double g, double b, double y2) {
        using Double4 = double __attribute__((vector_size(32)));  // four at once
        double m = 1.5 * units(top_channels, 52), m_squares = 1.5 * units(top_squares, 52);
        Double4 x = {r, g, b, y2}, M = {m, m, m, m_squares};
        for (auto& bin : bins) {
            Double4 piece = (x + M) - M, sum;
            std::memcpy(&sum, bin, sizeof sum);
            sum += piece;
            std::memcpy(bin, &sum, sizeof sum);
            x -= piece;
            M *= 0x1p-26;
        }
    }
    /// Adds numbers that may be too large for the bins, or not finite.
    void add_large(double r, double g, double b, double y2);
    /// Moves the bins up.
    void raise_to(int channels, int squares_to);
};
static_assert(sizeof(PixelSum) == 104);

/// Each pixel counts its own samples; its value is their mean.
class Film {
public:
    int width, height;

    Film(int w, int h, bool takes_splats = false)
        : width(w), height(h), pixels_(static_cast<size_t>(w) * static_cast<size_t>(h)) {
        if (takes_splats) splats_ = totals_ = pixels_;
    }

    /// From now on each pixel has two halves, 0 and 1, that count their own samples. The picture
    /// is the mean of both means. For uneven samples, as in chapter 19: a half's mean is unbiased
    /// if only the other half decided on its number of samples.
    void start_halves();
    bool has_halves() const { return has_halves_; }
    const std::vector<PixelSum>& half(int number) const { return number == 0 ? pixels_ : audits_; }

    /// Adds the next sample of a pixel; half 1 of an audited pixel: the audit of its last sample.
    /// Two threads must not add to one pixel, here and below.
    void add(size_t pixel, Rgb L, int half = 0) { sum_in(pixel, half).add(L); }
    /// Adds one part of a sample, to the sums only: the film then has a mean but no error. At the
    /// end it gets the numbers of samples of the whole film, and has halves if that has.
    void add_part(size_t pixel, Rgb L, int half = 0) { sum_in(pixel, half).add_part(L); }
    void count_as(const Film& whole);

    /// Adds the contribution of a path from a light to the pixel in which the camera sees it. The
    /// picture is the mean of the samples plus the sum of the splats over spp(), as each sample
    /// traces one path from a light.
    void splat(size_t pixel, Rgb L) { splats_[pixel].add_part(L); }
    /// Adds the total of the next sample of a pixel: the sample plus its splats to all pixels.
    /// Totals are independent of each other, so they give the error of the mean.
    void add_total(size_t pixel, Rgb L) { totals_[pixel].add(L); }
    bool takes_splats() const { return !splats_.empty(); }

    /// From now on some pixels are audited: they take each of their samples a second time, with
    /// random numbers of another key. Pixels at the edges of lamps are few but may have most of the
    /// error, so they are audited separately: of either kind one pixel in 256, or more so that
    /// there are at least 64. Called after all edges are marked.
    void mark_edge(size_t pixel) { pixels_[pixel].is_edge = 1; }
    void start_audit();
    bool has_audits() const { return !audits_.empty() && !has_halves_; }
    bool is_audited(size_t pixel) const { return pixels_[pixel].is_audited > 0; }

    /// From now on the samples of one pass (one sample of each pixel) may depend on each other.
    /// The spread of the passes' means shows how much: each pass is added to one of a few batches,
    /// chosen at random by its number.
    ///
    ///   SE_b^2 = sum over the batches of w_b^2 (mean_b - mean)^2 / (1 - sum of w_b^2)
    ///   w_b    = n_b / n
    ///
    /// Batches with an incomplete pass are left out.
    static constexpr size_t most_batches = 128;
    void start_batches() { batches_.assign(most_batches, {}); }
    bool has_batches() const { return !batches_.empty(); }
    /// Adds samples of pass number `pass`. Two threads must not do so at once.
    void add_to_batch(uint32_t pass, const PixelSum& samples) {
        batches_[hash32(pass) % most_batches].add(samples);
    }

    /// Adds the samples of another film of the same size; it must have audits if this film has.
    void add(const Film& other);

    Image image() const;   // black where a pixel has no samples yet
    Image counts() const;  // the number of samples of each pixel, in all three channels
    /// Mean over channels and the pixels that have samples.
    double mean() const { return sum_of(mean_channels()) / 3; }
    Rgb mean_rgb() const { return to_rgb(mean_channels()); }

    /// The error of mean(), and the numbers of data that it is based on: the more, the more
    /// reliable.
    ///
    /// Samples of one pixel may depend on each other, as stratified ones do; then their spread does
    /// not give the error of their mean. Two independent sets do: if A and B are their means, the
    /// expectation of (A - B)^2 / 2 is the variance of each.
    ///
    ///   SE^2 = r sum over the pixels of v,   v = sum (Y - mean)^2 / (n - 1) / n
    ///   r    = sum of (A - B)^2 / 2 over the audited pixels / sum of v over them
    ///
    /// separately for the pixels at edges and the others. r is 1 without audits, when samples are
    /// independent of each other. Of two halves each audits the other, in all pixels. For a film
    /// with splats, Y is the total of a sample. Where pixels of a pass depend on each other, SE_b^2
    /// minus the sum of v is added, if it is positive: that sum is what SE_b^2 would be if they did
    /// not.
    /// tested by  "consistency: the reported error is the spread over seeds, with each sampler"
    struct Error {
        double standard = 0;  // NaN: a pixel has too few samples, or none in one half
        double pixels = 0;    // (sum v)^2 / sum v^2: effective number of pixels
        double audits = 0;    // the same for the audited pixels; or 0
        double squares = 0;   // sum (Y - mean)^2 over all samples
        double samples = 0;   // (sum Y)^2 / sum Y^2: effective number of samples
    };
    Error error() const;
    double standard_error() const { return error().standard; }

    /// The samples of a pixel, of both halves.
    uint64_t count_of(size_t pixel) const {
        return pixels_[pixel].n + (has_halves_ ? uint64_t{audits_[pixel].n} : 0);
    }
    size_t empty_pixels() const;  // those without samples
    uint64_t samples() const;     // of all pixels
    double spp() const {
        return static_cast<double>(samples()) / static_cast<double>(pixels_.size());
    }

    const std::vector<PixelSum>& pixels() const { return pixels_; }
    /// All sums, to be added, written and read: those of the pixels, then those of the audits.
    using Sums = std::vector<PixelSum>;
    std::array<Sums*, 5> sums() { return {&pixels_, &audits_, &splats_, &totals_, &batches_}; }
    std::array<const Sums*, 5> sums() const {
        return {&pixels_, &audits_, &splats_, &totals_, &batches_};
    }

private:
    Rgbd mean_of(size_t pixel, double spp) const;
    Rgbd mean_channels() const;
    double variance_of_batches() const;
    /// Where the audit or the second half of a pixel stands.
    size_t second_of(size_t pixel) const {
        if (has_halves_) return pixel;
        auto place = std::lower_bound(audited_.begin(), audited_.end(), pixel);
        return static_cast<size_t>(place - audited_.begin());
    }
    PixelSum& sum_in(size_t pixel, int half) {
        return half == 0 ? pixels_[pixel] : audits_[second_of(pixel)];
    }

    std::vector<PixelSum> pixels_, audits_;  // the audits may be a second half
    bool has_halves_ = false;
    std::vector<size_t> audited_;            // the pixels that the audits belong to, in order
    std::vector<PixelSum> splats_, totals_;  // none for a film without
    std::vector<PixelSum> batches_;          // none where samples are independent of other pixels'
};

/// Names and values that describe how a picture was made. The same samples give the same notes, so
/// they do not contain numbers of threads, times, folders, or names of outputs.
using Notes = std::vector<std::pair<std::string, std::string>>;

/// How many samples of a pixel a render takes, in so many parts; 0 samples: without end.
struct Goal {
    uint32_t samples = 0, parts = 1;
    auto operator<=>(const Goal&) const = default;  // NOLINT(*-use-nullptr): version 14

    /// The first sample of a part. Parts count from 1.
    uint32_t first_of(int part) const {
        return static_cast<uint32_t>(uint64_t{samples} * static_cast<uint32_t>(part - 1) / parts);
    }
    /// The part that takes this sample.
    uint32_t part_of(uint32_t sample) const {
        return static_cast<uint32_t>(((uint64_t{sample} + 1) * parts - 1) / samples + 1);
    }
};

/// Samples number first to last - 1 of each pixel, with the random numbers of a seed; and what the
/// render takes in all. A render that has all its samples has one part.
struct SampleRange {
    uint32_t seed = 0, first = 0, last = 0;
    Goal goal = {};
    auto operator<=>(const SampleRange&) const = default;  // NOLINT(*-use-nullptr): version 14
};

/// "samples 3 to 7 of seed 0".
std::string text_of(const SampleRange& range);

/// A sample of a picture.
struct SampleAt {
    uint32_t seed = 0;
    int y = 0, x = 0, number = 0;
    auto operator<=>(const SampleAt&) const = default;  // NOLINT(*-use-nullptr): version 14

    /// "X,Y,NUMBER", as --explain takes them.
    std::string text() const { return format("%d,%d,%d", x, y, number); }
};

/// Counts besides the sums. Those of two sets of samples add up.
struct SampleCounts {
    uint64_t rays = 0;
    uint64_t paths_cut = 0;                   // ended by the depth limit
    uint64_t photons = 0, inner_photons = 0;  // that were gathered; in the inner half of a disk
    uint64_t not_finite = 0;  // samples that were NaN or infinite, as their pixels are then
    SampleAt bad;             // the first of those
    double largest = 0;       // the largest sample (average of the channels)

    void add_not_finite(SampleAt at) { bad = not_finite++ == 0 ? at : std::min(bad, at); }
    void add(const SampleCounts& other);
};

/// The label of a film. Two films can be added if their options are equal, and no sample is in
/// both.
struct FilmLabel {
    Notes options;                     // all that matter
    std::vector<SampleRange> samples;  // sorted, none touches the next
    SampleCounts counts;

    /// The samples that are missing, and the parts that they belong to: a line for each gap.
    std::vector<std::string> missing() const;
};

/// The notes of a picture with this label, with `spp` samples per pixel on average. A label without
/// samples describes a picture that was not sampled.
Notes notes_of(const FilmLabel& label, double spp);

/// A line "NAME VALUE" for each.
std::vector<std::string> lines_of(const Notes& notes);

/// The lines as a comment for write_image, below one that says whose notes they are, and back.
/// Empty for a comment by another program.
///
/// tested by  "identity: notes are read from a .ppm and a .png as they were written"
std::string comment_of(const Notes& notes);
Notes notes_in(const std::string& comment);

struct LabeledFilm {
    FilmLabel label;
    Film film;
};

/// The ending of a film's name.
inline constexpr const char* film_ending = ".film";

/// Writes a film: its options in lines of text, all else as it is in memory, and a checksum. The
/// bytes depend on the samples, but not on their order. Throws InputError; the file that was there
/// before stays until the new one is whole.
void write_film(const std::string& path, const FilmLabel& label, const Film& film);

/// Reads a film. Throws InputError, one line, for a file that is cut short, damaged in any bit, or
/// no film.
LabeledFilm read_film(const std::string& path);

/// Throws InputError, a line that names the first difference, when the film read from `path` is of
/// other options than these, or has samples that cannot be added to `sum`.
void check_fits(const std::string& path, const LabeledFilm& film, const Notes& options,
                const Film& sum);

/// Adds the film read from `path` to another. Throws InputError, and leaves `sum` as it was, when
/// its options are others, or a sample is in both.
/// tested by  "identity: films of parts, added in any order, have the bytes of the whole"
void add_film(LabeledFilm& sum, const std::string& path, const LabeledFilm& part);
