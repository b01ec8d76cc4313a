// Command lines: what the programs understand, and what they say when they do not.
#include "common/render/options.h"

#include <doctest/doctest.h>

#include "tests/support/folder.h"
#include "tests/support/stand_ins.h"

TEST_SUITE("options") {
    TEST_CASE("input: all options, before the scene and after it, with a blank or =") {
        RenderOptions o =
            parsed({"--spp",   "7",          "--time=2.5",  "a.pbrt",      "--size", "640x480",
                    "--seed",  "4294967295", "--threads=3", "--max-depth", "0",      "--sampler",
                    "sobol",   "--out",      "a.ppm",       "--out",       "b.png",  "--stats",
                    "s=.json", "--paths",    "LDS*E",       "--split",     "d",      "--quiet"});
        CHECK(o.scene == "a.pbrt");
        CHECK(o.spp == 7);
        CHECK(o.time == 2.5);
        CHECK(o.width == 640);
        CHECK(o.height == 480);
        CHECK(o.seed == 4294967295u);
        CHECK(o.threads == 3);
        CHECK(o.max_depth == 0);
        CHECK(o.sampler == SamplerType::sobol);
        CHECK(o.out == std::vector<std::string>{"a.ppm", "b.png"});
        CHECK(o.stats == "s=.json");
        CHECK(o.paths == "LDS*E");
        CHECK(o.split == "d");
        CHECK(o.quiet);
        o = parsed({"--explain", "3,4", "--spp", "2", "--spp", "3", "a.pbrt"});
        CHECK(o.explain == SampleAt{0, 4, 3, 0});
        CHECK(o.spp == 3);  // the last of two counts
        CHECK(o.scene == "a.pbrt");
        CHECK(parsed({"--explain=3,4,17"}).explain->number == 17);
        CHECK(parsed({"--threads", "1024"}).threads == 1024);
        CHECK(parsed({"--size", "16384x16384"}).width == 16384);  // 2^28 pixels
        // A chapter's own options are kept, but for those without a value.
        auto ignore = [](const std::string&) {};
        o = parsed({"--m", "4", "--film", "a.film", "--part", "3/3", "--film-every", "0.5"},
                   {{"way", "KIND", "a way", ignore, "short"},
                    {"other", "KIND", "no value", ignore},
                    {"m", "N", "m", ignore, "3"}});
        CHECK(o.own ==
              std::vector<std::pair<std::string, std::string>>{{"way", "short"}, {"m", "4"}});
        CHECK(o.part == 3);
        CHECK(o.film_every == 0.5);
        // The command can be typed again.
        CHECK(parsed({"it's", "--paths", "LD(S|D)*E"}).command ==
              "build/07_x 'it'\\''s' --paths 'LD(S|D)*E'");
    }
}
