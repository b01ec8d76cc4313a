// The recorder of a path: classes in the notation of light paths, and the filter over them.
#include "common/recording/recorder.h"

#include <doctest/doctest.h>

#include <functional>

#include "common/path/sampler.h"
#include "common/recording/class_filter.h"
#include "common/recording/path_story.h"
#include "tests/support/folder.h"

namespace {

using Words = std::vector<std::string>;

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

TEST_SUITE("recorder") {
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

    TEST_CASE("truth: the vertex, weight, way and pixel of a connection of two paths") {
        Material wall;
        Recorder recorder(true);
        recorder.start();
        recorder.start_at_light({});
        auto meet = [&] {
            Hit hit{};
            hit.material = &wall;
            recorder.vertex(hit);
            recorder.scatter({0, 0, 1}, {1, 1, 1}, 1, false, {1, 1, 1});
        };
        meet();
        recorder.start_at_eye();
        meet(), meet();
        for (auto [s, t, vertex] : {std::tuple{2, 1, 2}, {1, 3, 4}}) {
            size_t pixel = t == 1 ? 17 : Contribution::own_pixel;
            recorder.connected({1, 2, 3}, s, t, 0.5f, pixel);
            const Contribution& last = recorder.contributions().back();
            CHECK(last.vertex == vertex);  // from 1, those of the light's path first
            CHECK(last.mis == 0.5f);
            CHECK(last.way == "s " + std::to_string(s) + ", t " + std::to_string(t));
            CHECK(last.pixel == pixel);
        }
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
            {"L\xc3\xa4", "2"}, {std::string(100000, '('), "1001"}};
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
