// Text from files as it is printed: on a terminal, in messages, in JSON.
#include "common/base/text.h"

#include <doctest/doctest.h>

#include "common/base/error.h"

namespace {

/// The character of a code point, in UTF-8.
std::string utf8(uint32_t code) {
    auto tail = [&](int shift) { return static_cast<char>(0x80 | (code >> shift & 0x3f)); };
    if (code < 0x80) return {static_cast<char>(code)};
    if (code < 0x800) return {static_cast<char>(0xc0 | code >> 6), tail(0)};
    if (code < 0x10000) return {static_cast<char>(0xe0 | code >> 12), tail(6), tail(0)};
    return {static_cast<char>(0xf0 | code >> 18), tail(12), tail(6), tail(0)};
}

}  // namespace

TEST_SUITE("text") {
    TEST_CASE("truth: of all characters, those that a terminal may obey are printed as ?") {
        size_t wrong = 0;
        for (uint32_t code = 0; code <= 0x10ffff; code++) {
            if (code == 0xd800) code = 0xe000;  // no characters: halves of UTF-16
            bool is_obeyed = code < 0x20 || (code >= 0x7f && code < 0xa0);
            std::string text = utf8(code) + 'b';
            wrong += printable(text) != (is_obeyed ? "?b" : text);
        }
        CHECK(wrong == 0);
        CHECK(printable("gr\xfc\xdf") == "gr??");
        CHECK(printable("\xc2") == "?");
        CHECK(printable("") == "");
    }

    TEST_CASE("truth: what JSON cannot hold is escaped, or printed as ?") {
        CHECK(json_quoted("gr\xfc\xdf \xc3\xbc") == "\"gr?? \xc3\xbc\"");
        CHECK(json_quoted("a\n\"b\\\x1b") == "\"a?\\\"b\\\\?\"");
    }
}
