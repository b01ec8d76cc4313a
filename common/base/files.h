// Files that are either wholly written or not touched, and whole files read.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// Keeps other programs from the file that this one replaces from time to time. A file that is not
/// there is made, empty, and is removed if nothing takes its place. Throws InputError where another
/// program has it.
class FileLock {
public:
    explicit FileLock(const std::string& path);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    friend class NewFile;
    std::string path_;
    int lock_ = -1;
};

/// A file that is written beside its place, under a fresh name, and put there when it is whole;
/// until then what was there stays. It gets the mode of the file whose place it takes. A device or
/// pipe is written to directly. What fails throws InputError; without commit() nothing is left
/// behind. What a killed run has left behind of the same file is removed; it is locked as long as
/// somebody writes it.
class NewFile {
public:
    explicit NewFile(const std::string& path);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    void write(std::string_view bytes);
    /// Waits until what was written is on the disk: then it is there after a power failure too.
    void write_through();
    /// Puts the file in its place; a lock of the file there goes on. Where that cannot be done, it
    /// stays beside it, and the error says under which name.
    void commit(FileLock* lock = nullptr);

private:
    std::string path_;                // as named, for messages
    std::string target_, temporary_;  // after all links; beside it. Empty for a device
    int file_ = -1;
};

/// Writes `bytes` to a new file beside `path` and renames it over `path`: a full disk or a kill
/// leaves what was there before. A device or pipe is written to directly.
/// Throws InputError when anything fails.
void write_file_atomically(const std::string& path, std::string_view bytes,
                           FileLock* lock = nullptr);

/// The name of a file, and the function that writes it.
using Output = std::pair<std::string, std::function<void()>>;

/// Writes them all, whatever happens to one of them; pipes and devices last, since they may wait
/// for a reader. Then throws InputError with a line for each that could not be written.
void write_outputs(std::vector<Output> outputs);

/// Throws the InputError that write_file_atomically would throw now, but writes nothing: asked
/// before hours of work whose result would have no place. A file that is write-protected, another
/// user's in a sticky folder, or mounted there by itself cannot be replaced.
void check_writable(const std::string& path);

/// How many bytes the file has; 0 where there is none.
uint64_t size_of(const std::string& path);

/// Whether both names are of the same file, through links too, and in another case where the folder
/// ignores that; it need not exist yet.
bool same_file(const std::string& a, const std::string& b);

/// Whether the file's name ends so, such as in ".pfm", be it in capitals.
bool has_ending(const std::string& path, const std::string& ending);

/// Makes the folder and those above it where they are not there. Throws InputError.
void make_folder(const std::string& path);

/// Asked before the work whose results are to be written to these files: makes the folder out/ when
/// one of them is in it, and throws UsageError when two are the same or one is an input. One that
/// cannot be written is told, since the others are worth the work; if none can, throws InputError.
void check_outputs(const std::vector<std::string>& files,
                   const std::vector<std::string>& inputs = {});

/// A file that is to be written, and how many bytes it will have at least.
struct FutureFile {
    std::string path;
    uint64_t bytes = 0;
};
/// A line for each disk that has too little room for the files that will be there. Throws
/// InputError with these lines when all disks have, so that nothing could be written.
std::string check_space(const std::vector<FutureFile>& files);

/// The whole file; throws InputError when it is missing, a folder, or larger than 1 GiB.
std::string read_file(const std::string& path);
