// Files that are either wholly written or not touched, whole files read, and checksums of them.
#pragma once
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// Keeps other programs from a file that this one writes, as long as a copy of it lives, by a file
/// beside it, which has its name after all links with this ending. Throws InputError where another
/// program has it, and still after half a second.
using FileLock = std::shared_ptr<void>;
FileLock lock_of(const std::string& path, const std::string& ending = ".lock");

/// Writes a file beside its place, as NAME.part, and puts it there when it is whole: a full disk or
/// a kill leaves what was there before. A device or pipe is written to directly. Throws InputError
/// when anything fails; where the file cannot be put in its place, NAME.part stays, and the error
/// says so. What a killed run has left behind is overwritten.
void write_file_atomically(const std::string& path,
                           const std::function<void(std::ostream&)>& write);
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
std::string read_file(const std::string& path, size_t largest = size_t{1} << 30);

/// A number of 64 bits for any bytes, given piece by piece; where the pieces end does not matter.
/// A change within eight bytes that are hashed together, such as one flipped bit, always changes
/// it: each step is a bijection. No protection against those who want to deceive.
///
///   h = mix(h ^ word)      for each 8 bytes, the last ones filled up with 0
///
/// tested by  "teeth: a film with any bit flipped, or cut anywhere, is refused"
class Checksum {
public:
    void add(std::string_view bytes) {
        for (char byte : bytes) {
            word_ |= uint64_t{static_cast<unsigned char>(byte)} << 8 * (length_ % 8);
            if (++length_ % 8 == 0) step(word_), word_ = 0;
        }
    }
    uint64_t value() const {
        Checksum end = *this;
        end.step(word_);
        end.step(length_);
        return end.sum_;
    }

private:
    void step(uint64_t word) {
        sum_ = (sum_ ^ word) * 0x9e3779b97f4a7c15u;
        sum_ = (sum_ ^ sum_ >> 32) * 0xd6e8feb86659fd93u;
        sum_ ^= sum_ >> 29;
    }
    uint64_t sum_ = 0x243f6a8885a308d3u, word_ = 0, length_ = 0;
};
