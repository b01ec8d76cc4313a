#include "common/base/system.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>

#include "common/base/error.h"

namespace fs = std::filesystem;

#ifdef _WIN32

#define WIN32_LEAN_AND_MEAN
#include <fcntl.h>
#include <io.h>
#include <locale.h>
#include <stdio.h>
#include <windows.h>

#include <atomic>
#include <deque>
#include <vector>

namespace {

std::wstring wide(const std::string& text) {
    if (text.empty()) return {};
    int bytes = static_cast<int>(text.size()),
        n = MultiByteToWideChar(CP_UTF8, 0, text.data(), bytes, nullptr, 0);
    std::wstring wide(static_cast<size_t>(n), L'\0');
    MultiByteToWideChar(CP_UTF8, 0, text.data(), bytes, wide.data(), n);
    return wide;
}

std::string utf8(const std::wstring& wide) {
    if (wide.empty()) return {};
    int units = static_cast<int>(wide.size()),
        n = WideCharToMultiByte(CP_UTF8, 0, wide.data(), units, nullptr, 0, nullptr, nullptr);
    std::string text(static_cast<size_t>(n), '\0');
    WideCharToMultiByte(CP_UTF8, 0, wide.data(), units, text.data(), n, nullptr, nullptr);
    return text;
}

// Says in errno why a call to Windows failed.
int failed() {
    std::error_code error(static_cast<int>(GetLastError()), std::system_category());
    bool in_use = error.value() == ERROR_SHARING_VIOLATION;
    bool known = error.default_error_condition().category() == std::generic_category();
    errno = in_use ? EACCES : known ? error.default_error_condition().value() : EINVAL;
    return -1;
}

int open_handle(const std::string& name, DWORD access, DWORD sharing, DWORD how) {
    HANDLE handle = CreateFileW(wide(name).c_str(), access, sharing, nullptr, how,
                                FILE_ATTRIBUTE_NORMAL, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return failed();
    return _open_osfhandle(reinterpret_cast<intptr_t>(handle), _O_BINARY | _O_NOINHERIT);
}

constexpr UINT ended_by_signal = 0xc000013a;
constexpr DWORD all_sharing = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

}  // namespace

fs::path file_path(const std::string& name) { return wide(name); }
std::string file_name(const fs::path& path) { return utf8(path.generic_wstring()); }

int open_file(const std::string& name) {
    return open_handle(name, GENERIC_READ, all_sharing, OPEN_EXISTING);
}
int open_device(const std::string& name) {
    return open_handle(name, GENERIC_WRITE, all_sharing, OPEN_EXISTING);
}
// Others may read it, but neither remove nor rename it: that needs DELETE, which is not shared.
int open_new_file(const std::string& name) {
    return open_handle(name, GENERIC_WRITE | DELETE, FILE_SHARE_READ, CREATE_NEW);
}
void close_file(int file) { _close(file); }

ptrdiff_t read_bytes(int file, void* to, size_t size) {
    return _read(file, to, static_cast<unsigned>(std::min<size_t>(size, 1 << 30)));
}
ptrdiff_t write_bytes(int file, const void* from, size_t size) {
    return _write(file, from, static_cast<unsigned>(std::min<size_t>(size, 1 << 30)));
}
uint64_t bytes_in(int file) { return static_cast<uint64_t>(_filelengthi64(file)); }
bool reach_disk(int file) { return _commit(file) == 0 || errno == EBADF; }  // as of a device
bool closes_well(int) { return true; }

bool is_device(const std::string& name) {
    HANDLE handle =
        CreateFileW(wide(name).c_str(), 0, all_sharing, nullptr, OPEN_EXISTING, 0, nullptr);
    if (handle == INVALID_HANDLE_VALUE) return false;
    bool on_disk = GetFileType(handle) == FILE_TYPE_DISK;
    CloseHandle(handle);
    return !on_disk;
}
bool takes_writes(const std::string&) { return true; }

// The system removes a file beside it when this process ends, in whatever way.
int lock_file(const std::string& name) {
    HANDLE handle = CreateFileW(wide(name + ".lock").c_str(), GENERIC_WRITE, 0, nullptr,
                                OPEN_ALWAYS, FILE_FLAG_DELETE_ON_CLOSE, nullptr);
    if (handle != INVALID_HANDLE_VALUE)
        return _open_osfhandle(reinterpret_cast<intptr_t>(handle), _O_BINARY | _O_NOINHERIT);
    bool is_locked = GetLastError() == ERROR_SHARING_VIOLATION;
    failed();
    if (is_locked) errno = EWOULDBLOCK;
    return -1;
}
void pass_lock(int&, int&) {}
void unlock_file(int lock, const std::string&) { close_file(lock); }

void remove_left_over(const std::string& name) { DeleteFileW(wide(name).c_str()); }
void copy_permissions(const std::string&, int) {}

std::string why_not_replaced(const std::string& name) {
    DWORD attributes = GetFileAttributesW(wide(name).c_str());
    bool is_file =
        attributes != INVALID_FILE_ATTRIBUTES && !(attributes & FILE_ATTRIBUTE_DIRECTORY);
    return is_file && (attributes & FILE_ATTRIBUTE_READONLY) ? "it is write-protected" : "";
}

bool rename_over(int file, const std::string&, const std::string& to) {
    std::wstring name = wide(to);
    size_t bytes = sizeof(FILE_RENAME_INFO) + name.size() * sizeof(wchar_t);
    std::vector<uint64_t> space(bytes / sizeof(uint64_t) + 1);  // aligned as the structure is
    auto* info = reinterpret_cast<FILE_RENAME_INFO*>(space.data());
    info->ReplaceIfExists = TRUE;
    info->FileNameLength = static_cast<DWORD>(name.size() * sizeof(wchar_t));
    std::memcpy(info->FileName, name.data(), info->FileNameLength);
    HANDLE handle = reinterpret_cast<HANDLE>(_get_osfhandle(file));
    for (int tries = 0; tries < 100; tries++) {
        if (SetFileInformationByHandle(handle, FileRenameInfo, info, static_cast<DWORD>(bytes)))
            return true;
        failed();
        if (errno != EACCES || fs::is_directory(fs::path(name))) break;
        Sleep(10);
    }
    return false;
}

std::string disk_of(const std::string& folder) {
    std::error_code none;
    return file_name(fs::absolute(file_path(folder), none).root_name());
}

fs::path own_file(const std::string&) {
    std::wstring name(32768, L'\0');  // the longest that there is
    DWORD length = GetModuleFileNameW(nullptr, name.data(), static_cast<DWORD>(name.size()));
    return fs::path(name.substr(0, length));
}

double plain_strtod(const char* text, char** end) {
    static const _locale_t plain = _create_locale(LC_ALL, "C");
    return _strtod_l(text, end, plain);
}

namespace {

std::vector<void (*)(int)> handlers_before(stop_signals.size());
std::atomic<void (*)(int)> caught_by = nullptr;

// Windows calls this in a thread of its own. When the window is closed or the user logs off, it
// ends the program when this returns, or 5 s later; so it waits until the work is done. The library
// may call the handler of Ctrl-C before this, as std::signal says.
BOOL WINAPI console_event(DWORD event) {
    void (*handler)(int) = caught_by;
    if (handler == nullptr) TerminateProcess(GetCurrentProcess(), ended_by_signal);
    bool is_key = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT;
    handler(!is_key ? SIGTERM : event == CTRL_C_EVENT ? SIGINT : SIGBREAK);
    for (int i = 0; i < 45 && !is_key && caught_by != nullptr; i++) Sleep(100);
    return TRUE;
}

}  // namespace

void catch_stop_signals(void (*handler)(int)) {
    for (size_t i = 0; i < stop_signals.size(); i++) {
        handlers_before[i] = std::signal(stop_signals[i], handler);
        if (handlers_before[i] == SIG_IGN) std::signal(stop_signals[i], SIG_IGN);
    }
    caught_by = handler;
}
void release_stop_signals() {
    caught_by = nullptr;
    for (size_t i = 0; i < stop_signals.size(); i++)
        std::signal(stop_signals[i], handlers_before[i]);
}
void keep_catching(int signal, void (*handler)(int)) { std::signal(signal, handler); }
void end_by_signal(int) { TerminateProcess(GetCurrentProcess(), ended_by_signal); }
std::vector<int> all_stop_signals() { return {SIGINT, SIGTERM, SIGBREAK}; }

void prepare_streams() {}
size_t write_at_once(std::string_view text) {
    return std::fwrite(text.data(), 1, text.size(), stderr);
}

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
    for (int i = 0; i < argc; i++) pointers.push_back(words.emplace_back(utf8(argv[i])).data());
    pointers.push_back(nullptr);
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
    return main(argc, pointers.data());
#pragma GCC diagnostic pop
}

#else

#include <fcntl.h>
#include <limits.h>
#include <locale.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

fs::path file_path(const std::string& name) { return name; }
std::string file_name(const fs::path& path) { return path.string(); }

int open_file(const std::string& name) { return ::open(name.c_str(), O_RDONLY | O_CLOEXEC); }
int open_device(const std::string& name) { return ::open(name.c_str(), O_WRONLY | O_CLOEXEC); }
int open_new_file(const std::string& name) {
    // O_EXCL: a file of its own, never one that is there, nor one that a link names.
    int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return -1;
    // The lock says to other runs that the file is being written. One of them may have taken it for
    // a left over one before that. Some file systems have no locks.
    bool locked = ::flock(file, LOCK_EX | LOCK_NB) == 0;
    struct stat status = {};
    bool is_ours =
        locked ? ::fstat(file, &status) == 0 && status.st_nlink > 0 : errno != EWOULDBLOCK;
    if (is_ours) return file;
    ::close(file);
    errno = EEXIST;
    return -1;
}
void close_file(int file) { ::close(file); }

ptrdiff_t read_bytes(int file, void* to, size_t size) {
    ssize_t n = 0;
    do n = ::read(file, to, size);
    while (n < 0 && errno == EINTR);
    return n;
}
ptrdiff_t write_bytes(int file, const void* from, size_t size) {
    ssize_t n = 0;
    do n = ::write(file, from, size);
    while (n < 0 && errno == EINTR);
    return n;
}
uint64_t bytes_in(int file) {
    struct stat status = {};
    return ::fstat(file, &status) == 0 ? static_cast<uint64_t>(status.st_size) : 0;
}
bool reach_disk(int file) {
    return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP;  // as of a device
}
bool closes_well(int file) {
    int copy = ::dup(file);
    return copy >= 0 && ::close(copy) == 0;
}

bool is_device(const std::string& name) {
    std::error_code none;
    fs::file_status status = fs::status(name, none);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}
bool takes_writes(const std::string& device) { return ::access(device.c_str(), W_OK) == 0; }

int lock_file(const std::string& name) {
    for (;;) {
        int file = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file < 0) return -1;
        bool is_locked = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
        // Another program may have put its new one in the place of this one before the lock.
        struct stat opened = {}, named = {};
        bool is_there = ::fstat(file, &opened) == 0 && ::stat(name.c_str(), &named) == 0 &&
                        opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
        if (is_there && !is_locked) return file;
        ::close(file);
        errno = EWOULDBLOCK;
        if (is_locked) return -1;
    }
}
void pass_lock(int& lock, int& file) { std::swap(lock, file); }
void unlock_file(int lock, const std::string& name) {
    // By name: in a page the size of a file that was renamed while it was open is not known.
    struct stat status = {};
    if (::stat(name.c_str(), &status) == 0 && status.st_size == 0) ::unlink(name.c_str());
    ::close(lock);
}

// Its writer would hold its lock. While this has the lock itself, so that a writer that comes to
// lock it then sees that it is gone.
void remove_left_over(const std::string& name) {
    int file = ::open(name.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return;
    struct stat status = {};
    bool ours =
        ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
    if (ours && ::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(name.c_str());
    ::close(file);
}

void copy_permissions(const std::string& name, int file) {
    struct stat old = {};
    if (::stat(name.c_str(), &old) != 0) return;
    (void)!::fchmod(file, old.st_mode & 07777);  // some file systems have no modes
}

std::string why_not_replaced(const std::string& name) {
    struct stat old = {};
    if (::lstat(name.c_str(), &old) != 0 || !S_ISREG(old.st_mode)) return "";
    // Root may do everything, and yet a write-protected file is meant to stay.
    if ((old.st_mode & 0222) == 0) return "it is write-protected";
    if (::access(name.c_str(), W_OK) != 0) return std::strerror(errno);
    // A file is no folder, so this fails; but first the system looks whether the name may be taken
    // from its folder. It may not where the folder is sticky and the file another user's.
    if (::rmdir(name.c_str()) != 0 && (errno == EPERM || errno == EACCES || errno == EROFS))
        return std::strerror(errno);
#ifdef STATX_ATTR_MOUNT_ROOT
    struct statx more = {};
    bool known = ::statx(AT_FDCWD, name.c_str(), AT_SYMLINK_NOFOLLOW, 0, &more) == 0;
    if (known && (more.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0) return std::strerror(EBUSY);
#endif
    return "";
}

bool rename_over(int, const std::string& from, const std::string& to) {
    return ::rename(from.c_str(), to.c_str()) == 0;
}

std::string disk_of(const std::string& folder) {
    struct stat status = {};
    return ::stat(folder.c_str(), &status) == 0 ? std::to_string(status.st_dev) : "";
}

fs::path own_file(const std::string& program) {
    std::error_code none;
    if (program.find('/') != std::string::npos) return fs::canonical(program, none);
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        fs::path file = fs::path(folder.empty() ? "." : folder) / program;
        bool runs = ::access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file, none);
        if (runs) return fs::canonical(file, none);
    }
    return {};
}

double plain_strtod(const char* text, char** end) {
    static const locale_t plain = ::newlocale(LC_ALL_MASK, "C", locale_t{});
    return ::strtod_l(text, end, plain);
}

void prepare_streams() {
    constexpr rlim_t least_stack = 128 << 10;  // bytes
    for (int fd = 0; fd <= 2; fd++) {
        if (::fcntl(fd, F_GETFD) == -1) ::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
    }
    // Writing beyond a file size limit, or to a closed pipe.
    for (int signal : {SIGXFSZ, SIGPIPE}) std::signal(signal, SIG_IGN);
    rlimit stack = {};
    bool is_known = ::getrlimit(RLIMIT_STACK, &stack) == 0;
    if (is_known && stack.rlim_cur < least_stack)
        throw InputError("error: out of memory: the stack needs " + megabytes(least_stack));
    // What is printed waits for the end, when all files are written.
    static char buffer[1 << 16];
    std::setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
    // At the limit of time the system kills; so ask for a signal before it, to save in time.
    rlimit time = {};
    if (::getrlimit(RLIMIT_CPU, &time) != 0 || time.rlim_max == RLIM_INFINITY) return;
    rlim_t before = std::clamp<rlim_t>(time.rlim_max / 5, 1, 30);  // s
    time.rlim_cur = std::min(time.rlim_cur, time.rlim_max - before);
    ::setrlimit(RLIMIT_CPU, &time);
}

size_t write_at_once(std::string_view text) {
    struct stat status = {};
    bool is_file = ::fstat(STDERR_FILENO, &status) == 0 && S_ISREG(status.st_mode);
    // Opened once more, so that only this does not wait: other programs share stderr.
    const char* name = ::isatty(STDERR_FILENO) ? ::ttyname(STDERR_FILENO) : "/dev/fd/2";
    int flags = O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
    int opened = is_file || name == nullptr ? -1 : ::open(name, flags);
    bool never_waits = opened >= 0 && (::fcntl(opened, F_GETFL) & O_NONBLOCK) != 0;
    pollfd to = {opened >= 0 ? opened : STDERR_FILENO, POLLOUT, 0};
    ssize_t n = 0;
    if (is_file || never_waits) {
        n = ::write(to.fd, text.data(), text.size());
    } else if (::poll(&to, 1, 0) == 1 && to.revents == POLLOUT) {
        n = ::write(to.fd, text.data(), std::min<size_t>(text.size(), _POSIX_PIPE_BUF));
    }
    if (opened >= 0) ::close(opened);
    return static_cast<size_t>(std::max<ssize_t>(n, 0));
}

std::vector<int> all_stop_signals() {
    std::vector<int> all = {SIGHUP,  SIGINT,  SIGQUIT, SIGTERM,   SIGALRM,
                            SIGUSR1, SIGUSR2, SIGXCPU, SIGVTALRM, SIGPROF};
#ifdef __linux__
    all.insert(all.end(), {SIGIO, SIGPWR, SIGSTKFLT});
    for (int signal = SIGRTMIN; signal <= SIGRTMAX; signal++) all.push_back(signal);
#endif
    return all;
}

static std::vector<struct sigaction> actions_before(stop_signals.size());

void catch_stop_signals(void (*handler)(int)) {
    struct sigaction stop {};
    stop.sa_handler = handler;
    stop.sa_flags = SA_RESTART;
    for (size_t i = 0; i < stop_signals.size(); i++) {
        ::sigaction(stop_signals[i], nullptr, &actions_before[i]);
        if (actions_before[i].sa_handler == SIG_IGN) continue;
        ::sigaction(stop_signals[i], &stop, nullptr);
    }
}
void release_stop_signals() {
    for (size_t i = 0; i < stop_signals.size(); i++)
        ::sigaction(stop_signals[i], &actions_before[i], nullptr);
}
void keep_catching(int, void (*)(int)) {}
void end_by_signal(int signal) {
    if (signal == SIGXCPU) return;  // comes every second; the system ends the program by another
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

#endif
