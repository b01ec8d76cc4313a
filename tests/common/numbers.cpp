// Numbers from text: the nearest double, with every library.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/stats.h"
#include "common/base/text.h"
#include "tests/support/gates.h"

TEST_SUITE("numbers") {
    TEST_CASE("truth: numbers are rounded to the nearest double, halves to the even one") {
        CHECK(to_number("0.1") == 0x1.999999999999ap-4);
        CHECK(to_number("9007199254740993") == 9007199254740992.0);  // halfway
        CHECK(to_number("9007199254740993.00000000000000000000000000001") == 9007199254740994.0);
        CHECK(to_number("2.2250738585072011e-308") == 0x0.fffffffffffffp-1022);
        CHECK(to_number("4.9406564584124654e-324") == std::numeric_limits<double>::denorm_min());
    }

    TEST_CASE("input: what is a number, and what is none") {
        CHECK(to_number("+1.5e+2") == 150);
        CHECK(to_number("-.5") == -0.5);
        CHECK(to_number("5.") == 5);
        CHECK(std::signbit(to_number("-0").value()));
        CHECK(to_number("1e999") == std::numeric_limits<double>::infinity());
        CHECK(to_number("1e-999") == 0);
        for (const char* none : {"", "+", "-", ".", "e5", "1e", "1e+", "1,5", "1 ", " 1", "0x10",
                                 "inf", "nan", "1.2.3", "1-2", "+-1", "--1", "1f"})
            CHECK_FALSE(to_number(none));
        CHECK(to_integer("-2147483648") == std::numeric_limits<int>::min());
        CHECK(to_integer("+7") == 7);
        for (const char* none : {"2147483648", "1.0", "1e3", "", "+", "+-1"})
            CHECK_FALSE(to_integer(none));
    }

    TEST_CASE("truth: large shares are written without an exponent") {
        CHECK(percent(0.0123) == "1.23 %");
        CHECK(percent(0.9994) == "99.9 %");
        CHECK(percent(0.9999) == "100 %");
        CHECK(percent(-52.345) == "-5234 %");
    }
}

TEST_SUITE("text") {
    TEST_CASE("truth: characters that a terminal may obey are printed as ?") {
        CHECK(printable("a\x1b[2J\n\x7f\xc2\x85\xc2\xa0") == "a?[2J???\xc2\xa0");
        CHECK(printable("\xf0\x9f\x98\x80\xe2\x82\xac") == "\xf0\x9f\x98\x80\xe2\x82\xac");
        CHECK(printable("gr\xfc\xdf") == "gr??");
        CHECK(printable("\xc2") == "?");
        CHECK(printable("") == "");
    }
}

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
