// The programs themselves: what they write, what they print, and how they end.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include "common/picture/film.h"
#include "common/picture/image.h"
#include "common/render/render.h"
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
                refuses(2, {"--quite"},
                        "error: unknown option \"--quite\": did you mean \"--quiet\"?");
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

TEST_SUITE("outputs") {
    TEST_CASE("files: no output overwrites a file that was read, under a name in any language") {
        TemporaryFolder folder;
        const std::string strange = "Größe 日本 🎨";
        const std::string scene = folder / strange + ".pbrt", mesh = folder / strange + ".ply";
        write_file_atomically(scene,
                              "Camera \"perspective\"\nWorldBegin\nInclude \"part.txt\"\n"
                              "LightSource \"infinite\" \"string filename\" \"sky.pfm\"\n");
        write_file_atomically(folder / "part.txt",
                              "Shape \"plymesh\" \"string filename\" \"" + strange + ".ply\"\n");
        write_file_atomically(mesh,
                              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 3\n1 0 3\n0 1 3\n3 0 1 2\n");
        Image sky(4, 4);
        for (Rgb& p : sky.pixels) p = {1, 1, 1};
        write_image(folder / "sky.pfm", sky, "");
        fs::copy_file(file_path(scene), folder / "a.svg");
        fs::create_directory(folder / "d");
        if (!make_link("../sky.pfm", folder / "d/classes.png"))
            fs::create_hard_link(folder / "sky.pfm", folder / "d/classes.png");
        std::string out = folder / strange + ".pfm";
        auto refuses = [&](const std::string& path, const Words& words) {
            CAPTURE(words[0] + " " + words[1]);
            Finished end = run("17_sky_image", brief(path, words));
            CHECK(end.code == 2);
            CHECK(end.out == "");
            CHECK(end.err.ends_with(", and would be overwritten\n"));
        };
        std::set<std::string> before = folder.names();
        refuses(scene, {"--out", folder / "d/../sky.pfm"});
        for (const std::string& input : {mesh, folder / "part.txt", scene})
            refuses(scene, {"--stats", input, "--out", out});
        refuses(scene, {"--split", folder / "d", "--out", out});
        refuses(folder / "a.svg", {"--explain", "1,1", "--out", folder / "a.ppm"});
        CHECK(folder.names() == before);
        CHECK(read_image(folder / "sky.pfm").at(1, 1) == Rgb{1, 1, 1});
        Words words = brief(scene, {"--out", out, "--film", folder / strange + ".film"});
        for (int times = 0; times < 2; times++) {
            Finished end = run("17_sky_image", words);
            CHECK(end.code == 0);
            CHECK(end.err == "");
        }
        CHECK(read_image(out).width == 16);
    }
}
