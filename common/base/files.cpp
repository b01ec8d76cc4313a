#include "common/base/files.h"

#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/base/system.h"

namespace fs = std::filesystem;

namespace {

constexpr const char* part_lock = ".part.lock";

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
    ::fail({path}, what + ": " + std::strerror(error != 0 ? error : EIO));
}

// A device or a pipe cannot be replaced, only written to. On Windows devices have such whole names.
bool is_device(const std::string& name) {
    std::error_code none;
    fs::file_status status = fs::status(file_path(name), none);
    if (fs::absolute(file_path(name), none).u8string().starts_with(u8"\\\\.\\")) return true;
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

// The whole name of the file that `path` names after its links, so that it is replaced and not the
// link.
fs::path after_links(const std::string& path) {
    std::error_code error;
    fs::path file = fs::weakly_canonical(fs::absolute(file_path(path), error), error);
    if (error) fail(path, "cannot write", error.default_error_condition().value());
    return file;
}

// Whether both names are of the same file, through links too; it need not exist yet.
bool same_file(const std::string& a, const std::string& b) {
    std::error_code none;
    return fs::equivalent(file_path(a), file_path(b), none) || after_links(a) == after_links(b);
}

// Why the file cannot be replaced by another; empty where it can, or is not there.
std::string why_not_replaced(const fs::path& file) {
    constexpr fs::perms to_write =
        fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
    std::error_code none;
    fs::file_status status = fs::status(file, none);
    if (fs::is_directory(status)) return "it is a folder";
    bool is_protected = (status.permissions() & to_write) == fs::perms::none;
    return fs::is_regular_file(status) && is_protected ? "it is write-protected" : "";
}

// What goes wrong while they are written, a line for each.
std::vector<std::string> errors_of(const std::vector<Output>& outputs) {
    std::vector<std::string> errors;
    for (const Output& output : outputs) {
        try {
            output.second();
        } catch (const InputError& error) {
            errors.push_back(error.what());
        }
    }
    return errors;
}

}  // namespace

FileLock lock_of(const std::string& path, const std::string& ending) {
    std::string name = file_name(after_links(path)) + ending;
    int lock = -1;
    for (int tries = 0; (lock = lock_file(name)) < 0; tries++) {
        if (errno != EWOULDBLOCK) fail(path, "cannot write", errno);
        if (tries >= 50) fail({path}, "another program is writing it");
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {nullptr, [=](void*) { unlock_file(lock, name); }};
}

void write_file_atomically(const std::string& path,
                           const std::function<void(std::ostream&)>& write) {
    bool is_replaced = !is_device(path);
    fs::path target = is_replaced ? after_links(path) : file_path(path), part = target;
    FileLock lock;
    std::error_code error;
    if (is_replaced) {
        part += ".part";
        lock = lock_of(path, part_lock);
        // It may be a link to another file, and somebody else's.
        fs::remove(part, error);
        if (error) fail(path, "cannot write", error.default_error_condition().value());
    }
    errno = 0;
    std::ofstream file(part, std::ios::binary);
    if (file) write(file);
    file.close();
    if (!file) {
        int reason = errno;
        if (is_replaced) fs::remove(part, error);
        fail(path, "cannot write", reason);
    }
    if (!is_replaced) return;
    std::string why = why_not_replaced(target);
    if (why.empty()) fs::rename(part, target, error);
    if (error) why = error.message();
    if (why.empty()) return;
    fail({path}, "cannot write: " + why + "; what was to be written is " + file_name(part));
}
void write_file_atomically(const std::string& path, std::string_view bytes) {
    write_file_atomically(path, [&](std::ostream& file) { file << bytes; });
}

void write_outputs(const std::vector<Output>& outputs) { throw_lines(errors_of(outputs)); }

void check_writable(const std::string& path) {
    if (is_device(path)) return;
    std::string why = why_not_replaced(after_links(path));
    if (!why.empty()) fail({path}, "cannot write: " + why);
    lock_of(path, part_lock);  // can be made
}

bool has_ending(const std::string& path, const std::string& ending) {
    std::string text = path;
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text.ends_with(ending);
}

void make_folder(const std::string& path) {
    std::error_code error, none;
    fs::create_directories(file_path(path), error);
    if (!fs::is_directory(file_path(path), none))
        fail(path, "cannot make the folder", error.default_error_condition().value());
}

void check_outputs(const std::vector<std::string>& files, const std::vector<std::string>& inputs) {
    std::vector<Output> checks;
    for (size_t i = 0; i < files.size(); i++) {
        if (file_name(file_path(files[i])).starts_with("out/")) make_folder("out");
        for (const std::string& input : inputs)
            if (same_file(files[i], input))
                throw UsageError("error: '" + files[i] + "' is an input, and would be overwritten");
        for (size_t j = 0; j < i; j++)
            if (same_file(files[i], files[j]))
                throw UsageError("error: '" + files[j] + "' and '" + files[i] + "' are one file");
        checks.push_back({files[i], [&, i] { check_writable(files[i]); }});
    }
    std::vector<std::string> errors = errors_of(checks);
    if (errors.size() == files.size()) throw_lines(errors);
    for (const std::string& error : errors) tell(error + '\n');
}

std::string read_file(const std::string& path, size_t largest) {
    std::error_code none;
    if (fs::is_directory(file_path(path), none)) fail(path, "cannot read", EISDIR);
    errno = 0;
    std::ifstream file(file_path(path), std::ios::binary);
    if (!file) fail(path, "cannot read", errno);
    // Read in pieces, since a pipe has no size to ask for.
    std::string bytes, piece(1 << 16, '\0');
    while (file && bytes.size() <= largest) {
        file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        bytes.append(piece, 0, static_cast<size_t>(file.gcount()));
    }
    if (file.bad()) fail(path, "cannot read", errno);
    if (bytes.size() > largest) fail({path}, "larger than 1 GiB");
    return bytes;
}
