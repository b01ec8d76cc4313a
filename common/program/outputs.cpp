#include "common/program/outputs.h"

#include <algorithm>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/position.h"
#include "common/picture/film_file.h"

namespace fs = std::filesystem;

namespace {

/// Whether --split may write a picture of this name: of a class such as LDE, of all that have long
/// names, or the sheet of them all.
bool is_of_split(const fs::path& name) {
    if (name.extension() != ".pfm" && name.extension() != ".png") return false;
    std::string stem = name.stem().string();
    if (stem == "longer" || stem == "classes") return true;
    return stem.size() >= 2 && stem.front() == 'L' && stem.back() == 'E' &&
           stem.find_first_not_of("DS", 1) == stem.size() - 1;
}

/// Adds the pictures of --split to the files. Which classes there are is not known yet: so they are
/// those of `others` that may be one of its pictures, through links too.
void add_split(const std::string& folder, const std::vector<std::string>& others,
               std::vector<std::string>& files) {
    make_folder(folder);
    std::vector<std::string> names = {"LE.pfm"};
    for (const auto& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    for (const std::string& other : others) names.push_back(fs::path(other).filename().string());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    for (const std::string& name : names) {
        if (is_of_split(name)) files.push_back((fs::path(folder) / name).string());
    }
}

/// A film is read before it is written again: a pipe or a device cannot be.
void check_film(const std::string& film) {
    std::error_code none;
    fs::file_status status = fs::status(film, none);
    bool is_other = fs::exists(status) && !fs::is_regular_file(status);
    if (is_other) fail({film}, "a film must be a file: what this is cannot be read and replaced");
}

/// What is known of the sizes of files: pictures that are not compressed, and the sums of a film.
void check_space(const Scene& scene, const std::vector<std::string>& files) {
    uint64_t pixels = static_cast<uint64_t>(scene.width) * static_cast<uint64_t>(scene.height);
    std::vector<FutureFile> known;
    for (const std::string& file : files) {
        if (file.ends_with(".pfm")) known.push_back({file, pixels * sizeof(Rgb)});
        if (file.ends_with(".ppm")) known.push_back({file, pixels * 3});
        if (file.ends_with(film_ending)) known.push_back({file, pixels * sizeof(PixelSum)});
    }
    check_space(known);
}

}  // namespace

std::string drawing_path(const RenderOptions& options) {
    return fs::path(options.out[0]).replace_extension(".svg").string();
}

void check_outputs(const Scene& scene, const RenderOptions& options,
                   const std::vector<std::string>& more) {
    std::vector<std::string> inputs(scene.files.begin(), scene.files.end());
    if (options.explain || options.explain_brightest)
        return check_outputs({drawing_path(options)}, inputs);
    std::vector<std::string> files = options.out;
    for (const std::string& file : {options.film, options.stats, options.map})
        if (!file.empty()) files.push_back(file);
    files.insert(files.end(), more.begin(), more.end());
    if (!options.film.empty()) check_film(options.film);
    if (!options.split.empty()) {
        std::vector<std::string> others = inputs;
        others.insert(others.end(), files.begin(), files.end());
        add_split(options.split, others, files);
    }
    check_outputs(files, inputs);
    check_space(scene, files);
}
