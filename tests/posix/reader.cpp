// What the memory is too small for.
#include "common/scene_file/reader.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include "common/base/files.h"
#include "tests/support/process.h"

namespace {

const std::string world = "Camera \"perspective\" WorldBegin LightSource \"infinite\"\n";

std::string refuse_in(const std::string& folder, const std::string& text) {
    return error_of([&] { parse_scene(folder + "/scene.pbrt", text, nullptr); });
}

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; i++) all += text;
    return all;
}

// Sanitizers end a program that has no more memory.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool has_sanitizers = true;
#elif defined(__has_feature)
constexpr bool has_sanitizers = __has_feature(address_sanitizer);
#else
constexpr bool has_sanitizers = false;
#endif

}  // namespace

TEST_SUITE("reader: large scenes") {
    TEST_CASE("input: what does not fit into the memory is named, with its size") {
        if (has_sanitizers || !exists_here("/proc/self/statm")) return;
        constexpr size_t vertices = 1'000'000, mega = 1'000'000;
        TemporaryFolder folder;
        write_file_atomically(
            folder / "big.ply",
            "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
                "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                "property list uchar int vertex_indices\nend_header\n" +
                std::string(12 * vertices, '\0') + '\3' + std::string(12, '\0'));
        const std::string ply = "Shape \"plymesh\" \"string filename\" \"big.ply\"\n";
        std::string numbers = "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [" +
                              repeated("0 0 1 ", 1'000'000) + "]\n";
        // Read with so much memory beyond what the process has.
        auto read_within = [&](const std::string& text, size_t more) {
            Process reader([&] {
                size_t pages = 0;
                std::FILE* file = std::fopen("/proc/self/statm", "r");
                if (std::fscanf(file, "%zu", &pages) != 1) return 1;
                std::fclose(file);
                rlim_t most = pages * static_cast<size_t>(::sysconf(_SC_PAGESIZE)) + more;
                rlimit limit = {most, most};
                ::setrlimit(RLIMIT_AS, &limit);
                std::printf("%s", refuse_in(folder.path(), text).c_str());
                return 0;
            });
            return reader.wait().out;
        };
        const std::string place = folder / "scene.pbrt" + ":2:";
        CHECK(read_within(world + ply, 8 * mega) == place + "17: error: \"" + folder / "big.ply" +
                                                        "\": out of memory: the file has 13 MB");
        std::string said = read_within(world + repeated(ply, 50), 100 * mega);
        CAPTURE(said);
        CHECK(said.find(
                  ": error: out of memory: Shape needs more, and what was read before takes ") !=
              std::string::npos);
        CHECK(said.ends_with(" MB"));
        CHECK(read_within(world + numbers, 20 * mega) ==
              place +
                  "1: error: out of memory: Shape needs more, and what was read before takes 1 MB");
    }
}
