// The known scenes, and how their light is compared.
#include <set>

#include "tests/check/findings.h"
#include "tests/support/scenes.h"

TEST_SUITE("known scenes") {
    TEST_CASE("identity: every known scene has its own name, light, and a source of it") {
        std::set<std::string> names;
        for (const KnownScene& known : known_scenes()) {
            CAPTURE(known.name);
            CHECK(names.insert(known.name).second);
            CHECK(scene_of(known.text).height == 16);
            CHECK(known.source != "");
            double sum = 0;
            for (const auto& [name, q] : known.light) sum += is_class(name) ? q.mean : 0;
            double all = known.light.at("all").mean;
            CHECK((sum == 0 || std::abs(sum - all) < 3e-3 * all));
        }
    }

    TEST_CASE("truth: what is off by 5 standard errors and so much that it is seen is off") {
        const Quantity right = {1, 0.001};
        CHECK_FALSE(is_off({1.03, 0.007}, right));
        CHECK(is_off({1.04, 0.007}, right));
        CHECK_FALSE(is_off({1.005, 0.0001}, right));  // surely off, and not to be seen
        CHECK(is_off({NAN, 0.001}, right));
        CHECK_FALSE(is_off({0.001, 0}, {}));
        CHECK(is_off({0.003, 0}, {}));  // light where there should be none
        CHECK(name_factor(0.318) == "1/pi");
        CHECK(name_factor(0.159) == "1/(2 pi)");
        CHECK(name_factor(1.2) == "");
    }
}
