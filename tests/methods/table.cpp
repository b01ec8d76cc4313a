#include "tests/methods/table.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/scene/prepare.h"

static std::vector<NamedMethod>& table() {
    static std::vector<NamedMethod> methods;
    return methods;
}

Rows::Rows(std::initializer_list<NamedMethod> rows) {
    auto before = [](const NamedMethod& a, const NamedMethod& b) { return a.name < b.name; };
    for (const NamedMethod& row : rows)
        table().insert(std::upper_bound(table().begin(), table().end(), row, before), row);
}

const std::vector<NamedMethod>& all_methods() { return table(); }

std::vector<NamedMethod> methods_named(const std::vector<std::string>& names) {
    std::vector<NamedMethod> found;
    std::vector<std::string> known;
    for (const NamedMethod& m : all_methods()) known.push_back(m.name);
    for (const std::string& name : names) {
        size_t before = found.size();
        for (const NamedMethod& m : all_methods()) {
            bool plus = name.size() == 3 && name[2] == '+';
            bool wanted = plus            ? m.name.substr(0, 2) == name.substr(0, 2)
                          : name == "all" ? !m.is_variant()
                                          : m.name == name;
            if (wanted) found.push_back(m);
        }
        if (found.size() == before) fail_value("methods", name, listed(known, " or "));
    }
    return found;
}

Method method(const std::string& name, const Scene& scene) {
    RenderOptions options;
    return methods_named({name})[0].make(scene, options);
}

Rendering render(const NamedMethod& method, const Scene& scene, RenderOptions options) {
    options.search = method.search;
    Method made = method.make(scene, options);
    return render_film(scene, options, made);
}

void refuse(const NamedMethod& method, const Scene& scene) {
    Scene copy = scene;
    fit_features(copy, features_of(method.number()));
    if (method.random_hits()) refuse_delta_lights(scene);
    if (method.search != LightSearch::from_lights) return;
    // What mirrors and glass show the camera is missing.
    for (const Shape& shape : scene.shapes)
        if (is_specular(scene.materials[shape.material]))
            throw InputError("error: " + scene.origin->file + " has mirrors or glass");
}

bool can_render(const NamedMethod& method, const Scene& scene) {
    try {
        refuse(method, scene);
    } catch (const InputError&) {
        return false;
    }
    return true;
}
