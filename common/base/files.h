// Files that are either wholly written or not touched, and whole files read.
#pragma once
#include <string>
#include <string_view>
#include <vector>

/// A file that is written beside its place, under a fresh name, and put there when it is whole;
/// until then what was there stays. It gets the mode of the file whose place it takes. A device or
/// pipe is written to directly. What fails throws InputError; without commit() nothing is left
/// behind.
class NewFile {
public:
    explicit NewFile(const std::string& path);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    void write(std::string_view bytes);
    /// Waits until what was written is on the disk: then it is there after a power failure too.
    void write_through();
    /// Puts the file in its place.
    void commit();

private:
    std::string path_;                // as named, for messages
    std::string target_, temporary_;  // after all links; beside it. Empty for a device
    int fd_ = -1;
};

/// Writes `bytes` to a new file beside `path` and renames it over `path`: a full disk or a kill
/// leaves what was there before. A device or pipe is written to directly.
/// Throws InputError when anything fails.
void write_file_atomically(const std::string& path, std::string_view bytes);

/// Throws the InputError that write_file_atomically would throw now, but writes nothing: asked
/// before hours of work whose result would have no place.
void check_writable(const std::string& path);

/// Whether both names are of the same file, through links too; it need not exist yet.
bool same_file(const std::string& a, const std::string& b);

/// Asked before the work whose results are to be written to these files: makes the folder out/ when
/// one of them is in it, and throws InputError for one that cannot be written, UsageError when two
/// are the same or one is the input.
void check_outputs(const std::vector<std::string>& files, const std::string& input = "");

/// The whole file; throws InputError when it is missing, a folder, or larger than 1 GiB.
std::string read_file(const std::string& path);
