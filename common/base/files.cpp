#include "common/base/files.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "common/base/error.h"
#include "common/base/position.h"
#include "common/base/report.h"
#include "common/base/system.h"

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
    throw InputError(printable(path + ": error: " + what + ": " + std::strerror(error)));
}

constexpr const char* letters = "abcdefghijklmnopqrstuvwxyz234567";
constexpr size_t fresh_letters = 12;
constexpr const char* part_ending = ".part-";

// The file that `path` names after its links, so that it is replaced and not the link. The last
// one may name a file that does not exist yet.
std::string follow_links(const std::string& path) {
    fs::path file = file_path(path);
    std::error_code none;
    for (int links = 0; fs::is_symlink(file, none); links++) {
        if (links == 40) fail(path, "cannot write", ELOOP);
        file = file.parent_path() / fs::read_symlink(file, none);
    }
    return file_name(file);
}

fs::path folder_of(const std::string& file) {
    fs::path folder = file_path(file).parent_path();
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
    fs::path file = file_path(target);
    std::string name = file_name(file.filename()).substr(0, longest) + ending;
    return file_name(file.replace_filename(file_path(name)));
}

// Removes what killed runs have left behind of earlier attempts to write `target`.
void remove_left_overs(const std::string& target) {
    std::string begin = name_beside(target, part_ending);
    std::error_code none;
    std::vector<std::string> found;
    for (fs::directory_iterator i(folder_of(target), none), end; i != end;) {
        std::string path = file_name(file_path(target).parent_path() / i->path().filename());
        bool fits = path.size() == begin.size() + fresh_letters && path.starts_with(begin) &&
                    path.find_first_not_of(letters, begin.size()) == std::string::npos;
        if (fits) found.push_back(path);
        if (i.increment(none); none) break;
    }
    for (const std::string& path : found) remove_left_over(path);
}

std::string lower_case(const fs::path& name) {
    std::string text = file_name(name);
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

// Whether a and A are one file there, as on most Macs.
bool ignores_case(const fs::path& folder) {
    std::string rest = random_letters();
    fs::path lower = folder / ("a" + rest), upper = folder / ("A" + rest);
    int file = open_new_file(file_name(lower));
    if (file < 0) return false;
    close_file(file);
    std::error_code none;
    bool ignores = fs::exists(upper, none);
    fs::remove(lower, none);
    return ignores;
}

}  // namespace

FileLock::FileLock(const std::string& path) : path_(path), lock_(lock_file(path)) {
    if (lock_ >= 0) return;
    if (errno != EWOULDBLOCK) fail(path, "cannot write", errno);
    throw InputError(printable(path + ": error: another program is writing it"));
}
FileLock::~FileLock() { unlock_file(lock_, path_); }

NewFile::NewFile(const std::string& path) : path_(path) {
    if (is_device(path)) {
        file_ = open_device(path);
        if (file_ < 0) fail(path, "cannot write", errno);
        return;
    }
    target_ = follow_links(path);
    std::error_code error;
    fs::file_status old = fs::status(file_path(target_), error);
    if (fs::is_directory(old)) fail(path, "cannot write", EISDIR);
    if (error == std::errc::filename_too_long) fail(path, "cannot write", ENAMETOOLONG);
    remove_left_overs(target_);
    // Another run may take a file for left over before it is locked. On a busy machine ten were.
    for (int tries = 0; file_ < 0 && (tries == 0 || (errno == EEXIST && tries < 99)); tries++) {
        temporary_ = name_beside(target_, part_ending + random_letters());
        file_ = open_new_file(temporary_);
    }
    if (file_ < 0) {
        temporary_.clear();
        fail(path, "cannot write", errno);
    }
    if (fs::exists(old)) copy_permissions(target_, file_);
}

NewFile::~NewFile() {
    if (file_ >= 0) close_file(file_);
    std::error_code none;
    if (!temporary_.empty()) fs::remove(file_path(temporary_), none);
}

void NewFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        ptrdiff_t n = write_bytes(file_, bytes.data(), bytes.size());
        if (n < 0) fail(path_, "cannot write", errno);
        bytes.remove_prefix(static_cast<size_t>(n));
    }
}

void NewFile::write_through() {
    if (!reach_disk(file_)) fail(path_, "cannot write", errno);
}

void NewFile::commit(FileLock* lock) {
    // Closing may tell what is wrong with the disk; the lock stays until the file is in its place.
    if (!closes_well(file_)) fail(path_, "cannot write", errno);
    if (temporary_.empty()) return;
    std::string why = why_not_replaced(target_);
    if (why.empty() && !rename_over(file_, temporary_, target_)) why = std::strerror(errno);
    std::string kept = std::exchange(temporary_, "");
    if (why.empty()) {
        if (lock != nullptr) pass_lock(lock->lock_, file_);
        return;
    }

    // Keep what was written. The next attempt of this process takes the same name.
    static const std::string ending = ".kept-" + random_letters();
    std::string name = name_beside(target_, ending);
    if (rename_over(file_, kept, name)) kept = name;
    throw InputError(
        printable(path_ + ": error: cannot write: " + why + "; what was to be written is " + kept));
}

void write_file_atomically(const std::string& path, std::string_view bytes, FileLock* lock) {
    NewFile file(path);
    file.write(bytes);
    file.commit(lock);
}

void write_outputs(std::vector<Output> outputs) {
    std::string errors;
    std::stable_partition(outputs.begin(), outputs.end(),
                          [](const Output& output) { return !is_device(output.first); });
    for (const auto& [path, write] : outputs) {
        try {
            write();
        } catch (const InputError& error) {
            errors += error.what() + std::string("\n");
        } catch (const std::bad_alloc&) {
            errors += path + ": error: cannot write: out of memory\n";
        }
    }
    if (!errors.empty()) throw InputError(errors.substr(0, errors.size() - 1));
}

void check_writable(const std::string& path) {
    if (is_device(path)) {
        if (!takes_writes(path)) fail(path, "cannot write", errno);
        return;
    }
    std::string why = why_not_replaced(follow_links(path));
    if (!why.empty()) throw InputError(printable(path + ": error: cannot write: " + why));
    NewFile never_committed(path);
}

uint64_t size_of(const std::string& path) {
    std::error_code none;
    uint64_t size = fs::file_size(file_path(path), none);
    return none ? 0 : size;
}

bool same_file(const std::string& a, const std::string& b) {
    std::error_code none;
    if (fs::equivalent(file_path(a), file_path(b), none)) return true;
    fs::path x = fs::absolute(file_path(follow_links(a)), none),
             y = fs::absolute(file_path(follow_links(b)), none);
    if (!fs::equivalent(x.parent_path(), y.parent_path(), none)) return false;
    return x.filename() == y.filename() ||
           (lower_case(x.filename()) == lower_case(y.filename()) && ignores_case(x.parent_path()));
}

bool has_ending(const std::string& path, const std::string& ending) {
    return lower_case(file_path(path)).ends_with(ending);
}

void make_folder(const std::string& path) {
    std::error_code error, none;
    fs::create_directories(file_path(path), error);
    bool is_file = error == std::errc::file_exists;  // as libc++ calls it
    if (!fs::is_directory(file_path(path), none))
        fail(path, "cannot make the folder", is_file ? ENOTDIR : error.value());
}

void check_outputs(const std::vector<std::string>& files, const std::vector<std::string>& inputs) {
    std::string errors;
    size_t refused = 0;
    for (size_t i = 0; i < files.size(); i++) {
        if (file_name(file_path(files[i])).starts_with("out/")) make_folder("out");
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
        try {
            check_writable(files[i]);
        } catch (const InputError& error) {
            errors += error.what() + std::string("\n");
            refused++;
        }
    }
    bool has_none = refused > 0 && refused == files.size();
    if (has_none) throw InputError(errors.substr(0, errors.size() - 1));
    tell(errors);
}

std::string check_space(const std::vector<FutureFile>& files) {
    constexpr uint64_t unit = 4096;  // bytes: disks give whole ones
    std::map<std::string, uint64_t> needed;
    std::set<std::string> full;
    std::string errors;
    for (const FutureFile& file : files) {
        std::error_code error;
        fs::path folder = folder_of(follow_links(file.path));
        std::string disk = is_device(file.path) ? file.path : disk_of(file_name(folder));
        uint64_t free = fs::space(folder, error).available,
                 all = needed[disk] += (file.bytes + unit - 1) / unit * unit;
        bool is_full = !is_device(file.path) && !error && all > free;
        if (!is_full || !full.insert(disk).second) continue;
        errors += printable(file.path + ": error: cannot write: " + std::strerror(ENOSPC) +
                            ": what is to be written there needs " + megabytes(all) + ", " +
                            megabytes(free) + " are free") +
                  '\n';
    }
    bool has_none = !full.empty() && full.size() == needed.size();
    if (has_none) throw InputError(errors.substr(0, errors.size() - 1));
    return errors;
}

std::string read_file(const std::string& path) {
    std::error_code none;
    fs::path file = file_path(path);
    if (fs::is_directory(file, none)) fail(path, "cannot read", EISDIR);
    constexpr size_t largest = size_t{1} << 30;
    bool too_large = fs::is_regular_file(file, none) && fs::file_size(file, none) > largest;
    if (too_large) throw InputError(path + ": error: larger than 1 GiB");
    int opened = open_file(path);
    if (opened < 0) fail(path, "cannot read", errno);

    // Read in pieces, since a pipe has no size to ask for.
    std::string bytes, piece(1 << 16, '\0');
    ptrdiff_t n = 0;
    do {
        n = read_bytes(opened, piece.data(), piece.size());
        if (n > 0) bytes.append(piece, 0, static_cast<size_t>(n));
    } while (n > 0 && bytes.size() <= largest);
    int error = n < 0 ? errno : 0;
    close_file(opened);
    if (error != 0) fail(path, "cannot read", error);
    if (bytes.size() > largest) throw InputError(path + ": error: larger than 1 GiB");
    return bytes;
}
