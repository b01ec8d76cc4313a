#include "common/base/files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>
#include <utility>

#include "common/base/error.h"
#include "common/base/position.h"

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
    throw InputError(printable(path + ": error: " + what + ": " + std::strerror(error)));
}

constexpr const char* letters = "abcdefghijklmnopqrstuvwxyz234567";
constexpr size_t fresh_letters = 12;
constexpr const char* part_ending = ".part-";

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

fs::path folder_of(const std::string& file) {
    fs::path folder = fs::path(file).parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

// Letters that nobody can guess.
std::string random_letters() {
    std::random_device random;
    std::string text;
    for (size_t i = 0; i < fresh_letters; i++) text += letters[random() % 32];
    return text;
}

// The name of `target` with an ending; short enough, however long that of the target is.
std::string name_beside(const std::string& target, const std::string& ending) {
    constexpr size_t longest = 200;
    fs::path file = target;
    std::string name = file.filename().string().substr(0, longest) + ending;
    return file.replace_filename(name).string();
}

// Removes a file that this program has begun and writes no more: its writer would hold its lock.
// While it has the lock itself, so that a writer that comes to lock it then sees that it is gone.
void remove_if_left_over(const std::string& path) {
    int fd = ::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) return;
    struct stat file = {};
    bool ours = ::fstat(fd, &file) == 0 && S_ISREG(file.st_mode) && file.st_uid == ::geteuid();
    if (ours && ::flock(fd, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
    ::close(fd);
}

// Removes what killed runs have left behind of earlier attempts to write `target`.
void remove_left_overs(const std::string& target) {
    std::string begin = name_beside(target, part_ending);
    std::error_code none;
    std::vector<std::string> found;
    for (fs::directory_iterator i(folder_of(target), none), end; i != end;) {
        std::string path = (fs::path(target).parent_path() / i->path().filename()).string();
        bool fits = path.size() == begin.size() + fresh_letters && path.starts_with(begin) &&
                    path.find_first_not_of(letters, begin.size()) == std::string::npos;
        if (fits) found.push_back(path);
        if (i.increment(none); none) break;
    }
    for (const std::string& path : found) remove_if_left_over(path);
}

std::string lower_case(const fs::path& name) {
    std::string text = name.string();
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

// Whether a and A are one file there, as on most Macs.
bool ignores_case(const fs::path& folder) {
    std::string rest = random_letters();
    fs::path lower = folder / ("a" + rest), upper = folder / ("A" + rest);
    int fd = ::open(lower.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd < 0) return false;
    ::close(fd);
    std::error_code none;
    bool ignores = fs::exists(upper, none);
    ::unlink(lower.c_str());
    return ignores;
}

// Why the file cannot be replaced by another, as far as can be told; empty where it can.
std::string why_not_replaced(const std::string& target) {
    struct stat old = {};
    if (::lstat(target.c_str(), &old) != 0 || !S_ISREG(old.st_mode)) return "";
    // Root may do everything, and yet a write-protected file is meant to stay.
    if ((old.st_mode & 0222) == 0) return "it is write-protected";
    if (::access(target.c_str(), W_OK) != 0) return std::strerror(errno);
    // A file is no folder, so this fails; but first the system looks whether the name may be taken
    // from its folder. It may not where the folder is sticky and the file another user's.
    if (::rmdir(target.c_str()) != 0 && (errno == EPERM || errno == EACCES || errno == EROFS))
        return std::strerror(errno);
#ifdef STATX_ATTR_MOUNT_ROOT
    struct statx more = {};
    bool known = ::statx(AT_FDCWD, target.c_str(), AT_SYMLINK_NOFOLLOW, 0, &more) == 0;
    if (known && (more.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0) return std::strerror(EBUSY);
#endif
    return "";
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
    remove_left_overs(target_);
    for (int tries = 0; fd_ < 0 && (tries == 0 || (errno == EEXIST && tries < 10)); tries++) {
        temporary_ = name_beside(target_, part_ending + random_letters());
        // O_EXCL: a file of its own, never one that is there, nor one that a link names.
        fd_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd_ >= 0 && !lock()) ::close(std::exchange(fd_, -1)), errno = EEXIST;
    }
    if (fd_ < 0) {
        temporary_.clear();
        fail(path, "cannot write", errno);
    }
    if (is_there) (void)!::fchmod(fd_, old.st_mode & 07777);  // some file systems have no modes
}

NewFile::~NewFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    if (fd_ >= 0) ::close(fd_);
}

// Says to other runs that the file is being written. False where one of them took it for a left
// over one before that.
bool NewFile::lock() const {
    if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;  // some have no locks
    struct stat file = {};
    return ::fstat(fd_, &file) == 0 && file.st_nlink > 0;
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
    // Closing may tell what is wrong with the disk; the lock stays until the file is in its place.
    int copy = ::dup(fd_);
    if (copy < 0 || ::close(copy) != 0) fail(path_, "cannot write", errno);
    if (temporary_.empty()) return;
    std::string why = why_not_replaced(target_);
    if (why.empty() && ::rename(temporary_.c_str(), target_.c_str()) != 0)
        why = std::strerror(errno);
    std::string kept = std::exchange(temporary_, "");
    if (why.empty()) return;

    // Keep what was written. The next attempt of this process takes the same name.
    static const std::string ending = ".kept-" + random_letters();
    std::string name = name_beside(target_, ending);
    if (::rename(kept.c_str(), name.c_str()) == 0) kept = name;
    throw InputError(
        printable(path_ + ": error: cannot write: " + why + "; what was to be written is " + kept));
}

void write_file_atomically(const std::string& path, std::string_view bytes) {
    NewFile file(path);
    file.write(bytes);
    file.commit();
}

void check_writable(const std::string& path) {
    if (is_device(path)) {
        if (::access(path.c_str(), W_OK) != 0) fail(path, "cannot write", errno);
        return;
    }
    std::string why = why_not_replaced(follow_links(path));
    if (!why.empty()) throw InputError(printable(path + ": error: cannot write: " + why));
    NewFile never_committed(path);
}

bool same_file(const std::string& a, const std::string& b) {
    std::error_code none;
    if (fs::equivalent(a, b, none)) return true;
    fs::path x = fs::absolute(follow_links(a), none), y = fs::absolute(follow_links(b), none);
    if (!fs::equivalent(x.parent_path(), y.parent_path(), none)) return false;
    return x.filename() == y.filename() ||
           (lower_case(x.filename()) == lower_case(y.filename()) && ignores_case(x.parent_path()));
}

void make_folder(const std::string& path) {
    std::error_code error, none;
    fs::create_directories(path, error);
    bool is_file = error == std::errc::file_exists;  // as libc++ calls it
    if (!fs::is_directory(path, none))
        fail(path, "cannot make the folder", is_file ? ENOTDIR : error.value());
}

void check_outputs(const std::vector<std::string>& files, const std::vector<std::string>& inputs) {
    for (size_t i = 0; i < files.size(); i++) {
        if (files[i].starts_with("out/")) make_folder("out");
        for (const std::string& input : inputs) {
            if (!same_file(files[i], input)) continue;
            std::string name = files[i] == input ? "" : " ('" + input + "')";
            throw UsageError("error: '" + files[i] + "' is an input" + name +
                             ", and would be overwritten");
        }
        for (size_t j = 0; j < i; j++) {
            if (!same_file(files[i], files[j])) continue;
            throw UsageError("error: '" + files[j] + "' and '" + files[i] + "' are one file");
        }
        check_writable(files[i]);
    }
}

void check_space(const std::vector<FutureFile>& files) {
    std::map<dev_t, uint64_t> needed;
    for (const FutureFile& file : files) {
        if (is_device(file.path)) continue;
        std::string folder = folder_of(follow_links(file.path)).string();
        struct stat on = {};
        struct statvfs disk = {};
        if (::stat(folder.c_str(), &on) != 0 || ::statvfs(folder.c_str(), &disk) != 0) continue;
        uint64_t free = uint64_t{disk.f_bavail} * disk.f_frsize,
                 all = needed[on.st_dev] += file.bytes;
        if (all <= free) continue;
        throw InputError(printable(file.path + ": error: cannot write: " + std::strerror(ENOSPC) +
                                   ": what is to be written there needs " + megabytes(all) + ", " +
                                   megabytes(free) + " are free"));
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
