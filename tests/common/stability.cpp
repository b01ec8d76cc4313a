// What make stability predicts, against closed forms.
#include <doctest/doctest.h>

#include "tests/measure/stability_theory.h"

namespace {

constexpr double pi_exact = std::numbers::pi;

auto is(double x, double relative = 1e-5) { return doctest::Approx(x).epsilon(relative).scale(0); }

/// The density of a point of a disk of radius 1 at height h, drawn by area.
auto by_area(double h) {
    return [=](const Part& p) { return h * h / (p.cos * p.cos * p.cos * pi_exact); };
}
std::vector<Part> disk(double h) { return rings(h / std::sqrt(1 + h * h), 1); }

}  // namespace

TEST_SUITE("stability theory") {
    TEST_CASE("truth: relative variances of a disk overhead and of light at the horizon") {
        CHECK(variance_by(disk(1), by_area(1)) == is(0.1666666666667));
        CHECK(variance_by(disk(0.1), by_area(0.1)) == is(33.00330033));
        CHECK(variance_by(disk(0.1), pdf_cosine) == is(0.01));
        for (double e : {0.1, 0.01}) {
            CHECK(variance_by(rings(0, e), pdf_uniform) == is(4 / (3 * e) - 1));
            CHECK(variance_by(rings(0, e), pdf_cosine) == is(1 / (e * e) - 1));
        }
        CHECK(solid_angle(rings(0, 1)) == is(2 * pi_exact));
    }

    TEST_CASE("truth: relative variances of a disk by area and cosine, power heuristic") {
        CHECK(variance_of_mis(disk(1), by_area(1), pdf_cosine) == is(0.1287833300175));
        CHECK(variance_of_mis(disk(0.5), by_area(0.5), pdf_cosine) == is(0.2237023499149));
        CHECK(variance_of_mis(disk(0.1), by_area(0.1), pdf_cosine) == is(0.09025985025283));
    }

    TEST_CASE("truth: one light of two by power, evenly and half of each: 998, 0.996, 2.98") {
        Choice far{1000.0 / 1001, 1e-3, 1e-3}, near{1 / 1001.0, 1, 1};
        CHECK(relative_moment(chosen(far, near), 2) == is(998.001));
        far.pmf = near.pmf = 0.5;
        CHECK(relative_moment(chosen(far, near), 2) == is(0.996007988016));
        far.pmf = (1000.0 / 1001 + 0.5) / 2, near.pmf = 1 - far.pmf;
        CHECK(relative_moment(chosen(far, near), 2) == is(2.98405317204));
    }

    TEST_CASE("identity: resampling gives the sum of both lights, for every M") {
        for (int M : {1, 2, 8, 16, 100}) {
            CAPTURE(M);
            Choice a{0.7, 2, 0.5}, b{0.3, 1, 3};
            CHECK(mean_of(resampled(a, b, M)) == is(3.5, 1e-12));
            double chances = 0;
            for (const Outcome& o : resampled(a, b, M)) chances += o.chance;
            CHECK(chances == is(1, 1e-12));
        }
        // One candidate: as if it were chosen alone.
        Choice a{0.7, 2, 0.5}, b{0.3, 1, 3};
        CHECK(relative_moment(resampled(a, b, 1), 2) == is(relative_moment(chosen(a, b), 2)));
    }

    TEST_CASE("truth: intervals of rare hits hold the truth as often as there is a hit") {
        CHECK(coverage_of_rare(1e-4, 1000) == is(1 - std::pow(1 - 1e-4, 1000)));
        CHECK(coverage_of_rare(1 - 1e-4, 1000) == is(1 - std::pow(1 - 1e-4, 1000)));
        CHECK(std::abs(coverage_of_rare(0.5, 1000) - 0.95) < 0.01);
    }

    TEST_CASE(
        "truth: walks inside a sphere of albedo 0.5: 1/8 with uniform directions, 0 without") {
        WalkInside uniform{{0.5, 0.5, 0.5}, true, false, false};
        WalkInside cosine{{0.5, 0.5, 0.5}, false, false, false};
        CHECK(uniform.relative_variance(400000) == is(0.125, 0.03));
        CHECK(cosine.runs_of(10, 1)[0].mean == is(2));
        CHECK(cosine.relative_variance(1000) < 1e-9);
    }
}
