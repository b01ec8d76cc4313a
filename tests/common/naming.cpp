// The reader's own chapter: what is left out of it, and how a mistake in it is named.
#include "tests/check/naming.h"

#include <doctest/doctest.h>

#include <set>

#include "common/base/files.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/check/probes.h"
#include "tests/support/process.h"

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
std::string named(int chapter, const Change& change, const Change& of_other = {}) {
    Quantities measured = all_right(), other = all_right();
    for (auto [probe, name, times] : change) measured[probe][name].mean = times;
    for (auto [probe, name, times] : of_other) other[probe][name].mean = times;
    Findings found(measured, all_right()), second(other, all_right());
    std::vector<Name> names = name_mistake(chapter, found, &second);
    return names.empty() ? "" : names[0].text;
}
bool says(const std::string& text, const std::string& words) {
    CAPTURE(text);
    return text.find(words) != std::string::npos;
}

/// Writes the exercise of a chapter, and returns what the script printed.
std::string exercise(const std::string& number, const TemporaryFolder& folder) {
    std::string command = "common/tools/exercise " + number + " " + folder.path() + " 2>&1";
    return Process([&] { return std::system(command.c_str()) == 0 ? 0 : 1; }).wait().out;
}
constexpr double pi_here = 3.14159265358979;

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

    TEST_CASE("truth: ratios and the mistakes that make them") {
        CHECK(named(9, {}) == "");
        double p = pi_here;
        CHECK(says(named(7, {{"floor", "LDE", p}, {"room", "LDE", p}, {"room", "LDDE", p * p}}),
                   "f is not divided by pi"));
        CHECK(says(named(7, {{"floor", "LDE", 1 / p}, {"room", "LDDE", 1 / (p * p)}}),
                   "divided by pi twice"));
        CHECK(says(named(9, {{"floor", "LDE", 2},
                             {"slant", "LDE", 2},
                             {"far", "LDE", 2},
                             {"turned", "LDE", 2}}),
                   "counted again when the path meets it by chance"));
        CHECK(says(named(9, {{"three", "LDE", 1.0 / 3}}), "1/N"));
        CHECK(says(named(9, {{"half", "LDE", 2}}), "nothing casts a shadow"));
        CHECK(says(named(9, {{"slant", "LDE", 2}, {"floor", "LDE", 1.03}}),
                   "cosine there is missing"));
        CHECK(says(named(9, {{"slant", "LDE", 0.5}, {"floor", "LDE", 0.97}}), "squared"));
        CHECK(says(named(9, {}, {{"turned", "LDE", 2}}), "cosine at the light is missing"));
        CHECK(says(named(10, {{"sphere", "LDDE", 4.0 / 3}}), "uniform density"));
        CHECK(says(named(8, {{"sphere", "LDDDDDE", 0.1}, {"corridor", "LSSSSSSE", 0.3}}), "1/q"));
        CHECK(says(named(8, {{"corridor", "LSSSSSSE", 0.3}}), "mirrors and glass"));
        CHECK(says(named(9, {{"gap", "LDE", 0.1}}), "shadow rays end too early"));
    }

    TEST_CASE("truth: what no mistake in the list explains is told by its factor") {
        CHECK(name_factor(0.318) == "1/pi");
        CHECK(name_factor(2.02) == "2");
        CHECK(name_factor(0.212) == "2/(3 pi)");
        CHECK(name_factor(12.6) == "4 pi");
        CHECK(name_factor(1.1) == "");
        CHECK(name_factor(0) == "");
        CHECK(says(named(10, {{"bulb", "LSDE", 3}}), "a factor 3"));
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

TEST_SUITE("exercises") {
    TEST_CASE("identity: an exercise keeps signatures, docstrings and headlines, and no more") {
        TemporaryFolder folder;
        CHECK(says(exercise("09", folder), "sample_area_light, sample_one_light, sample_light, "));
        std::string text = read_file(folder / "09_light_sampling/estimator.h");
        CHECK(says(text, "///   by area:  pdf_w = pdf_A d^2 / cos_y"));
        CHECK(says(text, "inline LightSample sample_light(const Scene& scene, const Hit& x,"));
        CHECK(says(text, "    // Sample a light.\n"));
        CHECK(says(text, "    // Yours. As it was: chapters/08_russian_roulette/estimator.h\n"));
        CHECK(says(text, "    return x.material->reflectance / pi;"));  // as in chapter 08
        CHECK_FALSE(says(text, "y.pdf_w /= static_cast<float>(N);"));
        CHECK_FALSE(says(text, "direct_light(scene, *x"));
    }

    TEST_CASE("identity: every chapter has an exercise, and a reader's file is never touched") {
        TemporaryFolder folder;
        for (const auto& entry : std::filesystem::directory_iterator("chapters")) {
            std::string topic = entry.path().filename().string();
            if (!entry.is_directory()) continue;
            CAPTURE(topic);
            std::string number = topic.substr(0, 2), mine = folder / (topic + "/estimator.h");
            CHECK(says(exercise(number, folder), "wrote " + mine));
            std::string whole = read_file("chapters/" + topic + "/estimator.h");
            CHECK(says(read_file(mine), "// Yours."));
            CHECK(read_file(mine).size() < whole.size());
            write_file_atomically(mine, "mine");
            CHECK(says(exercise(number, folder), "stays as it is"));
            CHECK(read_file(mine) == "mine");
        }
        CHECK(says(exercise("99", folder), "usage: make exercise CH=09"));
    }
}
