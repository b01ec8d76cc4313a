// The programs themselves: what they write, what they print, and how they end.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include "common/picture/film_file.h"
#include "common/picture/image.h"
#include "common/render/loading.h"
#include "tests/support/process.h"

namespace fs = std::filesystem;

namespace {

Words joined(Words words, const Words& more) {
    append(words, more);
    return words;
}

bool is_one_line(const std::string& text) { return text.find('\n') == text.size() - 1; }

}  // namespace

TEST_SUITE("programs") {
    TEST_CASE("input: each program has --help, and refuses in one line before any work") {
        TemporaryFolder folder;
        std::string precious = folder / "a.ppm";
        write_file_atomically(precious, "precious");
        ::chmod(precious.c_str(), 0444);
        for (bool render : {false, true})
            for (const std::string& program : programs(render)) {
                CAPTURE(program);
                Finished help = run(program, {"--help"});
                CHECK(help.code == 0);
                CHECK(help.err == "");
                CHECK(help.out.starts_with("usage: " + program_file(program)));
                Words names = {"--seed S", "--out FILE", "--quiet", "--help"};
                if (render) append(names, {"--spp N", "--time SECONDS", "--film FILE.film"});
                for (const std::string& name : names)
                    CHECK(help.out.find("  " + name + " ") != std::string::npos);
                const Words endless =
                    render ? Words{spheres, "--spp", "100000000"} : Words{"--n", "1000000000000"};
                auto refuses = [&](int code, const Words& words, const std::string& begin) {
                    Finished end = run(program, joined(endless, words));
                    CHECK(end.code == code);
                    CHECK(end.out == "");
                    CHECK(end.err.starts_with(begin));
                    CHECK(is_one_line(end.err));
                    CHECK(end.seconds < 5);
                };
                refuses(2, {"--quite"}, "error: unknown option '--quite', did you mean '--quiet'");
                refuses(2, {"--out", "two\nlines"}, "error: ");
                refuses(1, {"--out", "none/a.ppm"}, "none/a.ppm: error: ");
                refuses(1, {"--out", precious}, precious + ": error: ");
            }
        CHECK(read_file(precious) == "precious");
        CHECK(folder.names() == std::set<std::string>{"a.ppm"});
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
                write_file_atomically(folder / "a.pbrt", "Camera \"perspective\" " + c.camera +
                                                             " WorldBegin LightSource "
                                                             "\"infinite\" " +
                                                             c.sky + " " + c.change +
                                                             " Shape \"sphere\"");
                Words words = {folder / "a.pbrt", "--size", "4x4", "--spp", "1", "--quiet"};
                append(words, {"--out", folder / "a.pfm"});
                Finished end = run(program, joined(words, few_photons(program)));
                CAPTURE(end.err);
                bool rendered = features_of(std::stoi(program)).*c.feature;
                CHECK(end.code == (rendered ? 0 : 1));
                CHECK((end.err.find(c.error) == std::string::npos) == rendered);
            }
    }

    TEST_CASE("identity: what Ctrl-C stops is a whole picture, and goes on to the same bytes" *
              doctest::skip()) {
        for (auto [program, sampler, signal] :
             {std::tuple(path_tracer, "independent", SIGINT), {light_tracer, "sobol", SIGTERM}}) {
            TemporaryFolder folder;
            auto words = [&, s = sampler](const std::string& name, const std::string& spp) {
                std::string beside = folder / name;
                Words some = {spheres, "--size", "33x17", "--spp", spp, "--sampler", s};
                return joined(some, {"--threads", "2", "--film", beside + ".film", "--out",
                                     beside + ".pfm", "--stats", beside + ".json"});
            };
            Process process = start(program, words("a", "100000000"));
            REQUIRE(comes_to_be(folder / "a.film"));
            ::usleep(300'000);
            process.kill(signal);
            Finished end = process.wait();
            CHECK(end.code == 3);
            CHECK(end.err == "");
            CHECK(end.out.find(" (interrupted)\n") != std::string::npos);
            CHECK(read_image(folder / "a.pfm").width == 33);
            StatsFile stats{read_file(folder / "a.json")};
            CHECK(stats.number("empty_pixels_share") == 0);
            std::string spp =
                std::to_string(read_film(folder / "a.film").label.samples[0].last + 10);
            for (const char* name : {"a", "b"}) REQUIRE(run(program, words(name, spp)).code == 0);
            CHECK(read_file(folder / "b.film") == read_file(folder / "a.film"));
            CHECK(read_file(folder / "b.pfm") == read_file(folder / "a.pfm"));
        }
    }
}
