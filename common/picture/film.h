// The film: sums of samples, pixel by pixel, and what they say about their own error.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "common/path/sampler.h"
#include "common/path/splats.h"
#include "common/picture/image.h"
#include "common/picture/pixel_sum.h"

/// Adds up samples, in sums that do not depend on their order. Each pixel counts its own samples,
/// and has the mean of those.
class Film {
public:
    int width, height;

    Film(int w, int h, bool takes_splats = false)
        : width(w),
          height(h),
          pixels_(static_cast<size_t>(w) * static_cast<size_t>(h)),
          splats_(takes_splats ? pixels_.size() : 0),
          totals_(splats_.size()) {}

    /// From now on each pixel has two halves, 0 and 1, that count their samples each. The picture
    /// is the mean of both halves' means, and they tell the error: (A - B)^2 / 4 is on the mean the
    /// variance of (A + B) / 2. For samples that are shared out unevenly, as in chapter 19: each
    /// half's mean is then without bias if the other half alone decided on the number of samples.
    void start_halves();
    bool has_halves() const { return has_halves_; }
    const std::vector<PixelSum>& half(int number) const { return number == 0 ? pixels_ : audits_; }

    /// Adds the next sample of a pixel. Two threads must not add to one pixel.
    void add(size_t pixel, Rgb L, int half = 0) { sum_of(pixel, half).add(L); }

    /// Adds what part of a sample brings, as often as it has parts: to the sums alone, so that the
    /// film knows its mean but not its error. How many samples there were, count_as() tells.
    void add_part(size_t pixel, Rgb L, int half = 0) { sum_of(pixel, half).add_part(L); }
    /// This film holds parts of all the samples of `whole`, and has halves if that has.
    void count_as(const Film& whole) {
        for (size_t i = 0; i < pixels_.size(); i++) pixels_[i].n = whole.pixels_[i].n;
        for (size_t i = 0; has_halves_ && i < audits_.size(); i++)
            audits_[i].n = whole.audits_[i].n;
    }

    /// Adds what a path from a light brings to a pixel that it happens to meet. Two threads must
    /// not add to one pixel. The picture is the mean of the samples plus the sum of the splats over
    /// spp(): one path from a light for each sample.
    void splat(size_t pixel, Rgb L) { splats_[pixel].add_part(L); }
    /// Adds what sample and splats together have brought that belong to the next sample of a pixel:
    /// these totals are independent of each other, and so tell the error of the mean.
    void add_total(size_t pixel, Rgb L) { totals_[pixel].add(L); }
    bool takes_splats() const { return !splats_.empty(); }

    /// From now on some pixels are audited: they take each of their samples a second time, with
    /// random numbers of another key.
    ///
    /// Samples of one pixel may depend on each other, as stratified ones do; then their spread does
    /// not tell the error of their mean. Two sets of samples tell: of the means A and B of both,
    /// (A - B)^2 / 2 is on the mean the variance of one. Of the pixels at the edges of lamps, which
    /// are few and may carry most of the error, and of all others, each: one of 256, or of fewer so
    /// that there are 64 or more. Called once all edges are marked.
    void mark_edge(size_t pixel) { pixels_[pixel].is_edge = 1; }
    void start_audit();
    bool has_audits() const { return !audits_.empty() && !has_halves_; }
    bool is_audited(size_t pixel) const { return pixels_[pixel].is_audited > 0; }
    /// Adds the sample that goes with the last one of this pixel.
    void audit(size_t pixel, Rgb L) {
        auto place = std::lower_bound(audited_.begin(), audited_.end(), pixel);
        audits_[static_cast<size_t>(place - audited_.begin())].add(L);
    }

    /// From now on the samples of one pass, those of all pixels that have the same number, may
    /// depend on each other. Passes are independent, so their totals tell the error: each is added
    /// to one of a few batches, by its number.
    ///
    ///   SE^2 = B / (B - 1) sum over the B batches of (n_b / n)^2 (mean_b - mean)^2
    ///
    /// Batches with a pass that is not complete are left out.
    static constexpr size_t most_batches = 32;
    void start_batches() { batches_.assign(most_batches, {}); }
    bool has_batches() const { return !batches_.empty(); }
    /// Adds samples of pass number `pass`. Two threads must not do so at once.
    void add_to_batch(uint32_t pass, const PixelSum& samples) {
        batches_[pass % most_batches].add(samples);
    }
    std::vector<PixelSum>& batches() { return batches_; }
    const std::vector<PixelSum>& batches() const { return batches_; }

    /// Adds the samples of another film of the same size, which has audits if this has.
    void add(const Film& other);

    /// What each pixel has, as a picture; black where it has nothing yet.
    Image image() const;

    /// How many samples each pixel has, in all three channels.
    Image counts() const;

    /// Mean over channels and the pixels that have samples.
    double mean() const;
    Rgb mean_rgb() const;

    /// Standard error of mean(), from the variance within the pixels; unknown (NaN) where a pixel
    /// has one sample alone, or samples in one half alone. In a film that takes splats, from that
    /// of the totals.
    ///
    ///   SE^2 = r sum over the pixels of v,   v = sum (Y - mean)^2 / (n - 1) / n
    ///   r    = sum of (A - B)^2 / 2 over the audited pixels / sum of v over them
    ///
    /// for the pixels at edges and for the others, each. r is 1 without audits, for samples that
    /// are independent of each other. tested by  "consistency: the reported error is the spread
    /// over seeds, with each sampler"
    double standard_error() const;

    /// What standard_error() rests on: the more the better.
    struct ErrorBasis {
        double pixels = 0;   // (sum v)^2 / sum v^2: how many pixels carry the error
        double audits = 0;   // the same of the audited pixels (with halves, of all); or 0
        double squares = 0;  // sum (Y - mean)^2 over all samples
    };
    ErrorBasis error_basis() const;

    /// (sum x)^2 / sum x^2 over all samples of the film: how many samples really carry it.
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
    /// The sums of the pixels and of the audits, to be written and read; see film_file.h.
    std::vector<PixelSum>& pixels() { return pixels_; }
    std::vector<PixelSum>& audits() { return audits_; }
    const std::vector<PixelSum>& audits() const { return audits_; }
    std::vector<PixelSum>& splats() { return splats_; }
    const std::vector<PixelSum>& splats() const { return splats_; }
    std::vector<PixelSum>& totals() { return totals_; }
    const std::vector<PixelSum>& totals() const { return totals_; }

private:
    struct Channels {
        double r = 0, g = 0, b = 0;
    };
    struct ErrorPart;
    std::array<ErrorPart, 2> error_parts() const;  // elsewhere, at edges
    Channels mean_of(size_t pixel, double spp) const;
    PixelSum& sum_of(size_t pixel, int half) { return half == 0 ? pixels_[pixel] : audits_[pixel]; }
    Channels mean_channels() const;
    double error_of_batches() const;

    /// What the error is told by.
    const std::vector<PixelSum>& measured() const { return splats_.empty() ? pixels_ : totals_; }

    std::vector<PixelSum> pixels_, audits_;  // the audits may be a second half
    bool has_halves_ = false;
    std::vector<size_t> audited_;            // the pixels that the audits belong to, in order
    std::vector<PixelSum> splats_, totals_;  // none for a film without
    std::vector<PixelSum> batches_;          // none where samples are independent of other pixels'
};
