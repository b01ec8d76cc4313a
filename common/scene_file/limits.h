// How large a scene may be.
#pragma once
#include <cstdint>

/// What grows beyond these is refused where it does, before it fills the memory. A scene at the
/// limit is read in minutes, and takes some 10 GB while its hierarchy is built.
struct Limits {
    uint64_t file_bytes = uint64_t{4} << 30;  // of all files together, each as often as it is read
    uint64_t directives = 10'000'000;
    uint64_t primitives = uint64_t{1} << 25;  // triangles, spheres and disks
    uint64_t vertices = uint64_t{1} << 26;
    uint64_t texels = uint64_t{1} << 28;  // of the pictures of all textures together
};
