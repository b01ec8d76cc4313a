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
        o = parsed({"--explain", "3,4", "--spp", "2", "--spp", "3", "--", "--quiet"});
        CHECK(o.explain);
        CHECK(o.explain_x == 3);
        CHECK(o.explain_y == 4);
        CHECK(o.explain_sample == -1);
        CHECK(o.spp == 3);  // the last of two counts
        CHECK(o.scene == "--quiet");
        CHECK(parsed({"--explain=3,4,17"}).explain_sample == 17);
        // The command can be typed again.
        CHECK(parsed({"it's", "--paths", "LD(S|D)*E"}).command ==
              "build/07_x 'it'\\''s' --paths 'LD(S|D)*E'");
    }

    TEST_CASE("input: wrong options and values are named, and what is right") {
        struct {
            std::vector<std::string> words;
            std::string error;
        } cases[] = {
            {{"-spp", "4"}, "unknown option '-spp', did you mean '--spp'?"},
            {{"--max_depth", "4"}, "unknown option '--max_depth', did you mean '--max-depth'?"},
            {{"--SPP", "4"}, "unknown option '--SPP'; --help"},
            {{"--spp"}, "option '--spp' needs a value"},
            {{"--out", ""}, "option '--out' needs a value"},
            {{"--quiet=1"}, "option '--quiet' takes no value"},
            {{"--spp", "0"}, "--spp takes a whole number from 1 to 1073741824, not '0'"},
            {{"--seed", "-1"}, "--seed takes a whole number from 0 to 4294967295, not '-1'"},
            {{"--max-depth", "-1"}, "--max-depth takes a whole number from 0 to 1073741824"},
            {{"--time", "0"}, "--time takes a number greater than 0"},
            {{"--size", "-2x-2"}, "--size takes WIDTHxHEIGHT"},
            {{"--size", "0x4"}, "--size takes WIDTHxHEIGHT"},
            {{"--size", "65537x1"}, "--size takes WIDTHxHEIGHT"},
            {{"--size", "65536x65536"}, "--size takes WIDTHxHEIGHT"},
            {{"--sampler", "sobel"},
             "--sampler takes independent, stratified or sobol (did you "
             "mean 'sobol'?)"},
            {{"--out", "a.jpg"}, "--out takes a .ppm, .pfm or .png file"},
            {{"--explain", "1,2,3,4"}, "--explain takes X,Y or X,Y,SAMPLE"},
            {{"--paths", "LD("}, "--paths \"LD(\", column 3: "},
            {{"a.pbrt", "--spp", "2", "b.pbrt"}, "two scenes: 'a.pbrt' and 'b.pbrt'"},
            {{""}, "the name of the scene is empty"},
        };
        for (const auto& c : cases) {
            CAPTURE(c.error);
            CHECK(error_of([&] { parsed(c.words); }).starts_with("error: " + c.error));
        }
    }
}
