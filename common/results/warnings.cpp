#include "common/results/warnings.h"

#include <algorithm>
#include <cmath>

#include "common/base/percent.h"
#include "common/results/black_picture.h"
#include "common/results/missed_light.h"

namespace {

constexpr double too_much = 0.01;     // of a picture, in one sample
constexpr double negligible = 0.001;  // standard error, of the mean: no noise to warn of
constexpr double few_samples = 100;   // effective samples: below, intervals are too short
constexpr double much_blur = 0.1;     // of the standard error
constexpr double few_pixels = 30, few_audits = 16;  // that the error is estimated from

}  // namespace

std::vector<std::string> warnings_of(const Film& film, const SampleCounts& counts) {
    std::vector<std::string> lines;
    double samples = static_cast<double>(film.samples());
    double empty = static_cast<double>(film.empty_pixels());
    if (empty > 0) {
        lines.push_back("rendering ended before " +
                        percent(empty / static_cast<double>(film.pixels().size())) +
                        " of the pixels had a sample: they are black");
    }
    double sum = film.mean() * samples;
    if (samples > 0 && sum == 0) lines.push_back("the picture is black: no sample found light");
    if (sum > 0 && counts.largest > too_much * sum) {
        lines.push_back("one sample contains " + percent(counts.largest / sum) +
                        " of the whole picture");
    }
    double effective = film.effective_samples();
    bool has_noise = !(film.standard_error() < negligible * film.mean());  // or it is unknown
    if (has_noise && effective > 0 && effective < few_samples) {
        lines.push_back(
            "as few as " + std::to_string(std::lround(effective)) +
            " samples determine the picture: the true error is larger than the reported one");
    }
    Film::ErrorBasis basis = film.error_basis();
    double excess = std::max(counts.largest - film.mean(), 0.0);
    bool one_in_many =
        basis.pixels < few_pixels && basis.squares > 0 && excess * excess > 0.05 * basis.squares;
    if (has_noise && one_in_many && effective >= few_samples) {
        lines.push_back(
            "a few bright samples determine the error: the true error is larger than the reported "
            "one");
    }
    if (film.has_batches() && film.spp() > 1 && film.spp() < few_audits) {
        lines.push_back(
            "the error is estimated from few passes: the true one may be half or twice as large");
    }
    // If light is even, half of the photons lie in the inner half of their disk. What is not there
    // is about the part by which blur changes the light that they bring.
    double half = static_cast<double>(counts.photons) / 2;
    double blur = std::abs(static_cast<double>(counts.inner_photons) / half - 1);
    if (half > 0 && !(blur * film.mean() < much_blur * film.standard_error())) {
        lines.push_back(
            "photons blur light within their radius: the reported error does not include this "
            "bias");
    }
    bool is_told_by_means = film.has_audits() || film.has_halves();
    if (is_told_by_means && basis.squares > 0 && basis.audits < few_audits) {
        lines.push_back(
            "the error is estimated from few pixels: the true one may be half or twice as large");
    }
    return lines;
}

std::vector<std::string> warnings_of(const Scene& scene, const RenderOptions& options,
                                     const Rendering& r) {
    std::vector<std::string> lines = warnings_of(r.film, r.stats);
    if (r.film.samples() > 0 && r.film.mean() == 0) {
        for (const std::string& cause : causes_of_black(scene, options)) {
            lines.push_back("possible cause: " + cause);
        }
    }
    for (const auto& more : {missed_light(scene, options, r.film), r.warnings})
        lines.insert(lines.end(), more.begin(), more.end());
    return lines;
}
