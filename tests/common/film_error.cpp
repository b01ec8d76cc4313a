// What a film tells of its error: audits, halves, batches; and pictures compared with each other
// by another way of counting.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "common/path/sampler.h"
#include "common/picture/comparison.h"
#include "common/picture/film.h"
#include "tests/support/gates.h"
#include "tests/support/scenes.h"

namespace {

/// x, but for rounding.
doctest::Approx about(double x) { return nearly(x, 1e-9); }

double mean_of(const std::vector<double>& x) {
    return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}
/// The variance of the mean of these samples.
double variance_of_mean(const std::vector<double>& x) {
    double m = mean_of(x), sum = 0, n = static_cast<double>(x.size());
    for (double v : x) sum += (v - m) * (v - m);
    return sum / (n - 1) / n;
}

/// Numbers that a float holds, some larger than others.
std::vector<double> samples_of(uint32_t key, int n, double size = 1) {
    Sampler sampler(SamplerType::independent, 9, 1);
    std::vector<double> x;
    for (int s = 0; s < n; s++) {
        sampler.start(key, static_cast<uint32_t>(s));
        x.push_back(size * std::floor(256 * double{sampler.u1()}) / 256);
    }
    return x;
}

Image random_image(int width, int height, uint32_t seed) {
    Image image(width, height);
    Sampler sampler(SamplerType::independent, seed, 1);
    for (uint32_t i = 0; i < image.pixels.size(); i++) {
        sampler.start(i, 0);
        float u = sampler.u1(), v = sampler.u1(), w = sampler.u1();
        image.pixels[i] = {u < 0.2f ? 1 : 2 * u, v * v, u < 0.1f ? 0 : 3 * w};
        if (i % 11 == 0) image.pixels[i] = {};
    }
    return image;
}

}  // namespace

TEST_SUITE("film error") {
    TEST_CASE("identity: few pixels are audited: one of each group, at edges and elsewhere") {
        for (auto [edges, audited] : {std::pair(0, 65), {200, 132}}) {  // 65 of 1800, 67 of 200
            Film film(40, 50);
            for (int i = 0; i < edges; i++) film.mark_edge(static_cast<size_t>(7 * i));
            film.start_audit();
            int count = 0, at_edges = 0;
            size_t last = 0, widest = 0;
            for (size_t i = 0; i < 2000; i++) {
                if (!film.is_audited(i)) continue;
                count++, at_edges += film.pixels()[i].is_edge;
                widest = std::max(widest, i - last), last = i;
            }
            CHECK(count == audited);
            CHECK(film.sums()[1]->size() == static_cast<size_t>(count));
            CHECK((at_edges > 0) == (edges > 0));
            CHECK(widest < 90);  // all over the picture
        }
    }

    TEST_CASE("truth: audits scale the error of the pixels like them, at edges and elsewhere") {
        // 20 x 20 pixels, 50 at edges, which are noisier.
        Film film(20, 20);
        for (size_t i = 0; i < 400; i += 8) film.mark_edge(i);
        film.start_audit();
        double v[2] = {}, v2[2] = {}, found[2] = {}, audited[2] = {}, audited2[2] = {};
        double sum = 0, sum2 = 0, m2 = 0;
        for (size_t i = 0; i < 400; i++) {
            bool edge = i % 8 == 0;
            int n = 3 + static_cast<int>(i % 4);
            std::vector<double> x = samples_of(static_cast<uint32_t>(i), n, edge ? 8 : 1);
            for (double s : x) film.add(i, grey(s)), sum += s, sum2 += s * s;
            double here = variance_of_mean(x);
            m2 += here * n * (n - 1);
            v[edge] += here, v2[edge] += here * here;
            if (!film.is_audited(i)) continue;
            std::vector<double> y = samples_of(static_cast<uint32_t>(i + 1000), n, edge ? 8 : 1);
            for (double s : y) film.add(i, grey(s), 1);
            double both = (here + variance_of_mean(y)) / 2;
            found[edge] += std::pow(mean_of(x) - mean_of(y), 2) / 2;
            audited[edge] += both, audited2[edge] += both * both;
        }
        double share[2], squares = 0, of_audits = 0, all = 0;
        for (int e : {0, 1}) {
            double r = found[e] / audited[e];
            CHECK(r > 0.1);
            share[e] = r * v[e], all += share[e];
            squares += r * r * v2[e];
            of_audits += share[e] * share[e] * audited2[e] / audited[e] / audited[e];
        }
        CHECK(film.standard_error() == about(std::sqrt(all) / 400));
        Film::Error basis = film.error();
        CHECK(basis.pixels == about(all * all / squares));
        CHECK(basis.audits == about(all * all / of_audits));
        CHECK(basis.squares == about(m2));
        CHECK(film.error().samples == about(sum * sum / sum2));
    }

    TEST_CASE("truth: two halves tell the error by how far apart they are") {
        Film film(6, 5);
        film.start_halves();
        double difference = 0, v_sum = 0, v2_sum = 0, m2 = 0, mean = 0, sum = 0, sum2 = 0;
        for (uint32_t i = 0; i < 30; i++) {
            std::vector<double> half[2] = {samples_of(i, 2 + static_cast<int>(i % 3)),
                                           samples_of(i + 99, 3 + static_cast<int>(i % 2), 2)};
            double v = 0;
            for (int h : {0, 1}) {
                double here = variance_of_mean(half[h]), n = static_cast<double>(half[h].size());
                for (double s : half[h]) film.add(i, grey(s), h), sum += s, sum2 += s * s;
                v += here / 4, m2 += here * n * (n - 1), mean += mean_of(half[h]) / 2 / 30;
            }
            difference += std::pow(mean_of(half[0]) - mean_of(half[1]), 2) / 4;
            v_sum += v, v2_sum += v * v;
        }
        CHECK(film.mean() == about(mean));
        CHECK(film.samples() == 30 * 3 + 15 * 7);
        CHECK(film.standard_error() == about(std::sqrt(difference) / 30));
        Film::Error basis = film.error();
        CHECK(basis.pixels == about(v_sum * v_sum / v2_sum));
        CHECK(basis.audits == about(basis.pixels));
        CHECK(basis.squares == about(m2));
        CHECK(film.error().samples == about(sum * sum / sum2));
        CHECK_FALSE(film.has_audits());
        CHECK(film.counts().at(1, 0).g == 3 + 4);
    }

    TEST_CASE("truth: whole passes tell the error by their means, each by its weight") {
        // 40 passes of 4 pixels, bright in every third pass: all pixels of a pass together.
        auto passes_of = [](uint32_t pass) {
            std::vector<double> x = samples_of(pass, 4);
            for (double& s : x) s += pass % 3 == 0 ? 5 : 0;
            return x;
        };
        auto batch_of = [](uint32_t pass) {
            return hash32(pass) % static_cast<uint32_t>(Film::most_batches);
        };
        Film film(2, 2);
        film.start_batches();
        std::map<uint32_t, std::vector<double>> batch;
        for (uint32_t pass = 0; pass < 40; pass++) {
            std::vector<double> x = passes_of(pass);
            PixelSum sum;
            for (size_t i = 0; i < 4; i++) film.add(i, grey(x[i])), sum.add(grey(x[i]));
            film.add_to_batch(pass, sum);
            for (double s : x) batch[batch_of(pass)].push_back(s);
        }
        CHECK(batch.size() < 40);  // some batches have more than one pass
        auto expected = [&] {
            std::vector<double> all;
            for (const auto& [b, x] : batch) all.insert(all.end(), x.begin(), x.end());
            double mean = mean_of(all), squares = 0, weights = 0;
            for (const auto& [b, x] : batch) {
                double w = static_cast<double>(x.size()) / static_cast<double>(all.size());
                squares += std::pow(w * (mean_of(x) - mean), 2), weights += w * w;
            }
            return std::sqrt(squares / (1 - weights));
        };
        CHECK(film.has_batches());
        CHECK(film.standard_error() == about(expected()));
        // A pass that is not whole spoils its batch alone.
        PixelSum half;
        for (double x : {1.0, 2.0}) half.add(grey(x));
        film.add_to_batch(31, half);
        batch.erase(batch_of(31));
        CHECK(film.standard_error() == about(expected()));
    }

    TEST_CASE("brute: a comparison's numbers counted in another way") {
        const int width = 37, height = 21;
        Image a = random_image(width, height, 3), b = random_image(width, height, 4);
        for (size_t i = 0; i < 300; i++) a.pixels[i] = 1.1f * b.pixels[i];
        auto of = [](Rgb p, size_t channel) {
            return std::array{double{p.r}, double{p.g}, double{p.b},
                              (double{p.r} + double{p.g} + double{p.b}) / 3}[channel];
        };
        // 5 x 3 blocks, of which the last column and row are 5 pixels wide.
        Comparison c = compare(a, b);
        CHECK(c.blocks == 15);
        double variance[4] = {};
        int beyond[4] = {};
        for (int y0 = 0; y0 < height; y0 += 8)
            for (int x0 = 0; x0 < width; x0 += 8)
                for (size_t channel = 0; channel < 4; channel++) {
                    std::vector<double> d;
                    for (int y = y0; y < std::min(height, y0 + 8); y++)
                        for (int x = x0; x < std::min(width, x0 + 8); x++)
                            d.push_back(of(a.at(x, y), channel) - of(b.at(x, y), channel));
                    double n = static_cast<double>(d.size()), v = variance_of_mean(d);
                    variance[channel] += n * n * v;
                    beyond[channel] += std::abs(mean_of(d)) > 5 * std::sqrt(v);
                }
        for (size_t i = 0; i < 4; i++) {
            const ChannelComparison& row = c.rows[(i + 1) % 4];
            CHECK(row.standard_error == about(std::sqrt(variance[i]) / (width * height)));
            CHECK(row.beyond_5 == beyond[i]);
            CHECK(row.z() == about(std::abs(row.mean_a - row.mean_b) / row.standard_error));
        }
        CHECK(beyond[0] > 0);
    }
}
