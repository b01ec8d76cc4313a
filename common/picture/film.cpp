#include "common/picture/film.h"

void PixelSum::raise(Sum sum, int by) {
    if (std::isnan(bins[0][sum])) return;
    for (int i = 2; i >= 0; i--) bins[i][sum] = i >= by ? bins[i - by][sum] : 0;
}

void PixelSum::raise_to(int channels, int squares_to) {
    for (Sum sum : {red, green, blue}) raise(sum, std::max(0, channels - top_channels));
    raise(squares, std::max(0, squares_to - top_squares));
    top_channels = std::max(top_channels, static_cast<uint8_t>(channels));
    top_squares = std::max(top_squares, static_cast<uint8_t>(squares_to));
}

void PixelSum::add_large(double r, double g, double b, double y2) {
    double numbers[sums] = {r, g, b, y2};
    for (Sum sum : {red, green, blue, squares}) {
        if (std::isfinite(numbers[sum])) continue;
        numbers[sum] = 0;
        for (auto& bin : bins) bin[sum] = std::nan("");
    }
    const auto& limit = pixel_sum::tops.limit;
    double largest = std::abs(numbers[0]) + std::abs(numbers[1]) + std::abs(numbers[2]);
    int channels = top_channels, squares_to = top_squares;
    while (!(largest < limit[static_cast<size_t>(channels)])) channels++;
    while (!(numbers[squares] < limit[static_cast<size_t>(squares_to)])) squares_to++;
    raise_to(channels, squares_to);
    add_fitting(numbers[0], numbers[1], numbers[2], numbers[3]);
}

void PixelSum::add(const PixelSum& other) {
    PixelSum aligned = other;
    aligned.raise_to(top_channels, top_squares);
    raise_to(aligned.top_channels, aligned.top_squares);
    for (size_t i = 0; i < 3; i++) {
        for (Sum sum : {red, green, blue, squares}) bins[i][sum] += aligned.bins[i][sum];
    }
    n += other.n;
}

PixelSum::Double2 PixelSum::add(Double2 a, Double2 b) {  // source: Knuth's two-sum
    double sum = a.high + b.high, from_b = sum - a.high;
    double lost = (a.high - (sum - from_b)) + (b.high - from_b);
    return {sum, lost + a.low + b.low};
}

PixelSum::Double2 PixelSum::value(Sum sum) const {
    return add(add({bins[0][sum], 0}, {bins[1][sum], 0}), {bins[2][sum], 0});
}

PixelSum::Double2 PixelSum::brightness() const {
    return add(add(value(red), value(green)), value(blue));
}

double PixelSum::m2() const {
    if (n == 0) return 0;
    // sum (X - q)^2 = sum X^2 - 2 q sum X + n q^2 with q = mean X. Where the mean is large, almost
    // all of it cancels: so fma() keeps what the products lose by rounding.
    Double2 sum = brightness(), sum2 = value(squares);
    double count = n, q = sum.high / count;
    double a = 2 * q * sum.high, a_lost = std::fma(2 * q, sum.high, -a);
    double q2 = q * q, q2_lost = std::fma(q, q, -q2);
    double b = count * q2, b_lost = std::fma(count, q2, -b);
    double high = (sum2.high - a) + b;
    double low = (sum2.low - a_lost) + b_lost + count * q2_lost - 2 * q * sum.low;
    double all = high + low;
    return (all < 0 ? 0 : all) / 9;  // keeps NaN
}

Rgbd Film::mean_of(size_t pixel, double spp) const {
    auto over = [](const PixelSum& p, double n) { return Rgbd{p.r() / n, p.g() / n, p.b() / n}; };
    const PixelSum& a = pixels_[pixel];
    Rgbd c = over(a, std::max(a.n, 1u));
    if (has_halves_ && audits_[pixel].n > 0) {
        Rgbd b = over(audits_[pixel], audits_[pixel].n);
        c = a.n == 0 ? b : 0.5 * (c + b);
    }
    return splats_.empty() ? c : c + over(splats_[pixel], spp);
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
    for (size_t i = 0; i < pixels_.size(); i++)
        image.pixels[i] = static_cast<float>(count_of(i)) * Rgb{1, 1, 1};
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
        if (!is_audited(i) || p.n < 2) continue;
        const PixelSum& again = audits_[audit_of(i)];
        double difference = p.mean() - again.mean();
        double both = (v + variance_of_mean(again)) / 2;
        part.found += difference * difference / 2;
        part.audited += both, part.audited2 += both * both;
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
