#include "common/picture/film.h"

Film::Channels Film::mean_of(size_t pixel, double spp) const {
    const PixelSum& p = pixels_[pixel];
    double n = static_cast<double>(std::max<uint64_t>(p.n, 1));
    Channels c = {p.r / n, p.g / n, p.b / n};
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

double Film::standard_error() const {
    if (!splats_.empty()) return std::nan("");
    double sum = 0, seen = 0;
    for (const PixelSum& p : pixels_) {
        if (p.n == 0) continue;
        if (p.n == 1) return std::nan("");
        double n = static_cast<double>(p.n);
        sum += p.m2 / (n - 1) / n;
        seen++;
    }
    return seen > 0 ? std::sqrt(sum) / seen : std::nan("");
}

double Film::effective_samples() const {
    double sum = 0, squares = 0;
    for (const PixelSum& p : pixels_) {
        double n = static_cast<double>(p.n);
        sum += n * p.mean;
        squares += p.m2 + n * p.mean * p.mean;
    }
    return squares > 0 ? sum * sum / squares : 0;
}

uint64_t Film::samples() const {
    uint64_t sum = 0;
    for (const PixelSum& p : pixels_) sum += p.n;
    return sum;
}
