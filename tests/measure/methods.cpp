#include "tests/measure/methods.h"

#include <algorithm>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/nearest.h"

namespace {

std::vector<NamedMethod>& registry() {
    static std::vector<NamedMethod> methods;
    return methods;
}

std::vector<std::string> scenes_in(const char* folder) {
    std::vector<std::string> scenes;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".pbrt") scenes.push_back(entry.path().string());
    }
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

}  // namespace

bool add_method(const NamedMethod& method) {
    auto& methods = registry();
    auto before = [](const NamedMethod& a, const NamedMethod& b) { return a.name < b.name; };
    methods.insert(std::upper_bound(methods.begin(), methods.end(), method, before), method);
    return true;
}

const std::vector<NamedMethod>& all_methods() { return registry(); }

std::function<Rendering(const Scene&, const RenderOptions&)> by_trace(
    const std::function<Method(const Scene&)>& make_trace) {
    return [=](const Scene& scene, const RenderOptions& options) {
        return render_film(scene, options, make_trace(scene));
    };
}

std::vector<NamedMethod> methods_named(const std::vector<std::string>& names) {
    std::vector<NamedMethod> found;
    std::vector<std::string> known;
    for (const NamedMethod& m : all_methods()) known.push_back(m.name);
    for (const std::string& name : names) {
        size_t before = found.size();
        for (const NamedMethod& m : all_methods()) {
            bool plus = name.size() == 3 && name[2] == '+';
            bool wanted = plus            ? m.name.substr(0, 2) == name.substr(0, 2)
                          : name == "all" ? !is_variant(m)
                                          : m.name == name;
            if (wanted) found.push_back(m);
        }
        if (found.size() == before) parse_choice("methods", name, known);
    }
    return found;
}

void refuse(const NamedMethod& method, const Scene& scene) {
    refuse_features(scene, method.features);
    for (auto check : method.refuse) check(scene);
}

bool can_render(const NamedMethod& method, const Scene& scene) {
    try {
        refuse(method, scene);
    } catch (const InputError&) {
        return false;
    }
    return true;
}

std::vector<std::string> own_scenes() { return scenes_in("scenes"); }

std::vector<std::string> all_scenes() {
    std::vector<std::string> scenes = own_scenes(), others = scenes_in("tests/pictures/references");
    scenes.insert(scenes.end(), others.begin(), others.end());
    return scenes;
}

std::string scene_name(const std::string& path) {
    std::filesystem::path p(path);
    std::string folder = p.parent_path().filename().string();
    return (folder == "scenes" ? "" : folder + "/") + p.stem().string();
}

std::string file_name(std::string scene_name) {
    std::replace(scene_name.begin(), scene_name.end(), '/', '-');
    return scene_name;
}

std::string find_scene(const std::string& name) {
    if (std::filesystem::exists(name)) return name;
    std::vector<std::string> known;
    for (const std::string& path : all_scenes()) {
        known.push_back(scene_name(path));
        if (known.back() == name) return path;
    }
    std::string nearest = nearest_word(name, known);
    throw UsageError("error: no scene '" + name + "'" +
                     (nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
}
