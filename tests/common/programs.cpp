// The programs themselves: what they write, what they print, and how they end.
#include <doctest/doctest.h>

#include <cstring>
#include <map>

#include "common/options/loading.h"
#include "common/path/sampler.h"
#include "common/picture/comparison.h"
#include "common/picture/image.h"
#include "common/picture/notes.h"
#include "common/picture/stats_file.h"
#include "common/results/table.h"
#include "tests/support/run_program.h"

namespace fs = std::filesystem;

namespace {

/// Options for a render of a few milliseconds.
Words small(const Words& more) {
    Words words = {spheres, "--size", "33x17", "--spp", "3", "--max-depth", "6"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// Options that every program knows, for a run of a few milliseconds.
Words brief(bool render, const Words& more) {
    Words words = render ? small({}) : Words{"--n", "100"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

bool is_one_line(const std::string& text) { return text.find('\n') == text.size() - 1; }

}  // namespace

TEST_SUITE("programs") {
    TEST_CASE("input: --help lists the options, on stdout") {
        for (bool render : {false, true}) {
            for (const std::string& program : programs(render)) {
                CAPTURE(program);
                Finished help = run(program, {"--help"});
                CHECK(help.code == 0);
                CHECK(help.err == "");
                CHECK(help.out.starts_with("usage: " + program_file(program)));
                Words names = {"--seed S", "--out FILE", "--quiet", "--help"};
                if (render) {
                    for (const char* name :
                         {"--spp N", "--time SECONDS", "--size WxH", "--threads T", "--max-depth D",
                          "--sampler KIND", "--stats FILE.json", "--explain X,Y[,SAMPLE]",
                          "--paths REGEX", "--split DIR", "--film FILE.film",
                          "--film-every SECONDS", "--part K/N"}) {
                        names.push_back(name);
                    }
                }
                for (const std::string& name : names) {
                    CHECK(help.out.find("  " + name + " ") != std::string::npos);
                }
            }
        }
    }

    TEST_CASE("input: a wrong option is one line on stderr and exit code 2") {
        for (bool render : {false, true}) {
            for (const std::string& program : programs(render)) {
                CAPTURE(program);
                Finished end = run(program, {"--quite"});
                CHECK(end.code == 2);
                CHECK(end.out == "");
                CHECK(end.err == "error: unknown option '--quite', did you mean '--quiet'?\n");
                end = run(program, {"--out", "two\nlines"});
                CHECK(end.code == 2);
                CHECK(is_one_line(end.err));
            }
        }
    }

    TEST_CASE("input: --radius has bounds, and --stats counts the rays of light paths") {
        TemporaryFolder folder;
        for (const char* chapter :
             {"23_photon_mapping", "24_progressive_photons", "25_vertex_merging"}) {
            CAPTURE(chapter);
            Words words = {spheres, "--size", "8x8", "--spp", "1", "--out", folder / "a.ppm"};
            for (const char* radius : {"1e-30", "1e-300", "1e30", "nan", "inf", "-1"}) {
                Words wrong = words;
                wrong.insert(wrong.end(), {"--radius", radius});
                Finished end = run(chapter, wrong);
                CHECK(end.code == 2);
                CHECK(is_one_line(end.err));
            }
            double rays[2];
            for (int i : {0, 1}) {
                Words more = words;
                more.insert(more.end(), {"--photons", i == 0 ? "1" : "9000", "--stats",
                                         folder / "s.json", "--threads", "3"});
                Finished end = run(chapter, more);
                CHECK(end.out.find("\nfirst radius ") != std::string::npos);
                StatsFile stats(read_file(folder / "s.json"));
                CHECK(stats.number("first_radius") > 1);
                rays[i] = stats.number("rays").value();
            }
            CHECK(rays[1] > rays[0] + 9000);
        }
    }

    TEST_CASE("files: an output without a place is exit code 1 before any work") {
        for (bool render : {false, true}) {
            for (const std::string& program : programs(render)) {
                CAPTURE(program);
                Words words =
                    render ? Words{spheres, "--spp", "100000000"} : Words{"--n", "1000000000000"};
                words.insert(words.end(), {"--out", "none/a.ppm"});
                Finished end = run(program, words);
                CHECK(end.code == 1);
                CHECK(end.out == "");
                CHECK(end.err == "none/a.ppm: error: cannot write: No such file or directory\n");
                CHECK(end.seconds < 5);
            }
        }
        TemporaryFolder folder;
        Finished end = run(path_tracer, {"--split", "/dev/null/d", "--spp", "100000000", "--out",
                                         folder / "a.ppm"});
        CHECK(end.code == 1);
        CHECK(end.err.starts_with("/dev/null/d: "));
        CHECK(is_one_line(end.err));
        CHECK(folder.names().empty());
    }

    TEST_CASE("files: each program writes what it is asked for, and what it wrote is a picture" *
              doctest::skip()) {
        for (bool render : {false, true}) {
            for (const std::string& program : programs(render)) {
                CAPTURE(program);
                TemporaryFolder folder;
                Words words = brief(render, few_photons(program));
                std::set<std::string> files = {"a.ppm", "a.pfm", "a.png"};
                if (!render) files.insert("a.tsv");
                for (const std::string& file : files) {
                    words.insert(words.end(), {"--out", folder / file});
                }
                Finished end = run(program, words);
                CHECK(end.code == 0);
                CHECK(end.err == "");
                CHECK(end.out != "");
                CHECK(folder.names() == files);
                Image pfm = read_image(folder / "a.pfm"), ppm = read_image(folder / "a.ppm");
                CHECK(pfm.width == ppm.width);
                CHECK(pfm.height == ppm.height);
                if (render) CHECK(pfm.width == 33);
                words.push_back("--quiet");
                end = run(program, words);
                CHECK(end.code == 0);
                CHECK(end.out == "");
                CHECK(end.err == "");
            }
        }
    }

    TEST_CASE("files: the heat map of chapter 06 has its own table, and refuses before any work") {
        TemporaryFolder folder;
        Words words = {spheres, "--size", "33x17", "--out", folder / "a.ppm"};
        Finished end = run("06_bvh", words);
        CHECK(end.code == 0);
        for (const char* word : {"linear", "median", "sah", "ordered", "four", "M rays/s"}) {
            CHECK(end.out.find(word) != std::string::npos);
        }
        CHECK(read_image(folder / "a.ppm").width == 33);
        CHECK(run("06_bvh", {spheres, "--step", "sha"}).err ==
              "error: --step takes linear, median, sah, ordered or four (did you mean 'sah'?), not "
              "'sha'\n");
        for (const char* option : {"--explain=1,1", "--spp=4", "--split=out", "--paths=LDE"}) {
            end = run("06_bvh", {spheres, option});
            CHECK(end.code == 2);
            CHECK(end.out == "");
            CHECK(end.err.find("means nothing to 06_bvh") != std::string::npos);
        }
        CHECK(run("06_bvh", {"--help"}).out.find("--explain") == std::string::npos);
        end = run("06_bvh", {spheres, "--out", "none/a.ppm"});
        CHECK(end.code == 1);
        CHECK(end.out == "");
        CHECK(end.err == "none/a.ppm: error: cannot write: No such file or directory\n");
    }

    TEST_CASE("input: a chapter's program renders what its chapter can, and refuses the rest") {
        struct {
            bool Features::*feature;
            std::string camera, sky, change, error;
        } cases[] = {
            {&Features::lens, "\"float lensradius\" 1", "", "", "have a lens"},
            {&Features::shutter, "", "", "ActiveTransform EndTime Scale 1 2 1", "shapes move in"},
            {&Features::sky_image, "",
             "\"string filename\" \"" + file_name(fs::absolute("scenes/sky.pfm")) + "\"", "",
             "has an image in"},
            {&Features::dispersion, "", "",
             "Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"", "glass disperses in"}};
        TemporaryFolder folder;
        for (const std::string& program : programs(true))
            for (const auto& c : cases) {
                CAPTURE(program);
                CAPTURE(c.error);
                std::string text = "Camera \"perspective\" " + c.camera +
                                   " WorldBegin LightSource \"infinite\" " + c.sky + " " +
                                   c.change + " Shape \"sphere\"";
                write_file_atomically(folder / "a.pbrt", text);
                Words words = {folder / "a.pbrt", "--size", "4x4",           "--spp", "1",
                               "--quiet",         "--out",  folder / "a.pfm"};
                append(words, few_photons(program));
                Finished end = run(program, words);
                CAPTURE(end.err);
                bool rendered = features_of(std::stoi(program)).*c.feature;
                CHECK(end.code == (rendered ? 0 : 1));
                CHECK((end.err.find(c.error) == std::string::npos) == rendered);
            }
    }

    TEST_CASE("truth: paths end at the depth limit in a white room, and in a black one at once") {
        TemporaryFolder folder;
        auto stats = [&](const std::string& program, const char* reflectance, const char* depth) {
            write_file_atomically(
                folder / "a.pbrt",
                "LookAt 0 0 -0.5 0 0 0 0 1 0 Camera \"perspective\" WorldBegin Material "
                "\"diffuse\" \"rgb reflectance\" " +
                    std::string(reflectance) +
                    " Shape \"sphere\" \"float radius\" 2 AreaLightSource \"diffuse\" "
                    "Translate 0 1 0 Shape \"sphere\" \"float radius\" 0.3");
            Words words = {folder / "a.pbrt", "--size", "8x8",     "--spp",          "2",
                           "--max-depth",     depth,    "--stats", folder / "s.json"};
            append(words, few_photons(program));
            CHECK(run(program, words).code == 0);
            return StatsFile(read_file(folder / "s.json"));
        };
        for (const std::string& program : programs(true)) {
            if (program < "07" || program == "26_radiosity") continue;  // no random paths
            CAPTURE(program);
            CHECK(stats(program, "[1 1 1]", "1").number("paths_cut_by_depth") == 128);
            StatsFile black = stats(program, "[0 0 0]", "50");
            CHECK(black.number("paths_cut_by_depth") == 0);
            // Those of 21, 22 and 25 begin at both ends; two passes of 23 and 24 send 2000 photons.
            std::string number = program.substr(0, 2);
            bool both = number == "21" || number == "22" || number == "25";
            bool photons = number == "23" || number == "24";
            CHECK(black.number("rays") == (both ? 256 : photons ? 4128 : 128));
        }
    }

    TEST_CASE("identity: the same bytes for 1, 2 and 7 threads and for each sampler" *
              doctest::skip()) {
        for (const std::string& program : programs(true)) {
            CAPTURE(program);
            std::set<std::string> different;
            for (const char* sampler : {"independent", "stratified", "sobol"}) {
                TemporaryFolder folder;
                std::set<std::string> same;
                for (const char* threads : {"1", "2", "7"}) {
                    // Each into a file of another name, and with statistics of its own.
                    std::string name = folder / threads, bytes;
                    Words words = small({"--threads", threads, "--sampler", sampler, "--quiet",
                                         "--stats", name + ".json"});
                    append(words, few_photons(program));
                    for (const char* kind : {".pfm", ".ppm", ".png"})
                        words.insert(words.end(), {"--out", name + kind});
                    CHECK(run(program, words).code == 0);
                    for (const char* kind : {".pfm", ".ppm", ".png"})
                        bytes += read_file(name + kind);
                    same.insert(bytes);
                }
                CHECK(same.size() == 1);
                different.insert(*same.begin());
            }
            CHECK(different.size() == 3);
        }
    }

    TEST_CASE("identity: a picture's notes tell how to make its bytes again" * doctest::skip()) {
        const std::map<std::string, Words> own = {{"09_light_sampling", {"--light-by", "area"}},
                                                  {"12_ris", {"--m", "3"}},
                                                  {"13_glossy", {"--strategy", "bsdf"}},
                                                  {"15_mis_ris", {"--m", "2"}},
                                                  {"16_lens_and_shutter", {"--pixel", "centre"}},
                                                  {"17_sky_image", {"--compensation", "off"}},
                                                  {"18_dispersion", {"--m", "2"}},
                                                  {"19_adaptive", {"--pilot", "4"}},
                                                  {"21_bidirectional", {"--strategy", "1,2"}},
                                                  {"22_fast_bidirectional", {"--chances", "2"}}};
        for (bool render : {false, true}) {
            for (const std::string& program : programs(render)) {
                CAPTURE(program);
                TemporaryFolder folder;
                auto make = [&](const std::string& name, Words words) {
                    words.insert(words.end(), {"--quiet", "--out", folder / name + ".ppm", "--out",
                                               folder / name + ".png"});
                    CHECK(run(program, words).code == 0);
                    return read_file(folder / name + ".ppm");
                };
                Words words = brief(render, {"--seed", "5"});
                append(words, few_photons(program));
                if (render) words.insert(words.end(), {"--sampler", "sobol", "--paths", "L.*D.*E"});
                if (own.contains(program))
                    words.insert(words.end(), own.at(program).begin(), own.at(program).end());
                std::string bytes = make("a", words);
                Notes notes = notes_in(decode_comment("a.ppm", bytes));
                CHECK(notes_in(decode_comment("a.png", read_file(folder / "a.png"))) == notes);
                CHECK(value_of(notes, "chapter") == program);
                CHECK(value_of(notes, "scene") == (render ? "cornell-spheres.pbrt" : ""));
                Words again;
                if (render) again = {spheres};
                for (const auto& [name, value] : notes) {
                    if (name == "chapter" || name == "scene" || name == "checksum") continue;
                    if (value != "all") again.insert(again.end(), {"--" + name, value});
                }
                CHECK(make("b", again) == bytes);
                // Nothing else makes the same notes.
                CHECK(make("c", brief(render, {})) != bytes);
                Notes plain = notes_in(decode_comment("c.ppm", read_file(folder / "c.ppm")));
                for (size_t i = 0; i + 1 < words.size(); i++) {
                    if (words[i].starts_with("--") && words[i] != "--size" && words[i] != "--spp" &&
                        words[i] != "--max-depth" && words[i] != "--n")
                        CHECK(value_of(notes, words[i].substr(2)) !=
                              value_of(plain, words[i].substr(2)));
                }
            }
        }
    }

    TEST_CASE("files: Ctrl-C and its like leave a whole picture, with a note and exit code 3" *
              doctest::skip()) {
        for (int signal : {SIGINT, SIGTERM}) {
            TemporaryFolder folder;
            Finished end;
            // The signal must not come before it renders; so wait longer when it was too early.
            for (int ms = 300; ms < 30000; ms *= 2) {
                Process process =
                    start(path_tracer, {"--size", "32x32", "--spp", "1000000000", "--out",
                                        folder / "a.pfm", "--stats", folder / "s.json"});
                ::usleep(static_cast<useconds_t>(1000 * ms));
                process.kill(signal);
                end = process.wait();
                if (end.signal == 0) break;
            }
            CHECK(end.code == 3);
            CHECK(end.err == "");
            CHECK(end.out.find(" (interrupted)\n") != std::string::npos);
            std::string json = read_file(folder / "s.json");
            CHECK(json.find("\"interrupted\": true") != std::string::npos);
            StatsFile stats(json);
            CHECK(stats.number("spp").value() >= 1);
            CHECK(stats.number("empty_pixels_share") == 0);
            Image image = read_image(folder / "a.pfm");
            CHECK(image.width == 32);
            // Of the Cornell box, the light among its pixels.
            float brightest = 0;
            for (Rgb p : image.pixels) brightest = std::max(brightest, p.r);
            CHECK(brightest > 10);
        }
    }

    TEST_CASE("identity: a render that is stopped and goes on from its film has the same bytes" *
              doctest::skip()) {
        TemporaryFolder folder;
        auto words = [&](const std::string& name, const char* sampler) {
            return Words{spheres,     "--size",
                         "33x17",     "--spp",
                         "1000",      "--quiet",
                         "--threads", "2",
                         "--film",    folder / name + ".film",
                         "--sampler", sampler,
                         "--out",     folder / name + ".pfm"};
        };
        for (auto [program, sampler] : {std::pair(path_tracer, "independent"),
                                        {path_tracer, "stratified"},
                                        {path_tracer, "sobol"},
                                        {light_tracer, "sobol"}}) {
            REQUIRE(run(program, words("a", sampler)).code == 0);
            Finished end;
            for (int stops = 0; stops < 100; stops++) {
                Process process = start(program, words("b", sampler));
                ::usleep(static_cast<useconds_t>(50000 + 1000 * stops));
                process.kill(SIGTERM);
                end = process.wait();
                if (end.code == 0) break;
                CHECK((end.code == 3 || end.signal == SIGTERM));
            }
            REQUIRE(end.code == 0);
            CHECK(read_file(folder / "b.film") == read_file(folder / "a.film"));
            CHECK(read_file(folder / "b.pfm") == read_file(folder / "a.pfm"));
            fs::remove(folder / "a.film");
            fs::remove(folder / "b.film");
        }
    }

    TEST_CASE("identity: parts of a render, merged in any order, have the bytes of the whole") {
        for (auto [program_here, sampler_here] :
             {std::pair(std::string("15_mis_ris"), "independent"),
              {"15_mis_ris", "stratified"},
              {"15_mis_ris", "sobol"},
              {light_tracer, "independent"},
              {light_tracer, "sobol"}}) {
            TemporaryFolder folder;
            const std::string& program = program_here;
            const char* sampler = sampler_here;
            auto render = [&](const std::string& name, const char* part) {
                return run(program,
                           {spheres, "--size", "33x17", "--spp", "10", "--sampler", sampler,
                            "--quiet", "--part", part, "--film", folder / name + ".film", "--out",
                            folder / name + ".pfm", "--out", folder / name + ".ppm", "--out",
                            folder / name + ".png"});
            };
            REQUIRE(render("whole", "1/1").code == 0);
            REQUIRE(render("1", "1/3").code == 0);
            REQUIRE(render("2", "2/3").code == 0);
            REQUIRE(render("3", "3/3").code == 0);
            for (const Words& order : {Words{"3", "1", "2"}, Words{"2", "3", "1"}}) {
                for (const char* kind : {".film", ".pfm", ".ppm", ".png"}) {
                    Words words = {folder / "out" + kind};
                    for (const std::string& part : order) words.push_back(folder / part + ".film");
                    REQUIRE(run("merge", words).code == 0);
                    CHECK(read_file(folder / "out" + kind) == read_file(folder / "whole" + kind));
                }
            }
            std::string before = read_file(folder / "out.film");
            Finished end =
                run("merge", {folder / "out.film", folder / "1.film", folder / "1.film"});
            CHECK(end.code == 1);
            CHECK(end.err == folder / "1.film" + ": error: sample 0 of seed 0 would count twice\n");
            CHECK(read_file(folder / "out.film") == before);
        }
    }

    TEST_CASE("input: a film of something else is refused with one line, and stays as it is") {
        TemporaryFolder folder;
        Words first = {spheres,  "--size",          "33x17", "--spp",         "4",
                       "--film", folder / "a.film", "--out", folder / "a.ppm"};
        REQUIRE(run("12_ris", first).code == 0);
        std::string before = read_file(folder / "a.film");
        struct {
            const char* program;
            Words more;
            const char* error;
        } cases[] = {
            {"12_ris", {"--size", "33x18"}, "its size is \"33x17\", here it is \"33x18\""},
            {"12_ris", {"--m", "3"}, "its m is \"16\", here it is \"3\""},
            {"12_ris", {"--max-depth", "3"}, "its max-depth is \"100\", here it is \"3\""},
            {"12_ris", {"--paths", "LDE"}, "its paths is \"\", here it is \"LDE\""},
            {"12_ris",
             {"--seed", "7"},
             "it holds samples 0 to 3 of seed 0, which do not begin what is asked for: samples 0 "
             "to 3 of seed 7"},
            {"11_light_importance",
             {},
             "its chapter is \"12_ris\", here it is \"11_light_importance\""},
        };
        for (const auto& c : cases) {
            Words words = first;
            words.insert(words.end(), c.more.begin(), c.more.end());
            Finished end = run(c.program, words);
            CHECK(end.code == 1);
            CHECK(end.err == folder / "a.film" + ": error: " + c.error + "\n");
            CHECK(read_file(folder / "a.film") == before);
        }
        CHECK(run(path_tracer, small({"--part", "1/2"})).code == 2);
        CHECK(run(path_tracer, small({"--part", "1/4", "--film", folder / "b.film"})).code == 2);
        for (const char* other : {"--split=d", "--explain=1,1"}) {
            CHECK(run(path_tracer, small({"--film", folder / "b.film", other})).code == 2);
        }
        CHECK(folder.names() == std::set<std::string>{"a.film", "a.ppm"});
    }

    TEST_CASE("truth: --time ends the render after so many seconds" * doctest::skip()) {
        TemporaryFolder folder;
        Finished end = run(path_tracer, {spheres, "--size", "64x64", "--time", "0.4", "--quiet",
                                         "--out", folder / "a.pfm", "--stats", folder / "s.json"});
        CHECK(end.code == 0);
        CHECK(end.seconds < 5);
        std::string json = read_file(folder / "s.json");
        CHECK(json.find("\"interrupted\": false") != std::string::npos);
        StatsFile stats(json);
        CHECK(stats.number("seconds").value() >= 0.4);
        CHECK(stats.number("spp").value() >= 1);
    }

    TEST_CASE("truth: a render without time for its first pass says which share is missing") {
        TemporaryFolder folder;
        Finished end = run(path_tracer, {spheres, "--size", "1024x1024", "--time", "0.000001",
                                         "--out", folder / "a.ppm"});
        CHECK(end.code == 0);
        CHECK(end.out.find("\nwarning: rendering ended before 100 % of the pixels had a sample") !=
              std::string::npos);
        CHECK(read_image(folder / "a.ppm").width == 1024);
    }

    TEST_CASE("identity: the pictures of --split sum to the whole, in each chapter" *
              doctest::skip()) {
        for (const std::string& program : programs(true)) {
            CAPTURE(program);
            TemporaryFolder folder;
            Words words = {spheres,   "--size",  "24x24",      "--spp", "4",
                           "--quiet", "--split", folder / "d", "--out", folder / "a.pfm"};
            append(words, few_photons(program));
            REQUIRE(run(program, words).code == 0);
            Image whole = read_image(folder / "a.pfm"), sum(24, 24);
            std::set<std::string> classes;
            for (const auto& entry : fs::directory_iterator(folder / "d")) {
                if (entry.path().extension() == ".png") continue;
                classes.insert(entry.path().stem().string());
                Image part = read_image(entry.path().string());
                for (size_t i = 0; i < sum.pixels.size(); i++) sum.pixels[i] += part.pixels[i];
                Image png = read_image(fs::path(entry.path()).replace_extension(".png").string());
                bool same = true;
                for (size_t i = 0; i < sum.pixels.size(); i++) {
                    same = same && to_srgb8(png.pixels[i].g) == to_srgb8(part.pixels[i].g);
                }
                CHECK(same);
            }
            CHECK(read_image(folder / "d/classes.png").width > 24);
            for (const char* one : {"LE", "LDE"}) CHECK(classes.contains(one));
            for (size_t i = 0; i < sum.pixels.size(); i++) {
                double a = static_cast<double>(sum.pixels[i].g);
                double b = static_cast<double>(whole.pixels[i].g);
                CHECK(std::abs(a - b) <= 1e-5 * b);
            }
        }
    }

    TEST_CASE("identity: --paths keeps the classes that --split would name") {
        TemporaryFolder folder;
        Words words = small({"--quiet", "--split", folder / "d", "--out", folder / "a.pfm"});
        REQUIRE(run(path_tracer, words).code == 0);
        words = small(
            {"--quiet", "--paths", "LDE", "--out", folder / "b.pfm", "--out", folder / "b.png"});
        REQUIRE(run(path_tracer, words).code == 0);
        CHECK(read_file(folder / "d/LDE.pfm") == read_file(folder / "b.pfm"));
        CHECK(read_file(folder / "d/LDE.png") == read_file(folder / "b.png"));
    }

    TEST_CASE("input: scenes that cannot be read are one line and exit code 1") {
        TemporaryFolder folder;
        write_file_atomically(folder / "bad.pbrt", "WorldBegin\nShape \"spere\"\n");
        struct {
            std::string scene, error;
        } cases[] = {
            {folder / "none.pbrt", folder / "none.pbrt" + ": error: cannot read: "},
            {folder.path(), folder.path() + ": error: cannot read: Is a directory\n"},
            {folder / "bad.pbrt", folder / "bad.pbrt" + ":2:7: error: "},
            {"/dev/null", "/dev/null"},
        };
        for (const auto& c : cases) {
            Finished end = run(path_tracer, {c.scene, "--out", folder / "a.ppm"});
            CHECK(end.code == 1);
            CHECK(end.out == "");
            CHECK(end.err.starts_with(c.error));
            CHECK(is_one_line(end.err));
        }
        CHECK(folder.names() == std::set<std::string>{"bad.pbrt"});
    }
}
