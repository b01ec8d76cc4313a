// Files, where other systems than Windows have their own ways: modes, links, pipes, limits, kills.
#include "common/base/files.h"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "tests/support/folder.h"

namespace fs = std::filesystem;

namespace {

/// Runs `work` in a process of its own, since it changes the process; returns its exit code.
template <typename Work>
int in_child(const Work& work) {
    pid_t child = ::fork();
    if (child == 0) ::_exit(work());
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_SUITE("files") {
    TEST_CASE("files: a write that fails in the middle keeps the old file, and leaves nothing") {
        TemporaryFolder folder;
        write_file_atomically(folder / "a", "the old one");
        // What a full disk does: let no file of this process grow beyond 100,000 bytes.
        int failed = in_child([&] {
            std::signal(SIGXFSZ, SIG_IGN);
            rlimit limit = {100000, 100000};
            ::setrlimit(RLIMIT_FSIZE, &limit);
            std::string error =
                error_of([&] { write_file_atomically(folder / "a", std::string(200000, 'x')); });
            return error == folder / "a" + ": error: cannot write: File too large" ? 0 : 1;
        });
        CHECK(failed == 0);
        CHECK(read_file(folder / "a") == "the old one");
        CHECK(folder.names() == std::set<std::string>{"a"});
    }

    TEST_CASE("files: a folder without permission is an error") {
        TemporaryFolder folder;
        fs::create_directory(folder / "d");
        ::chmod((folder / "d").c_str(), 0555);
        ::chmod(folder.path().c_str(), 0755);
        int failed = in_child([&] {
            if (::getuid() == 0 && ::setuid(65534) != 0) return 2;  // root may write everywhere
            std::string error = folder / "d/a" + ": error: cannot write: Permission denied";
            bool told = error_of([&] { write_file_atomically(folder / "d/a", "x"); }) == error;
            return told && error_of([&] { check_writable(folder / "d/a"); }) == error ? 0 : 1;
        });
        CHECK(failed == 0);
        ::chmod((folder / "d").c_str(), 0755);
    }

    TEST_CASE("files: a link stays a link, and the file it names is written") {
        TemporaryFolder folder;
        fs::create_directory(folder / "d");
        for (const char* target : {"d/old", "d/new"}) {
            if (target == std::string("d/old")) write_file_atomically(folder / "d/old", "x");
            fs::create_symlink(target, folder / "link");
            fs::create_symlink("link", folder / "to_link");
            write_file_atomically(folder / "to_link", "new");
            CHECK(fs::is_symlink(folder / "link"));
            CHECK(read_file(folder / target) == "new");
            fs::remove(folder / "link");
            fs::remove(folder / "to_link");
        }
    }

    TEST_CASE("files: a new file has the mode of the old one, and no link leads it astray") {
        TemporaryFolder folder;
        write_file_atomically(folder / "f", "x");
        for (mode_t mode : {0600u, 0644u, 0660u}) {
            ::chmod((folder / "f").c_str(), mode);
            write_file_atomically(folder / "f", "y");
            struct stat file = {};
            REQUIRE(::stat((folder / "f").c_str(), &file) == 0);
            CHECK((file.st_mode & 0777) == mode);
        }
        // The name that could once be guessed.
        write_file_atomically(folder / "precious", "p");
        fs::create_symlink("precious", folder / "f.part." + std::to_string(::getpid()));
        write_file_atomically(folder / "f", "z");
        CHECK(read_file(folder / "precious") == "p");
        CHECK(read_file(folder / "f") == "z");
    }
}
