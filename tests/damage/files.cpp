// Files, where other systems than Windows have their own ways: modes, links, limits.
#include "common/base/files.h"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>

#include "tests/support/process.h"

namespace fs = std::filesystem;

TEST_SUITE("files") {
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

    TEST_CASE("files: a link stays a link, and the file that it names keeps its mode") {
        TemporaryFolder folder;
        write_file_atomically(folder / "f", "x");
        write_file_atomically(folder / "precious", "p");
        fs::create_symlink("f", folder / "link");
        fs::create_symlink("link", folder / "to_link");
        fs::create_symlink("precious", folder / "f.part");  // leads nobody astray
        for (mode_t mode : {0600u, 0660u}) {
            ::chmod((folder / "f").c_str(), mode);
            write_file_atomically(folder / "to_link", "new");
            CHECK(fs::is_symlink(folder / "link"));
            CHECK(read_file(folder / "f") == "new");
            struct stat file = {};
            REQUIRE(::stat((folder / "f").c_str(), &file) == 0);
            CHECK((file.st_mode & 0777) == mode);
        }
        CHECK(read_file(folder / "precious") == "p");
    }
}
