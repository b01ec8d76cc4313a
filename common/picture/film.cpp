#include "common/picture/film.h"

Rgbd Film::mean_of(size_t pixel, double spp) const {
    auto mean = [](const PixelSum& p) {
        double n = std::max(p.n, 1u);
        return Rgbd{p.r() / n, p.g() / n, p.b() / n};
    };
    Rgbd c = mean(pixels_[pixel]);
    if (has_halves_ && audits_[pixel].n > 0) {
        Rgbd b = mean(audits_[pixel]);
        c = pixels_[pixel].n == 0 ? b : 0.5 * (c + b);
    }
    if (splats_.empty()) return c;
    const PixelSum& splats = splats_[pixel];
    return c + Rgbd{splats.r() / spp, splats.g() / spp, splats.b() / spp};
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
    for (size_t i = 0; i < pixels_.size(); i++) {
        float n = static_cast<float>(count_of(i));
        image.pixels[i] = {n, n, n};
    }
    return image;
}

static double variance_of_mean(const PixelSum& p) {
    double n = p.n;
    return p.m2() / (n - 1) / n;
}

void Film::start_halves() {
    has_halves_ = true;
    audits_.assign(pixels_.size(), {});
}

void Film::start_audit() {
    audited_.clear();
    for (PixelSum& p : pixels_) p.is_audited = 0;
    for (bool at_edges : {false, true}) {
        std::vector<size_t> some;
        for (size_t i = 0; i < pixels_.size(); i++) {
            if (pixels_[i].is_edge == at_edges) some.push_back(i);
        }
        size_t one_of = std::clamp<size_t>(some.size() / 64, 1, 256);
        for (size_t first = 0; first < some.size(); first += one_of) {
            size_t size = std::min(one_of, some.size() - first);
            size_t chosen = hash32(static_cast<uint32_t>(first)) % size;
            audited_.push_back(some[first + chosen]);
        }
    }
    std::sort(audited_.begin(), audited_.end());
    for (size_t pixel : audited_) pixels_[pixel].is_audited = 1;
    audits_.assign(audited_.size(), {});
}

/// The sums that estimate the error, over pixels of one kind: at edges, or elsewhere.
struct Film::ErrorPart {
    double v = 0, v2 = 0;                         // sums of v and v^2 over the pixels
    double found = 0, audited = 0, audited2 = 0;  // over the audited ones: (A - B)^2 / 2, v, v^2

    double r() const { return audited > 0 ? found / audited : 1; }
};

std::array<Film::ErrorPart, 2> Film::error_parts() const {
    std::array<ErrorPart, 2> parts;
    for (size_t i = 0; i < pixels_.size(); i++) {
        const PixelSum& p = measured()[i];
        double v = p.n < 2 ? 0 : variance_of_mean(p);
        if (has_halves_ && audits_[i].n >= 2) v = (v + variance_of_mean(audits_[i])) / 4;
        ErrorPart& part = parts[pixels_[i].is_edge];
        part.v += v, part.v2 += v * v;
    }
    for (size_t i = 0; i < audited_.size(); i++) {
        const PixelSum &p = measured()[audited_[i]], &again = audits_[i];
        if (p.n < 2) continue;
        ErrorPart& part = parts[pixels_[audited_[i]].is_edge];
        double difference = p.mean() - again.mean();
        double v = (variance_of_mean(p) + variance_of_mean(again)) / 2;
        part.found += difference * difference / 2;
        part.audited += v, part.audited2 += v * v;
    }
    return parts;
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

double Film::standard_error() const {
    double seen = 0, sum = 0, as_if_independent = 0;
    for (size_t i = 0; i < pixels_.size(); i++) {
        if (count_of(i) == 1) return std::nan("");
        seen += count_of(i) > 0;
        if (!has_halves_) continue;
        if ((pixels_[i].n == 0) != (audits_[i].n == 0)) return std::nan("");
        double difference = pixels_[i].mean() - audits_[i].mean();
        sum += difference * difference / 4;
    }
    if (!has_halves_) {
        for (const ErrorPart& part : error_parts())
            sum += part.r() * part.v, as_if_independent += part.v;
    }
    if (has_batches() && seen > 0) {
        double all = variance_of_batches() * seen * seen;
        if (!(all <= as_if_independent)) sum += all - as_if_independent;  // NaN stays NaN
    }
    return seen > 0 ? std::sqrt(sum) / seen : std::nan("");
}

Film::ErrorBasis Film::error_basis() const {
    ErrorBasis basis;
    double sum = 0, squares = 0, of_audits = 0;
    for (const ErrorPart& part : error_parts()) {
        double share = part.r() * part.v;
        sum += share, squares += part.r() * part.r() * part.v2;
        if (part.audited > 0)
            of_audits += share * share * part.audited2 / part.audited / part.audited;
    }
    for (const Sums* half : measured_halves())
        for (const PixelSum& p : *half) basis.squares += p.n < 2 ? 0 : p.m2();
    if (squares > 0) basis.pixels = sum * sum / squares;
    if (of_audits > 0) basis.audits = sum * sum / of_audits;
    if (has_halves_) basis.audits = basis.pixels;
    return basis;
}

double Film::effective_samples() const {
    double sum = 0, squares = 0;
    for (const Sums* half : measured_halves())
        for (const PixelSum& p : *half) {
            sum += p.n * p.mean();
            squares += p.sum_of_squares();
        }
    return squares > 0 ? sum * sum / squares : 0;
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
