// Files that are either wholly written or not touched, and whole files read.
#pragma once
#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Keeps other programs from a file that this one writes, by a file NAME.lock beside it. Throws
/// InputError, with the name `path` in it, where another program has it, and still after `tries` of
/// 10 ms each.
class FileLock {
public:
    explicit FileLock(const std::string& path, const std::string& file, int tries = 0);
    explicit FileLock(const std::string& path) : FileLock(path, path) {}
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    std::string name_;
    int lock_ = -1;
};

/// A file that is written beside its place, as NAME.part, and put there when it is whole; until
/// then what was there stays. It gets the mode of the file whose place it takes. A device or pipe
/// is written to directly. What fails throws InputError; without commit() nothing is left behind.
/// What a killed run has left behind is overwritten.
class NewFile {
public:
    explicit NewFile(const std::string& path);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    void write(std::string_view bytes);
    /// Waits until what was written is on the disk: then it is there after a power failure too.
    void write_through();
    /// Puts the file in its place. Where that cannot be done, it stays beside it, and the error
    /// says under which name.
    void commit();

private:
    std::string path_;                // as named, for messages
    std::string target_, temporary_;  // after all links; beside it. Empty for a device
    std::optional<FileLock> lock_;
    std::ofstream file_;
};

/// Writes `bytes` to a new file beside `path` and renames it over `path`: a full disk or a kill
/// leaves what was there before. A device or pipe is written to directly.
/// Throws InputError when anything fails.
void write_file_atomically(const std::string& path, std::string_view bytes);

/// The name of a file, and the function that writes it.
using Output = std::pair<std::string, std::function<void()>>;

/// Writes them all, whatever happens to one of them; pipes and devices last, since they may wait
/// for a reader. Then throws InputError with a line for each that could not be written.
void write_outputs(std::vector<Output> outputs);

/// Throws the InputError that write_file_atomically would throw now, but writes nothing: asked
/// before hours of work whose result would have no place.
void check_writable(const std::string& path);

/// How many bytes the file has; 0 where there is none.
uint64_t size_of(const std::string& path);

/// Whether both names are of the same file, through links too; it need not exist yet.
bool same_file(const std::string& a, const std::string& b);

/// Whether the file's name ends so, such as in ".pfm", be it in capitals.
bool has_ending(const std::string& path, const std::string& ending);

/// Makes the folder and those above it where they are not there. Throws InputError.
void make_folder(const std::string& path);

/// Throws InputError where the disk has less room than a file of so many bytes takes.
void check_space(const std::string& path, uint64_t bytes);

/// Asked before the work whose results are to be written to these files: makes the folder out/ when
/// one of them is in it, and throws UsageError when two are the same or one is an input. One that
/// cannot be written, or has no room for its bytes, is told, since the others are worth the work;
/// if none can, throws InputError.
void check_outputs(const std::vector<std::string>& files,
                   const std::vector<std::string>& inputs = {},
                   const std::function<uint64_t(const std::string&)>& bytes_of = {});

/// The whole file; throws InputError when it is missing, a folder, or larger than 1 GiB.
std::string read_file(const std::string& path);
