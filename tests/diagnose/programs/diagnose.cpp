// diagnose FOLDER: says what is wrong with a renderer, from its pictures of the small scenes.
// diagnose --write FOLDER: writes these scenes.
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/render/options.h"
#include "tests/diagnose/judge.h"

int main(int argc, char** argv) {
    return run_program([&] {
        std::string to;
        std::vector<std::string> words;
        parse_options(
            argc, argv, "FOLDER",
            "Says what is wrong with a renderer, from its pictures of the small scenes.",
            {{"write", "DIR", "write the scenes", [&](const std::string& text) { to = text; }}},
            [&](const std::string& word) { words.push_back(word); });
        if (!to.empty()) {
            make_folder(to);
            for (const SmallScene& scene : small_scenes())
                write_file_atomically(to + "/" + scene.name + ".pbrt", scene.pbrt);
            std::printf("wrote %zu scenes\n", small_scenes().size());
            return 0;
        }
        if (words.size() != 1) throw UsageError("error: one folder of pictures is needed");
        Folder folder = read_folder(words[0]);
        for (const std::string& note : folder.notes) std::fprintf(stderr, "%s\n", note.c_str());
        if (folder.scenes.empty())
            throw InputError(
                words[0] +
                ": error: no picture that can be judged, such as floor.pfm with floor.2.pfm");
        Diagnosis d = judge(folder, read_effects());
        bool open = d.noisy > 0 || !folder.notes.empty();
        std::printf("%sverdict: %s\n", d.text.c_str(),
                    d.off  ? "wrong"
                    : open ? "undecided"
                           : "right");
        return d.off ? 1 : 0;
    });
}
