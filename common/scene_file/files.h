// The files that a scene file names.
#pragma once
#include <map>
#include <set>
#include <string>

#include "common/base/checksum.h"
#include "common/base/position.h"
#include "common/base/report.h"
#include "common/scene_file/limits.h"
#include "common/scene_file/ply.h"

/// The bytes of a scene file, unpacked if they are packed by gzip; throws InputError when it cannot
/// be read, and at once for what is no file: a device or a pipe may never end.
std::string read_scene_file(const std::string& path);

/// The one name of a file that has many, such as a/../b.
std::string canonical(const std::string& path);

/// Finds and reads the files that a scene names, and counts how much is read.
class NamedFiles {
public:
    NamedFiles(std::string main_file, const Limits& limits, const Report& report)
        : main_file_(std::move(main_file)), limits_(limits), report_(report) {}

    /// The path of the file that is named at a place in a scene file: relative to the file that
    /// names it, or, where there is no such file, to the main scene file, which is what pbrt does.
    std::string find(const Position& at, const std::string& name) const;
    /// The bytes of the file; throws at the place that names it when it cannot be read, or when
    /// more than the limit would be read in all.
    std::string read(const std::string& path, const Position& at);
    /// The mesh in a PLY file, which is read once, however often it is named.
    const TriangleMesh& mesh(const std::string& path, const Position& at);

    /// Of the lengths and bytes of all files, in the order in which they are read. The main file is
    /// read elsewhere, and added by who reads it.
    uint64_t checksum() const { return checksum_.value(); }
    void add_to_checksum(const std::string& bytes);
    const std::set<std::string>& files_read() const { return files_read_; }

private:
    const std::string main_file_;
    const Limits limits_;
    const Report report_;
    std::set<std::string> files_read_;
    uint64_t bytes_read_ = 0;
    Checksum checksum_;
    std::map<std::string, TriangleMesh> meshes_;  // by the canonical names of their files
};
