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
/// InputError, with the name `path` in it, where another program has it, and still after half a
/// second.
class FileLock {
public:
    explicit FileLock(const std::string& path, const std::string& file);
    explicit FileLock(const std::string& path) : FileLock(path, path) {}
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    std::string name_;
    int lock_ = -1;
};

/// A file that is written beside its place, as NAME.part, and put there when it is whole; until
/// then what was there stays. A device or pipe is written to directly. What fails throws
/// InputError; without commit() nothing is left behind. What a killed run has left behind is
/// overwritten.
class NewFile {
public:
    explicit NewFile(const std::string& path);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    void write(std::string_view bytes);
    /// Puts the file in its place. Where that cannot be done, NAME.part stays, and the error says
    /// so.
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

/// Writes them all, whatever happens to one of them. Then throws InputError with a line for each
/// that could not be written.
void write_outputs(const std::vector<Output>& outputs);

/// Throws the InputError that write_file_atomically would throw now, but writes nothing: asked
/// before hours of work whose result would have no place.
void check_writable(const std::string& path);

/// Whether the file's name ends so, such as in ".pfm", be it in capitals.
bool has_ending(const std::string& path, const std::string& ending);

/// Makes the folder and those above it where they are not there. Throws InputError.
void make_folder(const std::string& path);

/// Asked before the work whose results are to be written to these files: makes the folder out/ when
/// one of them is in it, and throws UsageError when two are the same or one is an input. One that
/// cannot be written is told, since the others are worth the work; if none can, throws InputError.
void check_outputs(const std::vector<std::string>& files,
                   const std::vector<std::string>& inputs = {});

/// The whole file; throws InputError when it is missing, a folder, or larger than 1 GiB.
std::string read_file(const std::string& path);
