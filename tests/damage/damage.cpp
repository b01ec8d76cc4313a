// Kills, signals, full disks, limits and damaged files; the long fuzzing is `make fuzz`.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <map>

#include "common/base/system.h"
#include "common/picture/film.h"
#include "common/picture/image.h"
#include "common/render/render.h"
#include "tests/damage/scenes.h"
#include "tests/support/process.h"
#include "tests/support/stand_ins.h"

namespace fs = std::filesystem;

TEST_SUITE("outputs") {
    TEST_CASE("files: a write that fails in the middle keeps the old file, and leaves nothing") {
        TemporaryFolder folder;
        write_file_atomically(folder / "a", "the old one");
        // What a full disk does: let no file of this process grow beyond 100,000 bytes.
        Finished end =
            Process([&] {
                std::signal(SIGXFSZ, SIG_IGN);
                rlimit limit = {100000, 100000};
                ::setrlimit(RLIMIT_FSIZE, &limit);
                std::string error = error_of(
                    [&] { write_file_atomically(folder / "a", std::string(200000, 'x')); });
                return error == folder / "a: error: cannot write: File too large" ? 0 : 1;
            }).wait();
        CHECK(end.code == 0);
        CHECK(read_file(folder / "a") == "the old one");
        CHECK(folder.names() == std::set<std::string>{"a"});
    }

    TEST_CASE("files: each output is written or named, whatever happens to the others") {
        TemporaryFolder folder;
        fs::create_directory(folder / "split");
        fs::create_symlink("/dev/full", folder / "split/LDE.png");
        write_file_atomically(folder / "kept.ppm", "precious");
        ::chmod((folder / "kept.ppm").c_str(), 0444);
        Words words = {"--split", folder / "split", "--stats", folder / "no/s.json"};
        for (const char* name : {"no/a.pfm", "kept.ppm", "a.ppm"})
            append(words, {"--out", folder / name});
        if (!exists_here("/dev/full")) return;
        Finished end = run(path_tracer, brief(spheres, words));
        CAPTURE(end.err);
        CHECK(end.code == 1);
        std::istringstream lines(end.err);
        std::set<std::string> named;
        for (std::string line; std::getline(lines, line);)
            named.insert(line.substr(0, line.find(": error: cannot write: ")));
        CHECK(named == std::set<std::string>{folder / "split/LDE.png", folder / "no/s.json",
                                             folder / "no/a.pfm", folder / "kept.ppm"});
        for (const char* name : {"a.ppm", "split/LDE.pfm", "split/classes.png"})
            CHECK(read_image(folder / name).width >= 16);
    }

    TEST_CASE("files: a film has one owner at a time, also after kills, and nothing else is left") {
        TemporaryFolder folder;
        std::string film = folder / "a.film";
        auto words = [&](const char* part, const char* seconds) {
            return brief(spheres, {"--spp", "1000000", "--time", seconds, "--part", part, "--film",
                                   film, "--out", folder / "a.ppm"});
        };
        Process owner = start(path_tracer, words("1/2", "60"));
        REQUIRE(comes_to_be(film));
        const std::string why = ": error: another program is writing it\n";
        run(path_tracer, brief(spheres, {"--film", folder / "b.film", "--out", folder / "b.ppm"}));
        for (const Finished& end :
             {run(path_tracer, words("2/2", "1")), run("merge", {film, folder / "b.film"})}) {
            CHECK(end.code == 1);
            CHECK(end.err == film + why);
        }
        owner.kill(SIGKILL);
        owner.wait();
        CHECK(run(path_tracer, words("1/2", "0.1")).code == 0);
        CHECK(folder.names() == std::set<std::string>{"a.film", "a.ppm", "b.film", "b.ppm"});
    }

    TEST_CASE("input: memory that cannot be had is an error") {
#if defined(__SANITIZE_ADDRESS__)
        MESSAGE("skipped: the sanitizer needs all addresses");
#else
        TemporaryFolder folder;
        Finished end = Process([&] {
                           rlimit limit = {500 << 20, 500 << 20};
                           ::setrlimit(RLIMIT_AS, &limit);
                           return execute(path_tracer, {"scenes/furnace.pbrt", "--size",
                                                        "5000x5000", "--out", folder / "a.ppm"});
                       }).wait();
        CHECK(end.code == 1);
        CHECK(end.err == "error: out of memory\n");
#endif
    }
}

TEST_SUITE("render loop") {
    TEST_CASE("truth: a signal ends the render, later the program; an ignored one does nothing") {
        auto code_of = [](int signal, bool ignored) {
            return Process([=] {
                       prepare_streams();
                       if (ignored) std::signal(signal, SIG_IGN);  // as nohup does
                       auto raising = [=](const Scene&, Ray, Sampler&, Recorder&) {
                           std::raise(signal);
                           return Rgb{};
                       };
                       Limit until_the_end;
                       Rendering r =
                           render_film(empty_scene(300, 300, 1), stand_in_options(1), raising);
                       // timeout sends each signal twice at once; a terminal that closes, others.
                       for (int other : {SIGINT, SIGTERM, SIGHUP})
                           if (!ignored) std::raise(other);
                       return r.stats.interrupted ? 3 : 0;
                   })
                .wait()
                .code;
        };
        for (int signal : stop_signals) {
            CHECK(code_of(signal, false) == 3);
            CHECK(code_of(signal, true) == 0);
            CHECK(Process([=] {
                      Limit stop;
                      std::raise(signal);
                      ::usleep(600'000);
                      std::raise(signal);
                      return 0;
                  })
                      .wait()
                      .signal == signal);
        }
        // Errors of writing.
        for (int signal : {SIGPIPE, SIGXFSZ}) CHECK(code_of(signal, false) == 0);
    }
}

TEST_SUITE("films, slow") {
    TEST_CASE("identity: renders that are killed, and parts by job runners, lose nothing") {
        Finished end =
            Process(Words{"bash", "tests/damage/interrupted", program_folder, "30"}).wait();
        CHECK(end.code == 0);
        MESSAGE(end.out);
    }
}

TEST_SUITE("films of parts") {
    TEST_CASE(
        "teeth: the hash of a chapter's code changes with any file of it, and of no other "
        "chapter" *
        doctest::skip()) {
        TemporaryFolder copy, folder;
        for (const char* name : {"Makefile", "common", "chapters"})
            fs::copy(name, copy / name, fs::copy_options::recursive);
        fs::create_directory(copy / "tests");
        fs::copy("tests/rules.mk", copy / "tests");
        auto hashes = [&] {
            Process make(Words{"env", "-u", "MAKEFLAGS", "-u", "MAKELEVEL", "make", "-C",
                               copy.path(), "--quiet", "-B", "BUILD=build",
                               "build/include/code_hashes.h"});
            REQUIRE(make.wait().code == 0);
            std::map<std::string, std::string> all;  // name of the chapter -> hash
            std::istringstream lines(read_file(copy / "build/include/code_hashes.h"));
            for (std::string line; std::getline(lines, line);) {
                char chapter[100], hash[100];
                if (std::sscanf(line.c_str(), " {\"%99[^\"]\", \"%99[^\"]\"}", chapter, hash) == 2)
                    all[chapter] = hash;
            }
            REQUIRE(all.size() >= 20);
            return all;
        };
        auto change = [&](const std::string& file) {
            std::ofstream(copy / file, std::ios::app) << "// more\n";
        };
        auto before = hashes();
        REQUIRE(run(path_tracer, {spheres, "--size", "3x3", "--spp", "1", "--quiet", "--film",
                                  folder / "a.film", "--out", folder / "a.ppm"})
                    .code == 0);
        CHECK(read_film(folder / "a.film").label.options[1].second == before[path_tracer]);
        change("common/tools/compare.cpp");  // in no chapter
        change("chapters/07_path_tracing/estimator.h");
        auto after = hashes();
        for (const auto& [chapter, hash] : before)
            CHECK((after[chapter] != hash) == (chapter == path_tracer));
        change("common/material/ggx.h");
        for (const auto& [chapter, hash] : hashes()) CHECK(after[chapter] != hash);
    }
}

TEST_SUITE("reader: malformed input") {
    TEST_CASE("input: damaged scenes and meshes are read or refused, and nothing else happens" *
              doctest::skip()) {
        constexpr uint32_t count = 3000;
        FuzzResult result = fuzz(1'000'000, count);
        CHECK(result.read + result.refused == count);
        // Both ends are met, or the damage would be too great or too small to show anything.
        CHECK(result.read > count / 20);
        CHECK(result.refused > count / 3);
    }
}
