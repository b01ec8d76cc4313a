// The one test binary: doctest's main, but names of tests may hold commas, and to run no test is an
// error.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#ifdef _WIN32
#include <windows.h>
#undef far
#undef near
#endif

#include <utility>

#include "tests/support/process.h"
#include "tests/support/seal.h"

namespace {

bool ran_none = false;

#ifdef _WIN32
/// A word as the programs that are started take it from their command line.
std::wstring quoted(const std::wstring& word) {
    std::wstring text = L"\"";
    size_t slashes = 0;  // those before a quote count twice
    for (wchar_t c : word) {
        if (c == L'"') text.append(slashes + 1, L'\\');
        slashes = c == L'\\' ? slashes + 1 : 0;
        text += c;
    }
    return text.append(slashes, L'\\') + L'"';
}
#endif

struct Reporter : doctest::ConsoleReporter {
    explicit Reporter(const doctest::ContextOptions& options) : ConsoleReporter(options) {}
    void test_run_end(const doctest::TestRunStats& stats) override {
        ConsoleReporter::test_run_end(stats);
        ran_none = stats.numTestCasesPassingFilters == 0;
        if (ran_none) std::fprintf(stderr, "error: no test has this name\n");
    }
};

/// doctest takes a comma for the end of a name, unless a backslash stands before it.
std::string escape_commas(std::string word) {
    if (!word.starts_with("--test-case=")) return word;
    for (size_t at = 0; (at = word.find(',', at)) != std::string::npos; at += 2) {
        word.insert(at, 1, '\\');
    }
    return word;
}

}  // namespace

#ifdef _WIN32
Process::Process(const std::vector<std::string>& words) {
    std::wstring line;
    for (const std::string& word : words) line += quoted(file_path(word).native()) + L' ';
    STARTUPINFOW info = {};
    info.cb = sizeof info;
    info.dwFlags = STARTF_USESTDHANDLES;
    SECURITY_ATTRIBUTES handed_on = {sizeof handed_on, nullptr, TRUE};
    auto stream = [&](const char* name) {
        return CreateFileW(file_path(folder_ / name).c_str(), GENERIC_WRITE, FILE_SHARE_READ,
                           &handed_on, CREATE_ALWAYS, FILE_ATTRIBUTE_NORMAL, nullptr);
    };
    info.hStdInput = GetStdHandle(STD_INPUT_HANDLE);
    info.hStdOutput = stream("out"), info.hStdError = stream("err");
    PROCESS_INFORMATION started = {};
    if (CreateProcessW(nullptr, line.data(), nullptr, nullptr, TRUE, 0, nullptr, nullptr, &info,
                       &started)) {
        handle_ = started.hProcess;
        CloseHandle(started.hThread);
    }
    CloseHandle(info.hStdOutput), CloseHandle(info.hStdError);
}

Process::~Process() {
    if (handle_ != nullptr) kill(SIGKILL), wait();
}

// Signals as the terminal sends them: in the process, a thread calls the handlers.
void Process::kill(int signal) {
    killed_by_ = signal;
    if (signal == SIGKILL) {
        TerminateProcess(handle_, 1);
        return;
    }
    Sleep(1000);  // where it has just been started, it has no handlers yet
    auto send = reinterpret_cast<LPTHREAD_START_ROUTINE>(reinterpret_cast<void*>(
        GetProcAddress(GetModuleHandleW(L"kernelbase.dll"), "CtrlRoutine")));
    uintptr_t event = signal == SIGINT ? CTRL_C_EVENT : CTRL_BREAK_EVENT;
    HANDLE thread =
        CreateRemoteThread(handle_, nullptr, 0, send, reinterpret_cast<void*>(event), 0, nullptr);
    if (thread != nullptr) CloseHandle(thread);
}

Finished Process::wait() {
    Finished end;
    if (handle_ == nullptr) return end;
    WaitForSingleObject(handle_, INFINITE);
    DWORD code = 0;
    GetExitCodeProcess(handle_, &code);
    constexpr DWORD ended_by_signal = 0xc000013a;
    bool by_signal = killed_by_ == SIGKILL || code == ended_by_signal;
    end.code = by_signal ? -1 : static_cast<int>(code);
    end.signal = by_signal ? killed_by_ : 0;
    CloseHandle(std::exchange(handle_, nullptr));
    end.out = read_file(folder_ / "out");
    end.err = read_file(folder_ / "err");
    return end;
}
#endif

REGISTER_REPORTER("tests", 1, Reporter);

int main(int argc, char** argv) {
    program_folder = file_path(argv[0]).parent_path();
    std::vector<std::string> words = {argv[0], "--reporters=tests"};
    for (int i = 1; i < argc; i++) words.push_back(escape_commas(argv[i]));
    std::vector<const char*> pointers;
    for (const std::string& word : words) pointers.push_back(word.c_str());
    int result = doctest::Context(static_cast<int>(pointers.size()), pointers.data()).run();
    return seal(ran_none ? 1 : result);
}
