#include "common/base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>

#include "common/base/error.h"
#include "common/base/position.h"

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
    throw InputError(printable(path + ": error: " + what + ": " + std::strerror(error)));
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

// A name beside `target` that nobody can guess; short enough, however long that of the target is.
std::string name_beside(const std::string& target) {
    constexpr size_t longest = 200;
    constexpr const char* letters = "abcdefghijklmnopqrstuvwxyz234567";
    fs::path file = target;
    std::random_device random;
    std::string name = file.filename().string().substr(0, longest) + ".part-";
    for (int i = 0; i < 12; i++) name += letters[random() % 32];
    return file.replace_filename(name).string();
}

}  // namespace

NewFile::NewFile(const std::string& path) : path_(path) {
    if (is_device(path)) {
        fd_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
        if (fd_ < 0) fail(path, "cannot write", errno);
        return;
    }
    target_ = follow_links(path);
    struct stat old = {};
    bool is_there = ::stat(target_.c_str(), &old) == 0;
    if (is_there && S_ISDIR(old.st_mode)) fail(path, "cannot write", EISDIR);
    if (!is_there && errno == ENAMETOOLONG) fail(path, "cannot write", errno);
    for (int tries = 0; fd_ < 0 && (tries == 0 || (errno == EEXIST && tries < 10)); tries++) {
        temporary_ = name_beside(target_);
        // O_EXCL: a file of its own, never one that is there, nor one that a link names.
        fd_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (fd_ < 0) {
        temporary_.clear();
        fail(path, "cannot write", errno);
    }
    if (is_there) (void)!::fchmod(fd_, old.st_mode & 07777);  // some file systems have no modes
}

NewFile::~NewFile() {
    if (fd_ >= 0) ::close(fd_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void NewFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        ssize_t n = ::write(fd_, bytes.data(), bytes.size());
        if (n < 0 && errno != EINTR) fail(path_, "cannot write", errno);
        if (n > 0) bytes.remove_prefix(static_cast<size_t>(n));
    }
}

void NewFile::write_through() {
    // A device, and some file systems, cannot.
    if (::fsync(fd_) != 0 && errno != EINVAL && errno != ENOTSUP) {
        fail(path_, "cannot write", errno);
    }
}

void NewFile::commit() {
    int fd = std::exchange(fd_, -1);
    if (::close(fd) != 0) fail(path_, "cannot write", errno);
    if (temporary_.empty()) return;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(path_, "cannot write", errno);
    temporary_.clear();
}

void write_file_atomically(const std::string& path, std::string_view bytes) {
    NewFile file(path);
    file.write(bytes);
    file.commit();
}

void check_writable(const std::string& path) {
    if (!is_device(path)) {
        NewFile never_committed(path);
    } else if (::access(path.c_str(), W_OK) != 0) {
        fail(path, "cannot write", errno);
    }
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
