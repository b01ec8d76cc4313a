// Text from files as it is printed: on a terminal, in messages, in JSON.
#include <doctest/doctest.h>

#include "common/base/json.h"
#include "common/base/position.h"

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
        // Those of Unicode's categories Cc, Zl and Zp, and those with the property Bidi_Control.
        const std::vector<std::pair<uint32_t, uint32_t>> obeyed = {
            {0, 0x1f},        {0x7f, 0x9f},     {0x61c, 0x61c},  {0x200e, 0x200f},
            {0x2028, 0x2029}, {0x202a, 0x202e}, {0x2066, 0x2069}};
        size_t next = 0, wrong = 0;
        for (uint32_t code = 0; code <= 0x10ffff; code++) {
            if (code == 0xd800) code = 0xe000;  // no characters: halves of UTF-16
            while (next < obeyed.size() && code > obeyed[next].second) next++;
            bool is_obeyed = next < obeyed.size() && code >= obeyed[next].first;
            std::string text = utf8(code) + 'b';
            wrong += printable(text) != (is_obeyed ? "?b" : text);
        }
        CHECK(wrong == 0);
        CHECK(printable("gr\xfc\xdf") == "gr??");
        CHECK(printable("\xc2") == "?");
        CHECK(printable("") == "");
    }

    TEST_CASE("truth: what JSON cannot hold is escaped") {
        CHECK(json_quoted("gr\xfc\xdf \xc3\xbc") == "\"gr\\ufffd\\ufffd \xc3\xbc\"");
        CHECK(json_quoted("a\n\"b\\\x1b") == "\"a\\u000a\\\"b\\\\\\u001b\"");
        for (char c = 1; c < 32; c++) CHECK(json_quoted(std::string(1, c)).starts_with("\"\\u00"));
    }
}
