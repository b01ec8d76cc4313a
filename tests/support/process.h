// Helpers of the tests: programs of the chapters and other processes that run beside the test, and
// what they print.
#pragma once
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#ifndef _WIN32
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#endif

#include "common/base/files.h"
#include "common/base/system.h"
#include "common/base/text.h"
#include "tests/support/folder.h"

/// The folder of the test binary, which main() sets: the programs are there too.
inline std::filesystem::path program_folder;

std::string program_file(const std::string& name);

/// The words that start a program: first those of $RUN, such as an emulator of its processor.
std::vector<std::string> program_words(const std::string& name);

/// How a process ended: its exit code, or -1 after a signal; and the seconds of processor time that
/// it took, which do not depend on what else the machine does.
struct Finished {
    int code = -1, signal = 0;
    double seconds = 0;
    std::string out, err;
};

/// Does `work` in this process, and returns what it prints and returns.
template <typename Work>
Finished captured(const Work& work) {
    TemporaryFolder folder;
    struct Redirected {
        Redirected(int stream, const std::string& name) : stream_(stream), before_(::dup(stream)) {
            std::fflush(nullptr);
            std::FILE* file = std::fopen(name.c_str(), "wb");
            ::dup2(::fileno(file), stream);
            std::fclose(file);
        }
        ~Redirected() {
            std::fflush(nullptr);
            ::dup2(before_, stream_);
            ::close(before_);
        }
        int stream_, before_;
    };
    Finished end;
    {
        Redirected out(STDOUT_FILENO, folder / "out"), err(STDERR_FILENO, folder / "err");
        end.code = work();
    }
    end.out = read_file(folder / "out");
    end.err = read_file(folder / "err");
    return end;
}

#ifdef _WIN32

constexpr int SIGKILL = 9;

/// A program that runs, with the words of its command line.
class Process {
public:
    explicit Process(const std::vector<std::string>& words);
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    void kill(int signal);
    Finished wait();

private:
    TemporaryFolder folder_;
    void* handle_ = nullptr;
    int killed_by_ = 0;
};

#else

/// Of the processors, in s: what getrusage() or wait4() counted.
inline double processor_seconds(const rusage& used) {
    double microseconds =
        static_cast<double>(used.ru_utime.tv_usec) + static_cast<double>(used.ru_stime.tv_usec);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1e-6 * microseconds;
}

/// Becomes the program.
int execute_words(std::vector<std::string> words);

/// A program that runs, with the words of its command line; or, in tests/damage, a process that
/// does `work` and exits with what it returns.
class Process {
public:
    explicit Process(const std::vector<std::string>& words);
    explicit Process(const std::function<int()>& work);
    ~Process();
    void kill(int signal) { ::kill(id_, signal); }
    Finished wait();

private:
    TemporaryFolder folder_;
    pid_t id_ = 0;
};

#endif

using Words = std::vector<std::string>;

inline const std::string spheres = "scenes/cornell-spheres.pbrt";
inline const std::string path_tracer = "07_path_tracing", light_tracer = "20_light_tracing";

inline void append(Words& words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
}
inline Words with_words(const std::string& program, const Words& words) {
    Words all = program_words(program);
    append(all, words);
    return all;
}

#ifndef _WIN32
/// Becomes the program.
inline int execute(const std::string& program, const Words& words) {
    return execute_words(with_words(program, words));
}
#endif

inline Process start(const std::string& program, const Words& words) {
    return Process(with_words(program, words));
}
inline Finished run(const std::string& program, const Words& words) {
    return start(program, words).wait();
}

/// The programs of the chapters; those that render a scene, or those that print a table.
std::vector<std::string> programs(bool render);

/// Waits until the file has its first content, which comes after its lock.
bool comes_to_be(const std::string& path);

/// Options for a render of a few milliseconds.
inline Words brief(const std::string& scene, const Words& more) {
    Words words = {scene, "--size", "16x16", "--spp", "2", "--max-depth", "3", "--quiet"};
    append(words, more);
    return words;
}

/// For programs that trace photons: few, since these take most of the time of a brief render.
inline Words few_photons(const std::string& program) {
    bool photons = program.find("photon") != std::string::npos;
    return photons ? Words{"--photons", "2000"} : Words{};
}

/// A JSON object of one level.
struct StatsFile {
    std::string json;

    /// The number of that name; nothing where it is null or missing.
    std::optional<double> number(const std::string& name) const {
        size_t at = json.find("\"" + name + "\": ");
        if (at == std::string::npos) return {};
        std::string rest = json.substr(at + name.size() + 4);
        return to_number(rest.substr(0, rest.find_first_of(",\n}")));
    }
};
