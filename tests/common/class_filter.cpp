// The filter over classes of path in the notation of light paths.
#include "common/recording/class_filter.h"

#include <doctest/doctest.h>

#include "tests/support/folder.h"

namespace {

/// What may stand between L and E, up to four letters, for an expression to match.
std::string matched(const std::string& expression) {
    ClassFilter filter(expression);
    std::string words;
    for (int length = 0; length <= 4; length++) {
        for (int bits = 0; bits < 1 << length; bits++) {
            std::string word;
            for (int i = 0; i < length; i++) word += bits >> i & 1 ? 'S' : 'D';
            if (filter.matches("L" + word + "E")) words += word + ' ';
        }
    }
    return words.substr(0, words.size() - 1);
}

}  // namespace

TEST_SUITE("class filter") {
    TEST_CASE("identity: a selection has the classes that its filter matches, or all") {
        ClassFilter scattered("LD(S|D)*E"), part("DE"), all("");
        for (int again = 0; again < 2; again++) {  // then it remembers
            CHECK(scattered.matches("LDE"));
            CHECK(scattered.matches("LDSSE"));
            CHECK_FALSE(scattered.matches("LE"));
            CHECK_FALSE(scattered.matches("LSDE"));
            CHECK_FALSE(part.matches("LDE"));  // the whole class must match
            CHECK(all.matches("LSDE"));
        }
        // Nested stars and long paths need neither years nor all of the stack.
        std::string many(20000, 'D');
        for (const char* filter : {"L(D*)*L", "L(D|D)*L", "L(D+)+L", "L(S|D|DD)*L"})
            CHECK_FALSE(ClassFilter(filter).matches("L" + many + "E"));
        CHECK(ClassFilter("L(D|S)*E").matches("L" + many + "E"));
    }

    TEST_CASE("input: what is no class filter is refused, with the column") {
        const std::pair<std::string, std::string> cases[] = {
            {"LD(S|D", "3"},    {"L[DS]E", "2"},
            {"LD)E", "3"},      {"L(*)E", "3"},
            {"LD**E", "4"},     {"LXE", "2"},
            {"LD{2}E", "3"},    {"(((((((((", "9"},
            {"L\\1E", "2"},     {"^LE$", "1"},
            {"L E", "2"},       {"ld", "1"},
            {"L\xc3\xa4", "2"}, {std::string(100000, '('), "9"}};
        for (const auto& [filter, column] : cases)
            CHECK(error_of([&, text = filter] {
                      ClassFilter read(text);
                  }).find("column " + column + ": ") != std::string::npos);
    }

    TEST_CASE("truth: what each sign of a class filter matches") {
        const std::pair<const char*, const char*> cases[] = {
            {"LDSE", "DS"},
            {"LD.E", "DD DS"},
            {"LD?SE", "S DS"},
            {"LD*SE", "S DS DDS DDDS"},
            {"LD+SE", "DS DDS DDDS"},
            {"L(D|SS)E", "D SS"},
            {"L(DS)+E", "DS DSDS"},
            {"L(|D)E", " D"},
            {"L(D|S)SE", "DS SS"},
            {"L(D+S?)?E", " D DD DS DDD DDS DDDD DDDS"},
            {".*SSE|LDE", "D SS DSS SSS DDSS SDSS DSSS SSSS"},
        };
        for (auto [filter, words] : cases) CHECK(matched(filter) == words);
    }
}
