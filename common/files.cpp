#include "common/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/error.h"

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
    throw InputError(path + ": error: " + what + ": " + std::strerror(error));
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

}  // namespace

void write_file_atomically(const std::string& path, std::string_view bytes) {
    std::error_code ignored;
    std::filesystem::file_status status = std::filesystem::status(path, ignored);
    if (std::filesystem::is_directory(status)) fail(path, "cannot write", EISDIR);

    // Write to a device or a pipe as it is: it cannot be replaced.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
        if (fd < 0) fail(path, "cannot write", errno);
        if (int error = write_and_close(fd, bytes)) fail(path, "cannot write", error);
        return;
    }

    // Follow a link, so that the file it names is replaced and not the link.
    std::string target = path;
    if (std::filesystem::is_symlink(path, ignored)) {
        target = std::filesystem::weakly_canonical(path, ignored).string();
    }
    std::string temporary = target + ".part." + std::to_string(::getpid());
    int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) fail(path, "cannot write", errno);
    int error = write_and_close(fd, bytes);
    if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
    if (error != 0) {
        ::unlink(temporary.c_str());
        fail(path, "cannot write", error);
    }
}

std::string read_file(const std::string& path) {
    std::error_code error;
    std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) fail(path, "cannot read", ENOENT);
    if (std::filesystem::is_directory(status)) fail(path, "cannot read", EISDIR);
    std::ifstream in(path, std::ios::binary);
    if (!in) fail(path, "cannot read", errno);

    // Read in pieces, since a pipe has no size to ask for.
    constexpr size_t largest = size_t{4} << 30;
    std::string bytes;
    std::string piece(1 << 20, '\0');
    while (in) {
        in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        bytes.append(piece, 0, static_cast<size_t>(in.gcount()));
        if (bytes.size() > largest) throw InputError(path + ": error: larger than 4 GiB");
    }
    return bytes;
}
