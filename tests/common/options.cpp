// Command lines: what the programs understand, and what they say when they do not.
#include "common/options/options.h"

#include <doctest/doctest.h>

#include "tests/support/folder.h"

namespace {

/// The arguments as main() gets them.
struct Words {
    explicit Words(std::vector<std::string> all) : words(std::move(all)) {
        words.insert(words.begin(), "build/07");
        for (std::string& word : words) pointers.push_back(word.data());
    }
    int count() { return static_cast<int>(pointers.size()); }

    std::vector<std::string> words;
    std::vector<char*> pointers;
};

RenderOptions options_of(std::vector<std::string> words) {
    Words w(std::move(words));
    return parse_render_options(w.count(), w.pointers.data(), "07_x", "scenes/default.pbrt");
}

TableOptions table_options_of(std::vector<std::string> words) {
    Words w(std::move(words));
    return parse_table_options(w.count(), w.pointers.data(), "01_x", 1000);
}

/// The message of the UsageError, and nothing but a UsageError.
std::string usage_error(std::vector<std::string> words) {
    try {
        options_of(std::move(words));
    } catch (const UsageError& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST_SUITE("options") {
    TEST_CASE("input: without options, the scene decides") {
        RenderOptions o = options_of({});
        CHECK(o.name == "07_x");
        CHECK(o.command == "build/07");
        CHECK(o.scene == "scenes/default.pbrt");
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
        RenderOptions o = options_of(
            {"--spp",   "7",          "--time=2.5",  "a.pbrt",      "--size", "640x480",
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
    }

    TEST_CASE("input: a path to explain, with its sample or without") {
        RenderOptions o = options_of({"--explain", "3,4"});
        CHECK(o.explain);
        CHECK(o.explain_x == 3);
        CHECK(o.explain_y == 4);
        CHECK(o.explain_sample == -1);
        CHECK(options_of({"--explain=3,4,17"}).explain_sample == 17);
    }

    TEST_CASE("input: behind -- no word is an option") {
        CHECK(options_of({"--spp", "2", "--", "--quiet"}).scene == "--quiet");
    }

    TEST_CASE("input: the last of two values counts") {
        CHECK(options_of({"--spp", "2", "--spp", "3"}).spp == 3);
    }

    TEST_CASE("input: the command can be typed again") {
        CHECK(options_of({"a.pbrt", "--spp", "2"}).command == "build/07 a.pbrt --spp 2");
        CHECK(options_of({"my scene.pbrt", "--paths", "LD(S|D)*E"}).command ==
              "build/07 'my scene.pbrt' --paths 'LD(S|D)*E'");
        CHECK(options_of({"it's"}).command == "build/07 'it'\\''s'");
    }

    TEST_CASE("input: wrong options name the right one") {
        struct {
            std::vector<std::string> words;
            std::string error;
        } cases[] = {
            {{"--ssp", "4"}, "error: unknown option '--ssp', did you mean '--spp'?"},
            {{"-spp", "4"}, "error: unknown option '-spp', did you mean '--spp'?"},
            {{"--max_depth", "4"},
             "error: unknown option '--max_depth', did you mean '--max-depth'?"},
            {{"--SPP", "4"}, "error: unknown option '--SPP'; --help lists them"},
            {{"-"}, "error: unknown option '-'; --help lists them"},
        };
        for (const auto& c : cases) CHECK(usage_error(c.words) == c.error);
    }

    TEST_CASE("input: missing and superfluous values") {
        for (const char* name :
             {"--spp", "--time", "--size", "--seed", "--threads", "--max-depth", "--sampler",
              "--out", "--stats", "--explain", "--paths", "--split"}) {
            std::string error = "error: option '" + std::string(name) + "' needs a value";
            CHECK(usage_error({name}) == error);
            CHECK(usage_error({name, "--quiet"}) == error);
            CHECK(usage_error({name, ""}) == error);
            CHECK(usage_error({std::string(name) + "="}) == error);
        }
        CHECK(usage_error({"--quiet=1"}) == "error: option '--quiet' takes no value");
        CHECK(usage_error({"--help="}) == "error: option '--help' takes no value");
    }

    TEST_CASE("input: values that cannot be used") {
        const std::string whole = " takes a whole number from ";
        struct {
            std::string option, value, error;
        } cases[] = {
            {"--spp", "0", whole + "1 to 1073741824"},
            {"--spp", "1073741825", whole + "1 to 1073741824"},
            {"--spp", "4.5", whole + "1 to 1073741824"},
            {"--seed", "-1", whole + "0 to 4294967295"},
            {"--seed", "4294967296", whole + "0 to 4294967295"},
            {"--threads", "0", whole + "1 to 1024"},
            {"--max-depth", "-1", whole + "0 to 1073741824"},
            {"--time", "0", " takes a number greater than 0"},
            {"--time", "nan", " takes a number greater than 0"},
            {"--time", "inf", " takes a number greater than 0"},
            {"--size", "256x", " takes WIDTHxHEIGHT, such as 256x256"},
            {"--size", "-2x-2", " takes WIDTHxHEIGHT, such as 256x256"},
            {"--size", "65536x65536", " takes at most 2^28 pixels"},
            {"--sampler", "sobel",
             " takes independent, stratified or sobol (did you mean 'sobol'?)"},
            {"--out", "a.jpg", " takes a .ppm, .pfm or .png file"},
            {"--explain", "1", " takes X,Y or X,Y,SAMPLE"},
            {"--explain", "1,2,3,4", " takes X,Y or X,Y,SAMPLE"},
            {"--explain", "1,99999999999", " takes X,Y or X,Y,SAMPLE"},
        };
        for (const auto& c : cases) {
            CHECK(usage_error({c.option, c.value}) ==
                  "error: " + c.option + c.error + ", not '" + c.value + "'");
        }
        CHECK(usage_error({"--size", "0x4"}) ==
              "error: --size takes sides of 1 to 65536 pixels, not '0x4'");
        CHECK(usage_error({"--size", "4x99999"}) ==
              "error: --size takes sides of 1 to 65536 pixels, not '4x99999'");
        CHECK(usage_error({"--paths", "LD("}) ==
              "error: --paths \"LD(\", column 3: this ( is not closed");
        CHECK(usage_error({"--paths", "LDD"}) ==
              "error: --paths \"LDD\": no path is of such a class; "
              "they are L, then any of D and S, then E");
    }

    TEST_CASE("input: one scene, with a name") {
        CHECK(usage_error({"a.pbrt", "--spp", "2", "b.pbrt"}) ==
              "error: two scenes: 'a.pbrt' and 'b.pbrt'");
        CHECK(usage_error({""}) == "error: the name of the scene is empty");
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
        CHECK(error_of([] {
                  table_options_of({"--n", "0"});
              }) == "error: --n takes a whole number from 1 to 1099511627776, not '0'");
        CHECK(error_of([] {
                  table_options_of({"--out", "a.txt"});
              }) == "error: --out takes a .ppm, .pfm, .png or .tsv file, not 'a.txt'");
        CHECK(error_of([] { table_options_of({"scene.pbrt"}); }) ==
              "error: 'scene.pbrt' is not an option; --help lists them");
    }
}
