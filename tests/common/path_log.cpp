// The log of a path: classes in the notation of light paths, and the filter over them.
#include "common/path/path_log.h"

#include <doctest/doctest.h>

#include <regex>

namespace {

/// Light of radiance 1 found after scatterings of these kinds, the one next to the eye first.
Rgb found_after(PathLog& log, const std::string& kinds) {
    log.start();
    for (char kind : kinds) log.scatter({0, 0, 1}, {1, 1, 1}, 1, kind == 'S', {1, 1, 1});
    return log.emitted({1, 1, 1});
}

std::string class_after(const std::string& kinds) {
    PathLog log("");
    found_after(log, kinds);
    return log.contributions().at(0).path_class;
}

}  // namespace

TEST_SUITE("path log") {
    TEST_CASE("truth: a path's class is read from the light to the eye") {
        CHECK(class_after("") == "LE");
        CHECK(class_after("D") == "LDE");
        CHECK(class_after("SD") == "LDSE");    // diffuse surface seen in a mirror
        CHECK(class_after("DSS") == "LSSDE");  // caustic behind a glass ball
    }

    TEST_CASE("truth: a light that is sampled adds one diffuse scattering") {
        PathLog log("");
        log.start();
        log.scatter({0, 0, 1}, {1, 1, 1}, 1, true, {1, 1, 1});
        CHECK(log.direct({1, 2, 3}, {0, 1, 0}, 0.5f, 0.25f, 0.8f) == Rgb{1, 2, 3});
        CHECK(log.contributions().at(0).path_class == "LDSE");
        CHECK(log.contributions().at(0).L == Rgb{1, 2, 3});
    }

    TEST_CASE("truth: after a step back the next branch has the class of its own vertices") {
        PathLog log("");
        log.start();
        log.scatter({0, 0, 1}, {1, 1, 1}, 1, true, {1, 1, 1});
        log.scatter({0, 0, 1}, {1, 1, 1}, 1, false, {1, 1, 1});
        log.step_back();
        log.emitted({1, 1, 1});
        log.step_back();
        log.emitted({1, 1, 1});
        CHECK(log.contributions().at(0).path_class == "LSE");
        CHECK(log.contributions().at(1).path_class == "LE");
    }

    TEST_CASE("truth: each vertex knows the one it was reached from, on a tree of paths too") {
        PathLog log("");
        log.start();
        auto meet = [&](float x) {
            Hit hit{};
            hit.p = {x, 0, 0};
            log.vertex(hit);
        };
        auto go_on = [&] { log.scatter({0, 0, 1}, {1, 1, 1}, 1, true, {1, 1, 1}); };
        // 1 -> 2 -> 3, back to 2 -> nothing, back to 1 -> 4 -> 5
        meet(1), go_on(), meet(2), go_on(), meet(3), log.step_back();
        go_on(), log.step_back(), log.step_back(), go_on(), meet(4), go_on(), meet(5);
        std::vector<int> from;
        for (const PathVertex& x : log.vertices()) from.push_back(x.from);
        CHECK(from == std::vector<int>{-1, 0, 1, 0, 3});
        CHECK(log.vertices()[4].p == Vec3{5, 0, 0});
    }

    TEST_CASE("identity: a log that does not listen returns all and keeps nothing") {
        PathLog log;
        CHECK(found_after(log, "DSDS") == Rgb{1, 1, 1});
        CHECK(log.contributions().empty());
        CHECK(log.steps().empty());
    }

    TEST_CASE("identity: what the filter does not match counts nothing") {
        PathLog log("LD(S|D)*E");
        CHECK(found_after(log, "D") == Rgb{1, 1, 1});
        CHECK(found_after(log, "SSD") == Rgb{1, 1, 1});
        CHECK(found_after(log, "") == Rgb{});
        CHECK(log.contributions().empty());
        CHECK(found_after(log, "DS") == Rgb{});
        PathLog part("DE");  // the whole class must match
        CHECK(found_after(part, "D") == Rgb{});
    }

    TEST_CASE("identity: a path starts anew") {
        PathLog log("");
        found_after(log, "DD");
        found_after(log, "S");
        REQUIRE(log.contributions().size() == 1);
        CHECK(log.contributions()[0].path_class == "LSE");
    }

    TEST_CASE("failure: nested stars and long paths need neither years nor all of the stack") {
        std::string many(20000, 'D');
        for (const char* filter : {"L(D*)*X", "L(D|D)*X", "L(D+)+X", "L(S|D|DD)*X"}) {
            PathLog log(filter);
            CHECK(found_after(log, many) == Rgb{});
        }
        PathLog log("L(D|S)*E");
        CHECK(found_after(log, many) == Rgb{1, 1, 1});
    }

    TEST_CASE("input: what is no regular expression is refused") {
        for (const char* filter : {"(", "[", "L{", "*", "L(D)\\1E"}) {
            CHECK_THROWS_AS(PathLog{filter}, std::regex_error);
        }
        CHECK_THROWS_AS(PathLog{std::string(100000, '(')}, std::regex_error);
        CHECK_THROWS_AS(PathLog{"(D?){1000000000}"}, std::regex_error);
    }
}
