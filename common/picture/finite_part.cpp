#include "common/picture/finite_part.h"

FinitePart finite_part(const Film& film) {
    if (std::isfinite(film.mean())) {
        return {film.mean(), film.standard_error(), film.mean_rgb(), 1};
    }
    Film rest = film;
    Image image = film.image();
    double sum[3] = {}, seen = 0, finite = 0;
    for (size_t i = 0; i < image.pixels.size(); i++) {
        if (film.count_of(i) == 0) continue;
        seen++;
        Rgb L = image.pixels[i];
        if (is_finite(L)) {
            finite++;
            sum[0] += double{L.r}, sum[1] += double{L.g}, sum[2] += double{L.b};
            continue;
        }
        rest.pixels()[i] = {};
        if (film.has_halves()) rest.audits()[i] = {};
    }
    // The error may rest on more than the pixels: on the totals of paths that also show light to
    // other pixels, and on whole passes.
    auto leave_out = [](std::vector<PixelSum>& sums) {
        for (PixelSum& s : sums) {
            if (!std::isfinite(s.mean())) s = {};
        }
    };
    leave_out(rest.totals());
    leave_out(rest.batches());
    FinitePart part;
    part.mean = (sum[0] + sum[1] + sum[2]) / 3 / finite;
    part.error = finite > 0 ? rest.standard_error() : std::nan("");
    auto mean_of = [&](double channel) { return static_cast<float>(channel / finite); };
    part.rgb = {mean_of(sum[0]), mean_of(sum[1]), mean_of(sum[2])};
    part.share = finite / seen;
    return part;
}
