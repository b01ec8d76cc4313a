// Command lines: what the programs understand, and what they say when they do not.
#include "common/render/options.h"

#include <doctest/doctest.h>

#include "tests/support/folder.h"
#include "tests/support/stand_ins.h"

namespace {

TableOptions table_options_of(std::vector<std::string> words) {
    words.insert(words.begin(), "build/01");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return parse_table_options(static_cast<int>(argv.size()), argv.data(), "01_x", 1000);
}

}  // namespace

TEST_SUITE("options") {
    TEST_CASE("input: without options, the scene decides") {
        RenderOptions o = parsed({});
        CHECK(o.name == "07_x");
        CHECK(o.command == "build/07_x");
        CHECK(o.scene == "scenes/a.pbrt");
        CHECK(o.spp == 0);
        CHECK(o.time == 0);
        CHECK(o.width == 0);
        CHECK(o.max_depth == -1);
        CHECK(o.seed == 0);
        CHECK(o.threads >= 1);
        CHECK(o.sampler == SamplerType::independent);
        CHECK(o.out == std::vector<std::string>{"out/07_x.ppm"});
        CHECK(o.stats.empty());
        CHECK_FALSE(o.explain);
        CHECK_FALSE(o.quiet);
    }

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
            {{"-"}, "unknown option '-'; --help"},
            {{"--spp"}, "option '--spp' needs a value"},
            {{"--spp", "--quiet"}, "option '--spp' needs a value"},
            {{"--out", ""}, "option '--out' needs a value"},
            {{"--paths="}, "option '--paths' needs a value"},
            {{"--quiet=1"}, "option '--quiet' takes no value"},
            {{"--spp", "0"}, "--spp takes a whole number from 1 to 1073741824, not '0'"},
            {{"--spp", "1073741825"}, "--spp takes"},
            {{"--spp", "4.5"}, "--spp takes"},
            {{"--seed", "-1"}, "--seed takes a whole number from 0 to 4294967295, not '-1'"},
            {{"--seed", "4294967296"}, "--seed takes"},
            {{"--threads", "0"}, "--threads takes a whole number from 1 to 1024"},
            {{"--max-depth", "-1"}, "--max-depth takes a whole number from 0 to 1073741824"},
            {{"--time", "0"}, "--time takes a number greater than 0"},
            {{"--time", "inf"}, "--time takes a number greater than 0"},
            {{"--size", "256x"}, "--size takes WIDTHxHEIGHT"},
            {{"--size", "-2x-2"}, "--size takes WIDTHxHEIGHT"},
            {{"--size", "0x4"}, "--size takes sides of 1 to 65536"},
            {{"--size", "4x99999"}, "--size takes sides of 1 to 65536"},
            {{"--size", "65536x65536"}, "--size takes at most 2^28 pixels"},
            {{"--sampler", "sobel"},
             "--sampler takes independent, stratified or sobol (did you "
             "mean 'sobol'?)"},
            {{"--out", "a.jpg"}, "--out takes a .ppm, .pfm or .png file"},
            {{"--explain", "1"}, "--explain takes X,Y or X,Y,SAMPLE"},
            {{"--explain", "1,2,3,4"}, "--explain takes X,Y or X,Y,SAMPLE"},
            {{"--explain", "1,99999999999"}, "--explain takes X,Y or X,Y,SAMPLE"},
            {{"--paths", "LD("}, "--paths \"LD(\", column 3: "},
            {{"--paths", "LDD"}, "--paths \"LDD\": no path is of such a class"},
            {{"a.pbrt", "--spp", "2", "b.pbrt"}, "two scenes: 'a.pbrt' and 'b.pbrt'"},
            {{""}, "the name of the scene is empty"},
        };
        for (const auto& c : cases) {
            CAPTURE(c.error);
            CHECK(error_of([&] { parsed(c.words); }).starts_with("error: " + c.error));
        }
    }

    TEST_CASE("input: the options of the chapters that print a table") {
        TableOptions o = table_options_of({});
        CHECK(o.n == 1000);
        CHECK(o.out == std::vector<std::string>{"out/01_x.ppm", "out/01_x.tsv"});
        o = table_options_of({"--n", "5", "--seed", "6", "--out", "a.tsv", "--quiet"});
        CHECK(o.n == 5);
        CHECK(o.seed == 6);
        CHECK(o.out == std::vector<std::string>{"a.tsv"});
        CHECK(o.quiet);
        for (const auto& [words, error] :
             {std::pair(std::vector<std::string>{"--n", "0"},
                        "--n takes a whole number from 1 to 1099511627776, not '0'"),
              {{"--out", "a.txt"}, "--out takes a .ppm, .pfm, .png or .tsv file, not 'a.txt'"},
              {{"scene.pbrt"}, "'scene.pbrt' is not an option"}})
            CHECK(error_of([&, w = words] {
                      table_options_of(w);
                  }).starts_with("error: " + std::string(error)));
    }
}
