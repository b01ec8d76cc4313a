// The film's sums against closed forms.
#include "common/picture/film.h"

#include <doctest/doctest.h>

#include <limits>

#include "common/recording/recorder.h"
#include "tests/support/gates.h"

namespace {

/// A film of one row whose pixel x gets the samples rows[x].
Film film_of(const std::vector<std::vector<float>>& rows) {
    Film film(static_cast<int>(rows.size()), 1);
    for (size_t x = 0; x < rows.size(); x++) {
        for (float sample : rows[x]) film.add(x, grey(sample));
    }
    return film;
}

/// A film of 5 x 3 with two samples of 0.25 in each pixel, and these splats, shared out among as
/// many films that are added.
Film film_with(const Splats& splats, size_t parts) {
    Film whole(5, 3, true);
    for (size_t i = 0; i < 15; i++) whole.add(i, grey(0.25f)), whole.add(i, grey(0.25f));
    for (size_t part = 0; part < parts; part++) {
        Film film(5, 3, true);
        for (size_t i = part; i < splats.size(); i += parts) {
            film.splat(splats[i].pixel, splats[i].L);
        }
        whole.add(film);
    }
    return whole;
}

}  // namespace

TEST_SUITE("film") {
    TEST_CASE("truth: pixels with different numbers of samples have each the mean of their own") {
        Film film = film_of({{0, 1, 2}, {4, 6}});
        CHECK(film.samples() == 5);
        CHECK(film.spp() == 2.5);
        CHECK(film.image().at(0, 0) == grey(1));
        CHECK(film.image().at(1, 0) == grey(5));
        CHECK(film.mean() == nearly(3, 1e-14));
        // Variances 1 and 2 of one sample, 1/3 and 2/2 of the pixel.
        CHECK(film.standard_error() == nearly(std::sqrt(1.0 / 3 + 1) / 2, 1e-14));
        CHECK(film.error().samples == nearly(13.0 * 13.0 / 57, 1e-14));
        CHECK(std::isnan(film_of({{0, 1, 2}, {4}}).standard_error()));
        CHECK(film_of({{0, 1, 2}, {4, 4, 4}}).error().samples == nearly(15.0 * 15.0 / 53, 1e-14));
        CHECK(film_of({{0, 0}, {0, 0}}).error().samples == 0);
        // One without samples is black, and not in the mean of the others.
        film = film_of({{}, {4, 6}});
        CHECK(film.image().at(0, 0) == grey(0));
        CHECK(film.mean() == nearly(5, 1e-14));
        CHECK(film.standard_error() == nearly(1, 1e-14));
        CHECK(Film(3, 2).mean() == 0);
        CHECK(std::isnan(Film(3, 2).standard_error()));
    }

    TEST_CASE(
        "truth: a pixel with samples in one half alone has their mean, and an unknown error") {
        for (int half : {0, 1}) {
            Film film(2, 1);
            film.start_halves();
            CHECK(film.empty_pixels() == 2);
            for (float x : {1.0f, 3.0f}) film.add(0, grey(x), half);
            CHECK(film.empty_pixels() == 1);
            CHECK(film.mean() == 2);
            CHECK(film.image().at(0, 0) == grey(2));
            CHECK(film.image().at(1, 0) == grey(0));
            CHECK(std::isnan(film.standard_error()));
            film.add(0, grey(6), 1 - half);
            CHECK(film.mean() == 4);
            CHECK(film.standard_error() == nearly(2, 1e-14));
        }
    }

    TEST_CASE("truth: sample number 2^24 + 1 still counts, and a large mean keeps its variance") {
        Film film(1, 1);
        uint64_t n = (1 << 24) + 1000;
        for (uint64_t s = 0; s < n; s++) film.add(0, grey(s % 2 == 0 ? 1000.5f : 1001.5f));
        CHECK(film.image().at(0, 0) == grey(1001));
        double se = 0.5 / std::sqrt(static_cast<double>(n - 1));
        CHECK(film.standard_error() == nearly(se, 1e-9));
    }

    TEST_CASE("truth: parts of samples add up, however rare they are") {
        Film whole = film_of({std::vector<float>(10, 1), std::vector<float>(10, 1)}), film(2, 1);
        film.add_part(0, grey(5));  // of one sample, in two parts
        film.add_part(0, grey(1));
        film.count_as(whole);
        CHECK(film.mean() == nearly(0.3, 1e-14));
        CHECK(film.image().at(0, 0).r == 0.6f);
        CHECK(film.image().at(1, 0).r == 0);
    }

    TEST_CASE("truth: the error of a film with splats is that of the totals of its samples") {
        // Each sample brings 0.25 to its own pixel; one of each pixel 0.75 more to some other.
        Film film = film_with({}, 1);
        for (size_t i = 0; i < 15; i++) {
            film.add_total(i, grey(0.25f)), film.add_total(i, grey(1));
            film.splat(i * 7 % 15, grey(0.75f));
        }
        CHECK(film.mean() == nearly(0.625, 1e-14));
        CHECK(film.standard_error() == nearly(0.375 / std::sqrt(15.0), 1e-14));
        CHECK(film.error().samples == nearly(15 * 1.25 * 1.25 / 1.0625, 1e-14));
    }

    TEST_CASE("failure: a sample or splat that is not finite shows in its pixel and in the mean") {
        for (float bad : {std::nanf(""), infinity, -infinity}) {
            Film splatted = film_with({{0, {1, bad, 1}}, {0, grey(1)}, {1, grey(1)}}, 2);
            CHECK(splatted.image().at(0, 0).r == 1.25f);
            CHECK(std::isnan(splatted.image().at(0, 0).g));
            CHECK(splatted.image().at(1, 0) == grey(0.75f));
            CHECK(std::isnan(splatted.mean()));
        }
        Film film = film_of({{1, std::nanf("")}, {2, 2}});
        CHECK(std::isnan(film.image().at(0, 0).r));
        CHECK(film.image().at(1, 0) == grey(2));
        CHECK(std::isnan(film.mean()));
        CHECK(std::isnan(film.standard_error()));
    }
}
