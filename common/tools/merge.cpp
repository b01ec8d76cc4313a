// merge OUT IN...: averages renders of one scene with different seeds by their sample counts.
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/picture/merging.h"
#include "common/program/command_line.h"

int main(int argc, char** argv) {
    return run_program([&] {
        std::vector<std::string> words;
        parse_options(argc, argv, "OUT IN...",
                      "Averages the renders IN of one scene with different seeds: the picture OUT "
                      "of all their samples. Each IN is a .pfm with its --stats beside it "
                      "(NAME.json), or FILE:SPP.",
                      {}, [&](const std::string& word) { words.push_back(word); });
        if (words.size() < 2) {
            throw UsageError(
                "error: name the picture to write, and those to read; --help says how");
        }
        std::string out = words[0], stats_path = StatsFile::path_beside(out);
        if (!is_image_path(out)) throw UsageError("error: OUT is a .pfm, .ppm or .png file");
        check_writable(out);
        std::vector<MergePart> parts;
        for (size_t i = 1; i < words.size(); i++) {
            parts.push_back(read_part(words[i]));
            if (!same_file(parts.back().file, out)) continue;
            throw UsageError("error: '" + out + "' is also a part, and would be overwritten");
        }
        check_parts(parts);

        Image image = merged_image(parts);
        write_image(out, image, command_line(argc, argv));
        std::printf("wrote %s\n", out.c_str());
        std::string stats = merged_stats(parts, image);
        if (stats.empty()) return 0;
        write_file_atomically(stats_path, stats);
        std::printf("wrote %s\n", stats_path.c_str());
        return 0;
    });
}
