// The film's sums against closed forms.
#include "common/picture/film.h"

#include <doctest/doctest.h>

#include "common/base/stats.h"
#include "common/path/sampler.h"

namespace {

Rgb grey(float v) { return {v, v, v}; }

/// A film of one row whose pixel x gets the samples rows[x], all of the same number.
Film film_of(const std::vector<std::vector<float>>& rows) {
    Film film(static_cast<int>(rows.size()), 1);
    for (size_t x = 0; x < rows.size(); x++) {
        for (size_t s = 0; s < rows[x].size(); s++) film.add(x, s, grey(rows[x][s]));
    }
    film.spp = rows[0].size();
    return film;
}

doctest::Approx about(double x) { return doctest::Approx(x).epsilon(1e-14).scale(0); }

}  // namespace

TEST_SUITE("film") {
    TEST_CASE("truth: mean, standard error and effective samples of six numbers") {
        // Variances within the pixels 1 and 0, so that of the mean of means (1/3 + 0/3) / 2^2.
        Film film = film_of({{0, 1, 2}, {4, 4, 4}});
        CHECK(film.mean() == about(2.5));
        CHECK(film.standard_error() == about(std::sqrt(1.0 / 3) / 2));
        CHECK(film.effective_samples() == about(15.0 * 15.0 / 53));
        CHECK(film.image().at(0, 0) == grey(1));
        CHECK(film.image().at(1, 0) == grey(4));
    }

    TEST_CASE("truth: what differs between pixels is the picture, not its error") {
        CHECK(film_of({{0, 0}, {100, 100}, {7, 7}}).standard_error() == 0);
        CHECK(film_of({{0, 2}, {100, 102}, {7, 9}}).standard_error() == about(std::sqrt(1.0 / 3)));
    }

    TEST_CASE("truth: the channels have means of their own, and the film's is their average") {
        Film film(1, 2);
        film.add(0, 0, {1, 2, 6});
        film.add(1, 0, {3, 2, 10});
        film.spp = 1;
        CHECK(film.mean_rgb() == Rgb{2, 2, 8});
        CHECK(film.mean() == about(4));
    }

    TEST_CASE("truth: one sample says nothing about its error") {
        CHECK(std::isnan(film_of({{3}, {5}}).standard_error()));
        CHECK(film_of({{3}, {5}}).mean() == 4);
    }

    TEST_CASE("truth: n equal samples are n effective ones, and a lone bright one is 1") {
        CHECK(film_of({{2, 2, 2}, {2, 2, 2}}).effective_samples() == about(6));
        CHECK(film_of({{0, 0, 1000}, {0, 0, 0}}).effective_samples() == about(1));
        CHECK(film_of({{0, 0}, {0, 0}}).effective_samples() == 0);
    }

    TEST_CASE("consistency: the standard error is the spread of the means of many films") {
        RunningStats means, variances;
        Sampler sampler(SamplerType::independent, 1, 16);
        for (uint32_t f = 0; f < 4000; f++) {
            Film film(2, 2);
            for (uint32_t pixel = 0; pixel < 4; pixel++) {
                for (uint32_t s = 0; s < 16; s++) {
                    sampler.start(4 * f + pixel, s);
                    film.add(pixel, s, grey(sampler.u1() * static_cast<float>(pixel + 1)));
                }
            }
            film.spp = 16;
            means.add(film.mean());
            variances.add(film.standard_error() * film.standard_error());
        }
        // Uniform in [0, k): variance k^2 / 12. Over pixels: (1 + 4 + 9 + 16) / 12 / 16 / 4^2.
        double variance = 30.0 / 12 / 16 / 16;
        double z = (variances.mean() - variance) / variances.standard_error();
        CHECK(std::abs(z) < 5);
        CHECK(variances.standard_error() < 0.01 * variance);
        // Of 4000 nearly normal numbers, the variance has a relative standard error of sqrt(2/N).
        CHECK(std::abs(means.variance() / variance - 1) < 5 * std::sqrt(2.0 / 4000));
    }

    TEST_CASE("truth: sample number 2^24 + 1 still counts, and a large mean keeps its variance") {
        Film film(1, 1);
        float sum = 0;
        uint64_t n = (1 << 24) + 1000;
        for (uint64_t s = 0; s < n; s++) {
            film.add(0, s, grey(s % 2 == 0 ? 1000.5f : 1001.5f));
            sum += 1;
        }
        film.spp = n;
        CHECK(film.image().at(0, 0) == grey(1001));
        double se = 0.5 / std::sqrt(static_cast<double>(n - 1));
        CHECK(film.standard_error() == doctest::Approx(se).epsilon(1e-9).scale(0));
        CHECK(sum == 1 << 24);  // what a sum in float does
    }

    TEST_CASE("truth: parts of samples add up, however rare they are") {
        Film film(2, 1);
        film.add_part(0, grey(5));  // of one sample, in two parts
        film.add_part(0, grey(1));
        film.spp = 10;
        CHECK(film.mean() == about(0.3));
        CHECK(film.image().at(0, 0).r == 0.6f);
        CHECK(film.image().at(1, 0).r == 0);
    }

    TEST_CASE("failure: a sample that is not finite shows in its pixel and in the mean") {
        Film film = film_of({{1, std::nanf("")}, {2, 2}});
        CHECK(std::isnan(film.image().at(0, 0).r));
        CHECK(film.image().at(1, 0) == grey(2));
        CHECK(std::isnan(film.mean()));
        CHECK(std::isnan(film.standard_error()));
    }
}
