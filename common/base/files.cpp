#include "common/base/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/position.h"

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
    throw InputError(printable(path + ": error: " + what + ": " + std::strerror(error)));
}

// Writes everything and closes; 0, or the errno of the step that failed.
int write_and_close(int fd, std::string_view bytes) {
    int error = 0;
    while (!bytes.empty() && error == 0) {
        ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n >= 0) {
            bytes.remove_prefix(static_cast<size_t>(n));
        } else if (errno != EINTR) {
            error = errno;
        }
    }
    if (::close(fd) != 0 && error == 0) error = errno;
    return error;
}

// A device or a pipe: it cannot be replaced, only written to.
bool is_device(const std::string& path) {
    std::error_code none;
    fs::file_status status = fs::status(path, none);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

// The file that `path` names after its links, so that it is replaced and not the link. The last
// one may name a file that does not exist yet.
std::string follow_links(const std::string& path) {
    fs::path file = path;
    std::error_code none;
    for (int links = 0; fs::is_symlink(file, none); links++) {
        if (links == 40) fail(path, "cannot write", ELOOP);
        file = file.parent_path() / fs::read_symlink(file, none);
    }
    return file.string();
}

std::string temporary_beside(const std::string& target) {
    return target + ".part." + std::to_string(::getpid());
}

// Opens the new file beside `target`.
int open_temporary(const std::string& path, const std::string& target) {
    std::error_code none;
    if (fs::is_directory(target, none)) fail(path, "cannot write", EISDIR);
    int fd =
        ::open(temporary_beside(target).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) fail(path, "cannot write", errno);
    return fd;
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view bytes) {
    if (is_device(path)) {
        int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
        if (fd < 0) fail(path, "cannot write", errno);
        if (int error = write_and_close(fd, bytes)) fail(path, "cannot write", error);
        return;
    }
    std::string target = follow_links(path), temporary = temporary_beside(target);
    int error = write_and_close(open_temporary(path, target), bytes);
    if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
    if (error != 0) {
        ::unlink(temporary.c_str());
        fail(path, "cannot write", error);
    }
}

void check_writable(const std::string& path) {
    if (is_device(path)) {
        if (::access(path.c_str(), W_OK) != 0) fail(path, "cannot write", errno);
        return;
    }
    std::string target = follow_links(path);
    ::close(open_temporary(path, target));
    ::unlink(temporary_beside(target).c_str());
}

bool same_file(const std::string& a, const std::string& b) {
    std::error_code none;
    fs::path x = fs::absolute(follow_links(a), none), y = fs::absolute(follow_links(b), none);
    return x.filename() == y.filename() && fs::equivalent(x.parent_path(), y.parent_path(), none);
}

void check_outputs(const std::vector<std::string>& files, const std::string& input) {
    for (size_t i = 0; i < files.size(); i++) {
        std::error_code none;  // check_writable reports it
        if (files[i].starts_with("out/")) fs::create_directories("out", none);
        if (same_file(files[i], input)) {
            throw UsageError("error: '" + files[i] + "' is the input, and would be overwritten");
        }
        for (size_t j = 0; j < i; j++) {
            if (!same_file(files[i], files[j])) continue;
            throw UsageError("error: '" + files[j] + "' and '" + files[i] + "' are one file");
        }
        check_writable(files[i]);
    }
}

std::string read_file(const std::string& path) {
    std::error_code none;
    if (fs::is_directory(path, none)) fail(path, "cannot read", EISDIR);
    constexpr size_t largest = size_t{1} << 30;
    bool too_large = fs::is_regular_file(path, none) && fs::file_size(path, none) > largest;
    if (too_large) throw InputError(path + ": error: larger than 1 GiB");
    int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) fail(path, "cannot read", errno);

    // Read in pieces, since a pipe has no size to ask for.
    std::string bytes, piece(1 << 16, '\0');
    ssize_t n = 0;
    do {
        n = ::read(fd, piece.data(), piece.size());
        if (n > 0) bytes.append(piece, 0, static_cast<size_t>(n));
    } while ((n > 0 && bytes.size() <= largest) || (n < 0 && errno == EINTR));
    int error = n < 0 ? errno : 0;
    ::close(fd);
    if (error != 0) fail(path, "cannot read", error);
    if (bytes.size() > largest) throw InputError(path + ": error: larger than 1 GiB");
    return bytes;
}
