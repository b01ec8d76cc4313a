#include "common/picture/film.h"

Image Film::image() const {
    Image image(width, height);
    double n = static_cast<double>(std::max<uint64_t>(spp, 1));
    for (size_t i = 0; i < pixels_.size(); i++) {
        const PixelSum& p = pixels_[i];
        image.pixels[i] = {static_cast<float>(p.r / n), static_cast<float>(p.g / n),
                           static_cast<float>(p.b / n)};
    }
    return image;
}

Rgb Film::mean_rgb() const {
    double r = 0, g = 0, b = 0;
    for (const PixelSum& p : pixels_) r += p.r, g += p.g, b += p.b;
    double n =
        static_cast<double>(std::max<uint64_t>(spp, 1)) * static_cast<double>(pixels_.size());
    return {static_cast<float>(r / n), static_cast<float>(g / n), static_cast<float>(b / n)};
}

double Film::mean() const {
    double sum = 0;
    for (const PixelSum& p : pixels_) sum += p.r + p.g + p.b;
    double n = static_cast<double>(std::max<uint64_t>(spp, 1));
    return sum / (3 * n * static_cast<double>(pixels_.size()));
}

double Film::standard_error() const {
    if (spp < 2) return std::nan("");
    double n = static_cast<double>(spp), sum = 0;
    for (const PixelSum& p : pixels_) sum += p.m2 / (n - 1) / n;
    return std::sqrt(sum) / static_cast<double>(pixels_.size());
}

double Film::effective_samples() const {
    double n = static_cast<double>(spp), sum = 0, squares = 0;
    for (const PixelSum& p : pixels_) {
        sum += n * p.mean;
        squares += p.m2 + n * p.mean * p.mean;
    }
    return squares > 0 ? sum * sum / squares : 0;
}
