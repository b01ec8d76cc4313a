#include "common/base/system.h"

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <system_error>

namespace fs = std::filesystem;

fs::path file_path(const std::string& name) { return std::u8string(name.begin(), name.end()); }
std::string file_name(const fs::path& path) {
    std::u8string name = path.generic_u8string();
    return {name.begin(), name.end()};
}

static std::atomic<bool> are_caught = false;
static std::atomic<int64_t> first_times[NSIG];  // ns, of the first signal of each kind; 0: none
static_assert(std::atomic<int64_t>::is_always_lock_free);  // or a handler must not touch it

/// Ends the program as the signal does where nobody handles it.
static void end_by_signal(int signal);

static void request_stop(int signal) {
    constexpr int64_t second = 1'000'000'000;  // ns
    int before = errno;
    std::chrono::nanoseconds time = std::chrono::steady_clock::now().time_since_epoch();
    int64_t now = time.count(), first = 0;
    bool again = !first_times[signal].compare_exchange_strong(first, now);
    if (again && now - first > second / 2) return end_by_signal(signal);
    stop_requested = true;
    std::signal(signal, request_stop);  // some systems call it once
    errno = before;
}

void catch_stop_signals() {
    stop_requested = false;
    for (int signal : stop_signals) {
        first_times[signal] = 0;
        if (std::signal(signal, request_stop) == SIG_IGN) std::signal(signal, SIG_IGN);
    }
    are_caught = true;
}
void release_stop_signals() {
    are_caught = false;
    for (int signal : stop_signals)
        if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

#ifdef _WIN32

#define WIN32_LEAN_AND_MEAN
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <deque>

static constexpr UINT ended_by_signal = 0xc000013a;

// The system removes the file when this process ends, in whatever way.
int lock_file(const std::string& name) {
    HANDLE handle = CreateFileW(file_path(name).c_str(), GENERIC_WRITE, 0, nullptr, OPEN_ALWAYS,
                                FILE_FLAG_DELETE_ON_CLOSE, nullptr);
    if (handle != INVALID_HANDLE_VALUE)
        return _open_osfhandle(reinterpret_cast<intptr_t>(handle), _O_BINARY | _O_NOINHERIT);
    std::error_code error(static_cast<int>(GetLastError()), std::system_category());
    bool is_locked = error.value() == ERROR_SHARING_VIOLATION;
    errno = is_locked ? EWOULDBLOCK : error.default_error_condition().value();
    return -1;
}
void unlock_file(int lock, const std::string&) { _close(lock); }

fs::path own_file(const std::string&) {
    std::wstring name(32768, L'\0');  // the longest that there is
    DWORD length = GetModuleFileNameW(nullptr, name.data(), static_cast<DWORD>(name.size()));
    return fs::path(name.substr(0, length));
}

// Windows calls this in a thread of its own. When the window is closed or the user logs off, it
// ends the program when this returns, or 5 s later; so it waits until the work is done. The library
// may call the handler of Ctrl-C before this, as std::signal says.
static BOOL WINAPI console_event(DWORD event) {
    if (!are_caught) TerminateProcess(GetCurrentProcess(), ended_by_signal);
    bool is_key = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT;
    request_stop(!is_key ? SIGTERM : event == CTRL_C_EVENT ? SIGINT : SIGBREAK);
    for (int i = 0; i < 45 && !is_key && are_caught; i++) Sleep(100);
    return TRUE;
}

static void end_by_signal(int) { TerminateProcess(GetCurrentProcess(), ended_by_signal); }
void prepare_streams() {}

// Windows starts programs here: with words in UTF-16, which main() gets in UTF-8. The streams take
// bytes as they are, and a terminal shows them as UTF-8 and knows escape sequences.
int main(int, char**);
extern "C" int wmain(int argc, wchar_t** argv);
extern "C" int wmain(int argc, wchar_t** argv) {
    for (FILE* stream : {stdin, stdout, stderr}) _setmode(_fileno(stream), _O_BINARY);
    SetConsoleCtrlHandler(console_event, TRUE);
    SetConsoleOutputCP(CP_UTF8);
    HANDLE terminal = GetStdHandle(STD_ERROR_HANDLE);
    if (DWORD mode = 0; GetConsoleMode(terminal, &mode))
        SetConsoleMode(terminal, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
    std::deque<std::string> words;
    std::vector<char*> pointers;
    for (int i = 0; i < argc; i++)
        pointers.push_back(words.emplace_back(file_name(argv[i])).data());
    pointers.push_back(nullptr);
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
    return main(argc, pointers.data());
#pragma GCC diagnostic pop
}

#else

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

int lock_file(const std::string& name) {
    int file = ::open(name.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0) return -1;
    // Some file systems have no locks.
    bool is_locked = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    // Another program may have removed the file between the two.
    struct stat opened = {}, named = {};
    bool is_there = ::fstat(file, &opened) == 0 && ::stat(name.c_str(), &named) == 0 &&
                    opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
    if (is_there && !is_locked) return file;
    ::close(file);
    errno = EWOULDBLOCK;
    return -1;
}
void unlock_file(int lock, const std::string& name) {
    ::unlink(name.c_str());
    ::close(lock);
}

fs::path own_file(const std::string& program) {
    std::error_code none;
    return fs::canonical(program, none);
}

void prepare_streams() {
    for (int fd = 0; fd <= 2; fd++) {
        if (::fcntl(fd, F_GETFD) == -1) ::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
    }
    // Writing beyond a file size limit, or to a closed pipe.
    for (int signal : {SIGXFSZ, SIGPIPE}) std::signal(signal, SIG_IGN);
    // What is printed waits for the end, when all files are written.
    static char buffer[1 << 16];
    std::setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
}

static void end_by_signal(int signal) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

#endif
