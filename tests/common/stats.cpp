// The running statistics of common/base/stats.h.
#include "common/base/stats.h"

#include <doctest/doctest.h>

#include <limits>
#include <utility>
#include <vector>

#include "tests/support/gates.h"

namespace {

RunningStats stats_of(const std::vector<double>& samples) {
    RunningStats s;
    for (double x : samples) s.add(x);
    return s;
}

}  // namespace

TEST_SUITE("stats") {
    TEST_CASE("identity: mean and variance of none, one and four numbers") {
        RunningStats four = stats_of({2, 4, 4, 6});
        CHECK(four.mean() == 4);
        CHECK(four.variance() == nearly(8.0 / 3, 1e-15));
        CHECK(four.standard_error() == nearly(std::sqrt(2.0 / 3), 1e-15));
        for (const std::vector<double>& few : {std::vector<double>{}, {7}}) {
            RunningStats s = stats_of(few);
            CHECK(s.count() == few.size());
            CHECK(s.mean() == (few.empty() ? 0 : 7));
            CHECK(s.variance() == 0);
            CHECK(s.standard_error() == 0);
        }
    }

    TEST_CASE("identity: merged halves equal the whole, wherever it is cut") {
        std::vector<double> x;
        for (int i = 0; i < 101; i++) x.push_back(std::sin(i * i) * 1e3 + 1e6);
        RunningStats whole = stats_of(x);
        for (size_t cut : {size_t{0}, size_t{1}, size_t{50}, size_t{100}, size_t{101}}) {
            auto middle = x.begin() + static_cast<std::ptrdiff_t>(cut);
            RunningStats a = stats_of({x.begin(), middle});
            a.merge(stats_of({middle, x.end()}));
            CHECK(a.count() == whole.count());
            CHECK(a.mean() == nearly(whole.mean(), 1e-14));
            CHECK(a.variance() == nearly(whole.variance(), 1e-10));
        }
    }

    TEST_CASE("truth: Welford keeps the digits that E[x^2] - E[x]^2 loses") {
        // base, base + 1, base ...: s^2 = (n/4) / (n-1)
        for (double base : {0.0, 1e3, 1e9}) {
            CAPTURE(base);
            RunningStats s;
            for (int i = 0; i < 1000000; i++) s.add(base + i % 2);
            CHECK(s.mean() == nearly(base + 0.5, 1e-15));
            CHECK(std::abs(s.variance() - 0.25 * 1e6 / (1e6 - 1)) < 1e-6);
        }
    }
}
