#include "tests/support/process.h"

std::string program_file(const std::string& name) { return file_name(program_folder / name); }

std::vector<std::string> program_words(const std::string& name) {
#ifdef _WIN32
    return {program_file(name + ".exe")};  // an emulator of Windows runs this process, too
#else
    const char* run = std::getenv("RUN");
    std::istringstream text(run != nullptr ? run : "");
    std::vector<std::string> words;
    for (std::string word; text >> word;) words.push_back(word);
    words.push_back(program_file(name));
    return words;
#endif
}

#ifndef _WIN32

int execute_words(std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execvp(argv[0], argv.data());
    return 127;
}

Process::Process(const std::vector<std::string>& words)
    : Process([&] { return execute_words(words); }) {}

Process::Process(const std::function<int()>& work) {
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
        for (int signal : stop_signals) std::signal(signal, SIG_DFL);
        ::sigprocmask(SIG_SETMASK, &before, nullptr);
        std::freopen((folder_ / "out").c_str(), "w", stdout);
        std::freopen((folder_ / "err").c_str(), "w", stderr);
        int code = work();
        std::fflush(nullptr);
        ::_exit(code);
    }
}

Process::~Process() {
    if (id_ > 0) kill(SIGKILL), wait();
}

Finished Process::wait() {
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
    // So that make check sees it.
    if (end.err.find("is not written yet") != std::string::npos)
        std::fputs(end.err.c_str(), stderr);
    return end;
}

#endif

std::vector<std::string> programs(bool render) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator("chapters")) {
        if (!entry.is_directory()) continue;
        std::string name = file_name(entry.path().filename());
        if (name == "06_bvh") continue;        // draws work instead of light: has tests of its own
        if (name == "26_radiosity") continue;  // renders no mirrors: has its own
        std::string help = run(name, {"--help"}).out;
        if ((help.find("[SCENE]") != std::string::npos) == render) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    REQUIRE(!names.empty());
    return names;
}

bool comes_to_be(const std::string& path) {
    std::error_code none;
    auto has_content = [&] {
        return std::filesystem::file_size(file_path(path), none) > 0 && !none;
    };
    for (int i = 0; i < 20000 && !has_content(); i++) ::usleep(1000);
    return has_content();
}
