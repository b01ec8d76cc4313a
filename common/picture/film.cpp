#include "common/picture/film.h"

Film::Channels Film::mean_of(size_t pixel, double spp) const {
    const PixelSum& p = pixels_[pixel];
    double n = static_cast<double>(std::max<uint64_t>(p.n, 1));
    Channels c = {p.r() / n, p.g() / n, p.b() / n};
    if (splats_.empty()) return c;
    const ExactSum* splats = &splats_[3 * pixel];
    return {c.r + splats[0].value() / spp, c.g + splats[1].value() / spp,
            c.b + splats[2].value() / spp};
}

Film::Channels Film::mean_channels() const {
    Channels sum;
    double all = spp(), seen = 0;
    for (size_t i = 0; i < pixels_.size(); i++) {
        if (pixels_[i].n == 0) continue;
        Channels c = mean_of(i, all);
        sum.r += c.r, sum.g += c.g, sum.b += c.b;
        seen++;
    }
    seen = std::max(seen, 1.0);
    return {sum.r / seen, sum.g / seen, sum.b / seen};
}

Image Film::image() const {
    Image image(width, height);
    double all = spp();
    for (size_t i = 0; i < pixels_.size(); i++) {
        Channels c = mean_of(i, all);
        image.pixels[i] = {static_cast<float>(c.r), static_cast<float>(c.g),
                           static_cast<float>(c.b)};
    }
    return image;
}

Rgb Film::mean_rgb() const {
    Channels c = mean_channels();
    return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

double Film::mean() const {
    Channels c = mean_channels();
    return (c.r + c.g + c.b) / 3;
}

static double variance_of_mean(const PixelSum& p) {
    double n = p.n;
    return p.m2() / (n - 1) / n;
}

double Film::standard_error() const {
    if (!splats_.empty()) return std::nan("");
    double sum = 0, seen = 0;
    for (const PixelSum& p : pixels_) {
        if (p.n == 0) continue;
        if (p.n == 1) return std::nan("");
        sum += variance_of_mean(p);
        seen++;
    }
    double found = 0, expected = 0;
    for (size_t i = 0; i < audits_.size(); i++) {
        const PixelSum &p = pixels_[audited_pixel(i)], &again = audits_[i];
        if (p.n == 0) continue;
        double difference = p.mean() - again.mean();
        found += difference * difference / 2;
        expected += (variance_of_mean(p) + variance_of_mean(again)) / 2;
    }
    if (expected > 0) sum *= found / expected;
    return seen > 0 ? std::sqrt(sum) / seen : std::nan("");
}

Film::ErrorBasis Film::error_basis() const {
    ErrorBasis basis;
    double sum = 0, squares = 0, audited = 0, audited_squares = 0;
    for (size_t i = 0; i < pixels_.size(); i++) {
        if (pixels_[i].n < 2) continue;
        double v = variance_of_mean(pixels_[i]);
        basis.squares += pixels_[i].m2();
        sum += v, squares += v * v;
        if (is_audited(i)) audited += v, audited_squares += v * v;
    }
    if (squares > 0) basis.pixels = sum * sum / squares;
    if (audited_squares > 0) basis.audits = audited * audited / audited_squares;
    return basis;
}

double Film::effective_samples() const {
    double sum = 0, squares = 0;
    for (const PixelSum& p : pixels_) {
        sum += p.n * p.mean();
        squares += p.sum_of_squares();
    }
    return squares > 0 ? sum * sum / squares : 0;
}

void Film::add(const Film& other) {
    for (size_t i = 0; i < pixels_.size(); i++) pixels_[i].add(other.pixels_[i]);
    for (size_t i = 0; i < audits_.size(); i++) audits_[i].add(other.audits_[i]);
}

uint64_t Film::samples() const {
    uint64_t sum = 0;
    for (const PixelSum& p : pixels_) sum += p.n;
    return sum;
}
