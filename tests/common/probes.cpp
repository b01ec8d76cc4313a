// The small scenes of make check, and what is off in them.
#include "tests/check/probes.h"

#include <doctest/doctest.h>

#include <set>

#include "common/base/files.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/check/findings.h"

namespace {

Quantities all_right() {
    Quantities q;
    for (const Probe& probe : all_probes())
        for (const char* name : {"LE", "LDE", "LSDE", "all"}) q[probe.name][name] = {1, 0.001};
    return q;
}

}  // namespace

TEST_SUITE("probes") {
    TEST_CASE("identity: within their errors, ratios are not off") {
        Quantities measured = all_right();
        measured["floor"]["LDE"] = {1.03, 0.007};
        CHECK_FALSE(Findings(measured, all_right()).off("floor"));
        measured["floor"]["LDE"] = {1.04, 0.007};
        CHECK(Findings(measured, all_right()).off("floor"));
        measured["floor"]["LDE"] = {1.005, 0.0001};  // surely off, and not to be seen
        CHECK_FALSE(Findings(measured, all_right()).off("floor"));
        measured["floor"]["LDE"] = {NAN, 0.001};
        CHECK(Findings(measured, all_right()).off("floor"));
        CHECK(std::isnan(Findings(measured, all_right()).ratio("floor", "LSSE").mean));
    }

    TEST_CASE("identity: every probe is a scene of its own name, and has references") {
        std::string references = read_file("tests/check/references.tsv");
        std::set<std::string> names;
        for (const Probe& probe : all_probes()) {
            CAPTURE(probe.name);
            CHECK(names.insert(probe.name).second);
            Scene scene = parse_scene("probe.pbrt", probe.text, nullptr);
            prepare(scene, 1);
            CHECK(scene.width == 16);
            CHECK(references.find("\n" + probe.name + "\tall\t") != std::string::npos);
        }
    }
}
