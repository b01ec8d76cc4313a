// Helper of the tests that need a process of its own: what it prints and how it ends.
#pragma once
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "common/base/files.h"
#include "tests/support/folder.h"

/// How a process ended: its exit code, or -1 after a signal; and the seconds of processor time that
/// it took, which do not depend on what else the machine does.
struct Finished {
    int code = -1, signal = 0;
    double seconds = 0;
    std::string out, err;
};

/// Of the processors, in s: what getrusage() or wait4() counted.
inline double processor_seconds(const rusage& used) {
    double microseconds =
        static_cast<double>(used.ru_utime.tv_usec) + static_cast<double>(used.ru_stime.tv_usec);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1e-6 * microseconds;
}

/// A process that does `work` and exits with what it returns.
class Process {
public:
    template <typename Work>
    explicit Process(const Work& work) {
        std::fflush(nullptr);
        for (const char* name : {"out", "err"}) write_file_atomically(folder_ / name, "");
        // A signal that comes early waits until it is the child's own, not doctest's.
        sigset_t all, before;
        ::sigfillset(&all);
        ::sigprocmask(SIG_BLOCK, &all, &before);
        id_ = ::fork();
        if (id_ != 0) ::sigprocmask(SIG_SETMASK, &before, nullptr);
        if (id_ == 0) {
            rlimit none = {0, 0};
            ::setrlimit(RLIMIT_CORE, &none);
            for (int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
            ::sigprocmask(SIG_SETMASK, &before, nullptr);
            std::freopen((folder_ / "out").c_str(), "w", stdout);
            std::freopen((folder_ / "err").c_str(), "w", stderr);
            int code = work();
            std::fflush(nullptr);
            ::_exit(code);
        }
    }
    ~Process() {
        if (id_ > 0) kill(SIGKILL), wait();
    }
    void kill(int signal) const { ::kill(id_, signal); }
    Finished wait() {
        int status = 0;
        rusage used = {};
        while (::wait4(id_, &status, 0, &used) < 0 && errno == EINTR) {
        }
        id_ = 0;
        Finished end;
        end.seconds = processor_seconds(used);
        if (WIFEXITED(status)) end.code = WEXITSTATUS(status);
        if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
        end.out = read_file(folder_ / "out");
        end.err = read_file(folder_ / "err");
        return end;
    }

private:
    TemporaryFolder folder_;
    pid_t id_ = 0;
};
