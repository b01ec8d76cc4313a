#include "common/results/outputs.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/system.h"
#include "common/picture/film_file.h"
#include "common/scene/origin.h"

std::string drawing_path(const RenderOptions& options) {
    return file_name(file_path(options.out[0]).replace_extension(".svg"));
}

void check_outputs(const Scene& scene, const RenderOptions& options) {
    std::vector<std::string> inputs(scene.origin->files.begin(), scene.origin->files.end());
    if (options.explain || options.explain_brightest)
        return check_outputs({drawing_path(options)}, inputs);
    std::vector<std::string> files = options.out;
    for (const std::string& file : {options.film, options.stats})
        if (!file.empty()) files.push_back(file);
    for (const auto& [file, picture] : options.pictures) files.push_back(file);
    if (!options.film.empty()) {  // not to go on without it
        check_film_is_file(options.film);
        check_writable(options.film);
    }
    if (!options.split.empty()) {
        make_folder(options.split);
        files.push_back(options.split + "/classes.png");
    }
    uint64_t pixels = static_cast<uint64_t>(scene.width) * static_cast<uint64_t>(scene.height);
    check_outputs(files, inputs, [&](const std::string& file) {
        uint64_t bytes = has_ending(file, ".pfm") ? sizeof(Rgb) : has_ending(file, ".ppm") ? 3 : 0;
        return std::max<uint64_t>(bytes * pixels, 1);  // that of others is not known
    });
}
