#include "common/results/outputs.h"

#include <algorithm>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/position.h"
#include "common/base/system.h"
#include "common/picture/film_file.h"

namespace fs = std::filesystem;

namespace {

/// Whether --split may write a picture of this name: of one class such as LDE, of all classes with
/// long names, or the sheet of all.
bool is_of_split(const fs::path& name) {
    if (name.extension() != ".pfm" && name.extension() != ".png") return false;
    std::string stem = file_name(name.stem());
    if (stem == "longer" || stem == "classes") return true;
    return stem.size() >= 2 && stem.front() == 'L' && stem.back() == 'E' &&
           stem.find_first_not_of("DS", 1) == stem.size() - 1;
}

/// Adds the files of a folder that may be written later. Their names are not known yet, so these
/// are the existing files and those of `others`, if their names match.
void add_later(const std::string& folder, const std::vector<std::string>& others,
               std::vector<std::string>& files) {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(file_path(folder.empty() ? "." : folder), none))
        names.push_back(file_name(entry.path().filename()));
    for (const std::string& other : others) names.push_back(file_name(file_path(other).filename()));
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    for (const std::string& name : names) {
        if (is_of_split(name)) files.push_back(file_name(file_path(folder) / file_path(name)));
    }
}

}  // namespace

std::string drawing_path(const RenderOptions& options) {
    return file_name(file_path(options.out[0]).replace_extension(".svg"));
}

void check_outputs(const Scene& scene, const RenderOptions& options) {
    std::vector<std::string> inputs(scene.files.begin(), scene.files.end());
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
    std::vector<std::string> others = inputs;
    others.insert(others.end(), files.begin(), files.end());
    if (!options.split.empty()) {
        make_folder(options.split);
        others.push_back("LE.pfm");  // of any class
        add_later(options.split, others, files);
    }
    uint64_t pixels = static_cast<uint64_t>(scene.width) * static_cast<uint64_t>(scene.height);
    check_outputs(files, inputs, [&](const std::string& file) {
        uint64_t bytes = has_ending(file, ".pfm") ? sizeof(Rgb) : has_ending(file, ".ppm") ? 3 : 0;
        return std::max<uint64_t>(bytes * pixels, 1);  // that of others is not known
    });
}
