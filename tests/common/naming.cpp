// The reader's own chapter: what is left out of it, and how a mistake in it is named.
#include "tests/check/naming.h"

#include <doctest/doctest.h>

#include <set>

#include "common/base/files.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/check/probes.h"

namespace {

/// All classes that a probe may have, each as bright as the other.
Quantities all_right() {
    Quantities q;
    for (const Probe& probe : all_probes())
        for (const char* name : {"LE", "LDE", "LDDE", "LDDDE", "LDDDDDE", "LSE", "LSDE", "LSSSSSSE",
                                 "all", "parts", "noise", "rays", "samples"})
            q[probe.name][name] = {1, 0.001};
    for (const char* dark : {"gap", "box", "below", "below metal"}) q[dark].clear();
    return q;
}

using Change = std::vector<std::tuple<const char*, const char*, double>>;

/// What is said when these quantities are so many times what they should be.
std::string named(const char* chapter, const Change& change, const Change& of_other = {}) {
    static const std::string known =
        "# chapter, number, routine, what it is, what is not as it should be\n"
        "09\t1\tsample_light\tthe division by N is missing\tthree/LDE=0.333~0.002\n"
        "09\t2\tdirect_light\tnothing casts a shadow\thalf/LDE=2~0.01\n"
        "09\t3\ttrace\temission counts twice\tfloor/LDE=2~0.01;three/LDE=0.336~0.003\n"
        "09\t4\tsample_area\tthe cosine is missing\t2:turned/LDE=2~0.01\n"
        "09\t5\tspawn_ray\tthe ray starts too early\tbox/LDDE dark=0.1~0.01\n"
        "11\t1\tpick_light\ta light is left out\tthree/LDE=0.333~0.002;floor/noise=4~0.1\n"
        "11\t2\tother_routine\tsomething else\tthree/LDE=0.333~0.002\n"
        "13\t1\tpick_light\ta light is never chosen\tthree/LDE=0.333~0.002\n"
        "14\t1\tpick_light\tthe first light is never chosen\tthree/LDE=0.333~0.002\n"
        "14\t2\tlight_pmf\tthe powers are squared\tthree/LDE=0.333~0.002;near/LDE=1.02~0.002\n"
        "18\t1\ttrace\ta change without effect\tfloor/LDE=1.009~0.003\n"
        "20\t1\ta\tA\tthree/LDE=0.333~0.002\n20\t2\tb\tB\tthree/LDE=0.333~0.002\n"
        "20\t3\tc\tC\tthree/LDE=0.333~0.002\n";
    const std::string code = "inline Light pick_light(double u) {";
    Quantities measured = all_right(), other = all_right();
    for (auto [probe, name, times] : change) measured[probe][name] = {times, 0.001};
    for (auto [probe, name, times] : of_other) other[probe][name].mean = times;
    Findings found(measured, all_right()), second(other, all_right());
    return name_mistake(read_hypotheses(known, chapter, code), found, &second);
}
bool says(const std::string& text, const std::string& words) {
    CAPTURE(text);
    return text.find(words) != std::string::npos;
}

}  // namespace

TEST_SUITE("naming") {
    TEST_CASE("identity: black is what brings nothing anywhere") {
        Quantities dark = all_right();
        for (auto& [probe, row] : dark)
            for (auto& [name, q] : row)
                if (is_class(name)) q.mean = 0;
        CHECK(Findings(dark, all_right()).black());
        dark["floor"]["LDE"].mean = 1e-9;
        CHECK(!Findings(dark, all_right()).black());
        CHECK(Findings({}, all_right()).black());
    }

    TEST_CASE("truth: a mistake is named only if it explains all that was measured") {
        CHECK(named("09", {}) == "");
        Change third = {{"three", "LDE", 1.0 / 3}};
        CHECK(says(named("09", third),
                   "It looks like this mistake: in `sample_light`, the division by N"));
        CHECK(
            says(named("09", {{"half", "LDE", 2}}), "in `direct_light`, nothing casts a shadow."));
        CHECK(says(named("09", {}, {{"turned", "LDE", 2}}), "in `sample_area`, the cosine"));
        CHECK(
            says(named("09", {{"box", "LDDE", 0.1}}), "in `spawn_ray`, the ray starts too early"));
        // Of what is known in another chapter nothing is said here.
        CHECK(says(named("13", third), "in `pick_light`, a light is never chosen."));
        // But of chapters that find light alike, in routines that this one has; noise is its own.
        CHECK(says(named("12", third), "in `pick_light`, a light is left out."));
        CHECK(says(named("19", third), "No mistake that the check knows explains all numbers."));
        // One number more that is off, and the first mistake does not explain all.
        Change more = {{"three", "LDE", 1.0 / 3}, {"floor", "LDE", 0.9}};
        CHECK(says(named("09", more), "No mistake that the check knows explains all numbers."));
        more = {{"three", "LDE", 1.0 / 3}, {"floor", "LDE", 2}};
        CHECK(says(named("09", more), "in `trace`, emission counts twice."));
    }

    TEST_CASE("truth: what explains no more than a right program does is not named") {
        std::string text = named("18", {{"floor", "LDE", 0.992}});
        CHECK(says(text, "No mistake that the check knows explains all numbers."));
        CHECK(!says(text, "without effect"));
    }

    TEST_CASE("truth: of two mistakes that explain all, both are named, and what would decide") {
        std::string both = named("14", {{"three", "LDE", 1.0 / 3}});
        CHECK(says(both, "Two mistakes explain all numbers that were measured"));
        CHECK(says(both, "in `pick_light`, the first light is never chosen; or"));
        CHECK(says(both, "in `light_pmf`, the powers are squared."));
        Change clear = {{"three", "LDE", 1.0 / 3}, {"near", "LDE", 1.2}};
        CHECK(says(named("14", clear), "No mistake that the check knows"));
        CHECK(says(named("20", {{"three", "LDE", 1.0 / 3}}), "Many mistakes explain all numbers"));
    }

    TEST_CASE("truth: of what no mistake explains, it is said what is common to all that is off") {
        CHECK(name_factor(0.318) == "1/pi");
        CHECK(name_factor(2.02) == "2");
        CHECK(name_factor(0.212) == "2/(3 pi)");
        CHECK(name_factor(12.6) == "4 pi");
        CHECK(name_factor(1.1) == "");
        CHECK(name_factor(0) == "");
        std::string text = named("10", {{"bulb", "LSDE", 3}});
        CHECK(says(text, "All of these are paths that pass a mirror or glass"));
        CHECK(says(text, "LSDE in a lamp in a ball of glass is 3 (3) of what it should be."));
        Change lobes = {{"metal", "LDE", 0.7}, {"metal at an angle", "LDE", 0.7}};
        CHECK(says(named("10", lobes), "in scenes with rough metal"));
    }

    TEST_CASE("identity: what is written of a mistake is what is read") {
        Quantities measured = all_right();
        measured["three"]["LDE"] = {0.25, 0.002}, measured["box"]["LDDE"] = {0.125, 0.01};
        Evidence evidence = evidence_of(Findings(measured, all_right()), nullptr);
        std::string text = prediction_text(evidence);
        CHECK(text == "box/LDDE dark=0.125~0.01;three/LDE=0.25~0.002");
        std::vector<Hypothesis> read = read_hypotheses("09\t1\ta\tb\t" + text + "\n", "09", "");
        REQUIRE(read.size() == 1);
        CHECK(read[0].predicted.at("three/LDE").mean == 0.25);
        CHECK(read[0].predicted.at("box/LDDE dark").se == 0.01);
        CHECK(explanations(read, evidence).size() == 1);
    }

    TEST_CASE("identity: every known mistake has a routine, words and numbers") {
        std::string text = read_file("tests/check/hypotheses.tsv");
        size_t all = 0;
        for (int chapter = 7; chapter <= 24; chapter++) {
            std::string number = (chapter < 10 ? "0" : "") + std::to_string(chapter);
            for (const Hypothesis& h : read_hypotheses(text, number, "")) {
                CHECK(!h.routine.empty());
                CHECK(!h.text.empty());
                CHECK(!h.predicted.empty());
                all++;
            }
        }
        CHECK(all > 200);
    }

    TEST_CASE("identity: within their errors, ratios are not off") {
        Quantities measured = all_right();
        measured["floor"]["LDE"] = {1.03, 0.007};
        CHECK(Findings(measured, all_right()).right("floor"));
        measured["floor"]["LDE"] = {1.04, 0.007};
        CHECK(Findings(measured, all_right()).off("floor"));
        measured["floor"]["LDE"] = {1.005, 0.0001};  // surely off, and not to be seen
        CHECK(Findings(measured, all_right()).right("floor"));
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
            CHECK(references.find("\n" + probe.name + "\tsamples\t") != std::string::npos);
        }
    }
}
