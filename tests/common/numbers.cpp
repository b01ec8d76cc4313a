// Numbers from text: the nearest double, with every library.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "common/base/text.h"

TEST_SUITE("numbers") {
    TEST_CASE("truth: numbers are rounded to the nearest double, halves to the even one") {
        CHECK(to_number("0.1") == 0x1.999999999999ap-4);
        CHECK(to_number("1e23") == 0x1.52d02c7e14af6p+76);
        CHECK(to_number("9007199254740993") == 9007199254740992.0);  // halfway
        CHECK(to_number("9007199254740993.00000000000000000000000000001") == 9007199254740994.0);
        CHECK(to_number("9007199254740995") == 9007199254740996.0);
        CHECK(to_number("2.2250738585072011e-308") == 0x0.fffffffffffffp-1022);
        CHECK(to_number("4.9406564584124654e-324") == std::numeric_limits<double>::denorm_min());
        CHECK(to_number("1.7976931348623157e308") == std::numeric_limits<double>::max());
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
