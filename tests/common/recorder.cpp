// The recorder of a path: classes in the notation of light paths, and the filter over them.
#include "common/recording/recorder.h"

#include <doctest/doctest.h>

#include <functional>
#include <regex>

#include "common/path/sampler.h"
#include "common/recording/class_filter.h"
#include "tests/support/folder.h"

namespace {

/// Finds light of radiance 1 after scatterings of these kinds, the one next to the eye first.
void find_after(Recorder& recorder, const std::string& kinds) {
    recorder.start();
    for (char kind : kinds) recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, kind == 'S', {1, 1, 1});
    recorder.emitted({1, 1, 1});
}

using Words = std::vector<std::string>;

/// What may stand between L and E, up to four letters, for an expression to match.
Words matched(const std::string& expression) {
    ClassFilter filter(expression);
    Words words;
    for (int length = 0; length <= 4; length++) {
        for (int bits = 0; bits < 1 << length; bits++) {
            std::string word;
            for (int i = 0; i < length; i++) word += bits >> i & 1 ? 'S' : 'D';
            if (filter.matches("L" + word + "E")) words.push_back(word);
        }
    }
    return words;
}

}  // namespace

TEST_SUITE("recorder") {
    TEST_CASE("truth: a path's class is read from the light to the eye, and a path starts anew") {
        Recorder recorder(true);
        for (auto [kinds, its_class] : {std::pair{"", "LE"},
                                        {"D", "LDE"},
                                        {"SD", "LDSE"},       // diffuse surface seen in a mirror
                                        {"DSS", "LSSDE"}}) {  // caustic behind a glass ball
            find_after(recorder, kinds);
            REQUIRE(recorder.contributions().size() == 1);
            CHECK(recorder.contributions()[0].path_class == its_class);
        }
    }

    TEST_CASE("truth: each vertex knows the one it was reached from, on a tree of paths too") {
        Recorder recorder(true);
        recorder.start();
        auto meet = [&](float x) {
            Hit hit{};
            hit.p = {x, 0, 0};
            recorder.vertex(hit);
        };
        auto go_on = [&] { recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, true, {1, 1, 1}); };
        // 1 -> 2 -> 3, back to 2 -> nothing, back to 1 -> 4 -> 5
        meet(1), go_on(), meet(2), go_on(), meet(3), recorder.step_back();
        go_on(), recorder.step_back(), recorder.step_back(), go_on(), meet(4), go_on(), meet(5);
        std::vector<int> from;
        for (const PathVertex& x : recorder.vertices()) from.push_back(x.from);
        CHECK(from == std::vector<int>{-1, 0, 1, 0, 3});
        CHECK(recorder.vertices()[4].p == Vec3{5, 0, 0});
    }

    TEST_CASE("identity: a recorder that keeps nothing counts the paths that were cut") {
        Recorder recorder;
        find_after(recorder, "DSDS");
        recorder.cut(), recorder.cut();
        CHECK(recorder.contributions().empty());
        CHECK(recorder.paths_cut() == 2);
    }

    TEST_CASE("identity: what is found counts by the throughput that was reported last") {
        Recorder recorder(true);
        recorder.start();
        recorder.emitted({1, 2, 3});
        recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, false, {0.5f, 0.5f, 0.25f});
        recorder.roulette(0.5f, {1, 1, 0.5f});
        recorder.emitted({1, 2, 4}, 0.25f);
        recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, true, {0.25f, 0, 0});
        recorder.direct({4, 4, 4}, {0, 1, 0}, 0.5f, 0.25f, 0.8f);
        recorder.step_back();
        recorder.direct({4, 4, 4}, {0, 1, 0}, 0.5f, 0.25f, 0.8f);
        recorder.emitted({0, 0, 0});
        std::vector<Rgb> L;
        Words classes;
        for (const Contribution& part : recorder.contributions()) {
            L.push_back(part.L);
            classes.push_back(part.path_class);
        }
        CHECK(classes == Words{"LE", "LDE", "LDSDE", "LDDE"});
        CHECK(L == std::vector<Rgb>{{1, 2, 3}, {0.25f, 0.5f, 0.5f}, {1, 0, 0}, {4, 4, 2}});
    }

    TEST_CASE("truth: photons are kept by the class of their path, from the light to the eye") {
        Material metal, wall;
        metal.type = MaterialType::conductor;
        struct Vertex {
            const Material* material;
        };
        struct Paths {
            std::vector<Vertex> path_of(const std::vector<Vertex>& photon) const { return photon; }
        } paths;
        std::vector<Vertex> caustic = {{&metal}, {&wall}, {&wall}}, direct = {{&wall}};
        Recorder recorder(true);
        recorder.start();
        recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, true, {0.5f, 0.5f, 0.5f});
        recorder.photon({1, 0, 0}, 0.25f, paths, caustic);
        recorder.photon({0, 1, 0}, 0.75f, paths, direct);
        recorder.photon({0, 0, 1}, 0.5f, paths, caustic);
        recorder.gathered({4, 4, 4});
        CHECK(recorder.photons() == 3);
        CHECK(recorder.inner_photons() == 1);
        std::map<std::string, Rgb> found;
        for (const Contribution& part : recorder.contributions()) found[part.path_class] = part.L;
        CHECK(found == std::map<std::string, Rgb>{{"LDSE", {0, 2, 0}}, {"LSDDSE", {2, 0, 2}}});
    }
}

TEST_SUITE("class filter") {
    TEST_CASE("identity: a selection has the classes that its filter matches, or all") {
        ClassSelection scattered("LD(S|D)*E"), part("DE"), all("");
        for (int again = 0; again < 2; again++) {  // then it remembers
            CHECK(scattered.contains("LDE"));
            CHECK(scattered.contains("LDSSE"));
            CHECK_FALSE(scattered.contains("LE"));
            CHECK_FALSE(scattered.contains("LSDE"));
            CHECK_FALSE(part.contains("LDE"));  // the whole class must match
            CHECK(all.contains("LSDE"));
        }
    }

    TEST_CASE("failure: nested stars and long paths need neither years nor all of the stack") {
        std::string many(20000, 'D');
        for (const char* filter : {"L(D*)*L", "L(D|D)*L", "L(D+)+L", "L(S|D|DD)*L"}) {
            CHECK_FALSE(ClassSelection(filter).contains("L" + many + "E"));
        }
        CHECK(ClassSelection("L(D|S)*E").contains("L" + many + "E"));
    }

    TEST_CASE("input: what is no class filter is refused, with the column") {
        auto error = [](const std::string& filter) {
            return error_of([&] { ClassFilter read(filter); });
        };
        for (auto [filter, column] : {std::pair{"LD(S|D", "3"},
                                      {"L[DS", "2"},
                                      {"L[]E", "2"},
                                      {"LD)E", "3"},
                                      {"L(*)E", "3"},
                                      {"LD**E", "4"},
                                      {"LXE", "2"},
                                      {"LD{", "3"},
                                      {"LD{}E", "3"},
                                      {"LD{3,2}E", "3"},
                                      {"LD{2,x}E", "3"},
                                      {"LD{10000}E", "4"},
                                      {"(((((((((", "9"}})
            CHECK(error(filter).find(std::string("\", column ") + column + ": ") !=
                  std::string::npos);
        CHECK(error(std::string(100000, '(')).ends_with("column 1001: the expression is too long"));
        for (const char* other : {"L\\1E", "^LE$", "L E", "ld", "L\xc3\xa4"})
            CHECK(error(other) != "");
    }

    TEST_CASE("truth: what each sign of a class filter matches") {
        CHECK(matched("LDSE") == Words{"DS"});
        CHECK(matched("LD.E") == Words{"DD", "DS"});
        CHECK(matched("LD?SE") == Words{"S", "DS"});
        CHECK(matched("LD*SE") == Words{"S", "DS", "DDS", "DDDS"});
        CHECK(matched("LD+SE") == Words{"DS", "DDS", "DDDS"});
        CHECK(matched("L(D|SS)E") == Words{"D", "SS"});
        CHECK(matched("L(DS)+E") == Words{"DS", "DSDS"});
        CHECK(matched("L(|D)E") == Words{"", "D"});
        CHECK(matched("L[DS]SE") == Words{"DS", "SS"});
        CHECK(matched("L[^SE]{2}E") == Words{"DD"});
        CHECK(matched("LD{3}E") == Words{"DDD"});
        CHECK(matched("LD{3,}E") == Words{"DDD", "DDDD"});
        CHECK(matched("LD{0,2}E") == Words{"", "D", "DD"});
        CHECK(matched("LD{0}SE") == Words{"S"});
        CHECK(matched("L(?:D|S){1}E") == Words{"D", "S"});
        CHECK(matched("L(D{2}){2}E") == Words{"DDDD"});
        CHECK(matched(".*SSE|LDE") ==
              Words{"D", "SS", "DSS", "SSS", "DDSS", "SDSS", "DSSS", "SSSS"});
    }

    TEST_CASE("truth: a filter that no class of path matches is known") {
        for (const char* some :
             {"LE", "L.*E", "LD{1000}E", "L(S|D)*E", ".*", "L[^D]*E", "(LE|LL)"}) {
            CHECK(ClassFilter(some).matches_some_path());
        }
        for (const char* none :
             {"", "L", "LD", "DE", "E", "LLE", "LEE", "L(DL)+E", "LD[LE]E", "ELDE"}) {
            CHECK_FALSE(ClassFilter(none).matches_some_path());
        }
    }
}
