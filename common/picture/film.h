// The film: sums of the samples of each pixel, which are the same in any order, and the estimated
// error of the picture.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "common/path/sampler.h"
#include "common/picture/image.h"

namespace pixel_sum {
/// What belongs to bins that begin at `top`.
struct Tops {
    std::array<double, 29> rounder = {};  // M
    std::array<double, 29> limit = {};    // all numbers must be below

    constexpr Tops() {
        double unit = 0x1p-364;
        for (size_t top = 0; top < rounder.size(); top++, unit *= 0x1p26) {
            rounder[top] = 0x1.8p52 * unit, limit[top] = 0x1p25 * unit;
        }
    }
};
inline constexpr Tops tops;
}  // namespace pixel_sum

/// The samples of one pixel so far: their number, the sum of each channel, and the sum of the
/// squares of their brightness. The bits of the sums do not depend on the order of the samples, nor
/// on whether they were added one by one or as partial sums.
///
/// A number x is cut in pieces, each a multiple of its bin's unit and at most 2^25 of them:
///
///   unit_t = 2^(26 t - 364);   piece_t = (x + M) - M,  M = 1.5 2^52 unit_t;   x -= piece_t
///
/// (M is so large that x + M is rounded to the unit.) Each sum has three bins, in which the pieces
/// are added without any rounding. The first bin is t = `top`, chosen so that no number so far has
/// larger pieces. Pieces below the third bin are left out. So which pieces are added depends only
/// on the largest number.
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

    /// Adds a sample.
    void add(Rgb L) {
        double r{L.r}, g{L.g}, b{L.b}, y = r + g + b;
        add_numbers(r, g, b, y * y);
        n++;
    }
    /// Adds part of a sample, to the sums of the channels only.
    void add_part(Rgb L) { add_numbers(double{L.r}, double{L.g}, double{L.b}, 0); }
    /// Adds the samples of another sum.
    void add(const PixelSum& other);

    /// The sums of the channels.
    double r() const { return value(red).high; }
    double g() const { return value(green).high; }
    double b() const { return value(blue).high; }
    /// The mean of the brightness Y (the average of the channels), sum Y^2, sum (Y - mean)^2.
    double mean() const { return brightness().high / 3 / std::max(1.0, static_cast<double>(n)); }
    double sum_of_squares() const { return value(squares).high / 9; }
    double m2() const;

private:
    /// A number as the sum of two doubles, with twice the digits.
    struct Double2 {
        double high, low;
    };
    static Double2 add(Double2 a, Double2 b);
    Double2 value(Sum sum) const;
    Double2 brightness() const;  // of all samples, times 3

    void add_numbers(double r, double g, double b, double y2) {
        bool fits = std::abs(r) + std::abs(g) + std::abs(b) < pixel_sum::tops.limit[top_channels] &&
                    y2 < pixel_sum::tops.limit[top_squares];
        if (!fits) return add_large(r, g, b, y2);
        add_fitting(r, g, b, y2);
    }
    void add_fitting(double r, double g, double b, double y2) {
        using Double4 = double __attribute__((vector_size(32)));  // four at once
        double m = pixel_sum::tops.rounder[top_channels];
        Double4 x = {r, g, b, y2}, M = {m, m, m, pixel_sum::tops.rounder[top_squares]};
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
    /// Moves the bins of one sum up.
    void raise(Sum sum, int by);
    void raise_to(int channels, int squares_to);
};
static_assert(sizeof(PixelSum) == 104);

/// Adds up samples, in sums that do not depend on their order. Each pixel counts its own samples;
/// its value is their mean.
class Film {
public:
    int width, height;

    Film(int w, int h, bool takes_splats = false)
        : width(w),
          height(h),
          pixels_(static_cast<size_t>(w) * static_cast<size_t>(h)),
          splats_(takes_splats ? pixels_.size() : 0),
          totals_(splats_.size()) {}

    /// From now on each pixel has two halves, 0 and 1, that count their own samples. The picture
    /// is the mean of both means A and B. They also give the error: the expectation of
    /// (A - B)^2 / 4 is the variance of (A + B) / 2. For uneven samples, as in chapter 19: a half's
    /// mean is unbiased if only the other half decided on its number of samples.
    void start_halves();
    bool has_halves() const { return has_halves_; }
    const std::vector<PixelSum>& half(int number) const { return number == 0 ? pixels_ : audits_; }

    /// Adds the next sample of a pixel. Two threads must not add to one pixel.
    void add(size_t pixel, Rgb L, int half = 0) { sum_in(pixel, half).add(L); }

    /// Adds one part of a sample, to the sums only: the film then has a mean but no error.
    /// count_as() sets the numbers of samples.
    void add_part(size_t pixel, Rgb L, int half = 0) { sum_in(pixel, half).add_part(L); }
    /// This film holds parts of all samples of `whole`; it has halves if `whole` has.
    void count_as(const Film& whole) {
        for (size_t i = 0; i < pixels_.size(); i++) {
            pixels_[i].n = whole.pixels_[i].n;
            if (has_halves_) audits_[i].n = whole.audits_[i].n;
        }
    }

    /// Adds the contribution of a path from a light to the pixel in which the camera sees it. Two
    /// threads must not add to one pixel. The picture is the mean of the samples plus the sum of
    /// the splats over spp(), as each sample traces one path from a light.
    void splat(size_t pixel, Rgb L) { splats_[pixel].add_part(L); }
    /// Adds the total of the next sample of a pixel: the sample plus its splats to all pixels.
    /// Totals are independent of each other, so they give the error of the mean.
    void add_total(size_t pixel, Rgb L) { totals_[pixel].add(L); }
    bool takes_splats() const { return !splats_.empty(); }

    /// From now on some pixels are audited: they take each of their samples a second time, with
    /// random numbers of another key.
    ///
    /// Samples of one pixel may depend on each other, as stratified ones do; then their spread does
    /// not give the error of their mean. Two independent sets do: if A and B are their means, the
    /// expectation of (A - B)^2 / 2 is the variance of each. Pixels at the edges of lamps are few
    /// but may have most of the error, so they are audited separately: of either kind one pixel in
    /// 256, or more so that there are at least 64. Called after all edges are marked.
    void mark_edge(size_t pixel) { pixels_[pixel].is_edge = 1; }
    void start_audit();
    bool has_audits() const { return !audits_.empty() && !has_halves_; }
    bool is_audited(size_t pixel) const { return pixels_[pixel].is_audited > 0; }
    /// Adds the audit sample that belongs to the last sample of this pixel.
    void audit(size_t pixel, Rgb L) { audits_[audit_of(pixel)].add(L); }

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

    /// The picture: the value of each pixel, black where it has no samples yet.
    Image image() const;

    /// The number of samples of each pixel, in all three channels.
    Image counts() const;

    /// Mean over channels and the pixels that have samples.
    double mean() const { return sum_of(mean_channels()) / 3; }
    Rgb mean_rgb() const { return to_rgb(mean_channels()); }

    /// Standard error of mean(), from the variance within the pixels; unknown (NaN) if a pixel has
    /// only one sample, or samples in only one half. For a film with splats, from the variance of
    /// the totals.
    ///
    ///   SE^2 = r sum over the pixels of v,   v = sum (Y - mean)^2 / (n - 1) / n
    ///   r    = sum of (A - B)^2 / 2 over the audited pixels / sum of v over them
    ///
    /// separately for the pixels at edges and the others. r is 1 without audits, when samples are
    /// independent of each other. Where pixels of a pass depend on each other, SE_b^2 minus the sum
    /// of v is added, if it is positive: that sum is what SE_b^2 would be if they did not.
    /// tested by  "consistency: the reported error is the spread over seeds, with each sampler"
    double standard_error() const;

    /// The number of data that standard_error() is based on: the more, the more reliable.
    struct ErrorBasis {
        double pixels = 0;   // (sum v)^2 / sum v^2: effective number of pixels
        double audits = 0;   // the same for the audited pixels (with halves, all); or 0
        double squares = 0;  // sum (Y - mean)^2 over all samples
    };
    ErrorBasis error_basis() const;

    /// (sum x)^2 / sum x^2 over all samples of the film: the effective number of samples.
    double effective_samples() const;

    /// The samples of a pixel, of both halves.
    uint64_t count_of(size_t pixel) const {
        return pixels_[pixel].n + (has_halves_ ? uint64_t{audits_[pixel].n} : 0);
    }
    size_t empty_pixels() const;  // those without samples
    /// All samples; samples per pixel, on average.
    uint64_t samples() const;
    double spp() const {
        return static_cast<double>(samples()) / static_cast<double>(pixels_.size());
    }

    const std::vector<PixelSum>& pixels() const { return pixels_; }
    std::vector<PixelSum>& pixels() { return pixels_; }
    /// All sums, to be added, written and read: those of the pixels, then those of the audits.
    using Sums = std::vector<PixelSum>;
    std::array<Sums*, 5> sums() { return {&pixels_, &audits_, &splats_, &totals_, &batches_}; }
    std::array<const Sums*, 5> sums() const {
        return {&pixels_, &audits_, &splats_, &totals_, &batches_};
    }

private:
    struct ErrorPart;
    std::array<ErrorPart, 2> error_parts() const;  // elsewhere, at edges
    Rgbd mean_of(size_t pixel, double spp) const;
    size_t audit_of(size_t pixel) const {
        auto place = std::lower_bound(audited_.begin(), audited_.end(), pixel);
        return static_cast<size_t>(place - audited_.begin());
    }
    PixelSum& sum_in(size_t pixel, int half) { return half == 0 ? pixels_[pixel] : audits_[pixel]; }
    Rgbd mean_channels() const;
    double variance_of_batches() const;

    /// The sums that the error is estimated from, and (below) those of all samples.
    const Sums& measured() const { return splats_.empty() ? pixels_ : totals_; }
    std::array<const Sums*, 2> measured_halves() const {
        static const Sums none;
        return {&measured(), has_halves_ ? &audits_ : &none};
    }

    std::vector<PixelSum> pixels_, audits_;  // the audits may be a second half
    bool has_halves_ = false;
    std::vector<size_t> audited_;            // the pixels that the audits belong to, in order
    std::vector<PixelSum> splats_, totals_;  // none for a film without
    std::vector<PixelSum> batches_;          // none where samples are independent of other pixels'
};
