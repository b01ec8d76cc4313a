#include "common/scene_file/reader.h"

#include <algorithm>
#include <filesystem>

#include "common/base/files.h"
#include "common/scene_file/named_files.h"
#include "common/scene_file/scene_reader.h"

using R = SceneReader;
const std::map<std::string, SceneReader::Directive, std::less<>> SceneReader::directives = {
    {"Accelerator", {Block::options, &R::accelerator}},
    {"ActiveTransform", {Block::both, &R::active_transform}},
    {"AreaLightSource", {Block::world, &R::area_light_source}},
    {"Attribute", {Block::both, nullptr}},
    {"AttributeBegin", {Block::world, &R::begin}},
    {"AttributeEnd", {Block::world, &R::end}},
    {"Camera", {Block::options, &R::camera}},
    {"ColorSpace", {Block::both, &R::color_space}},
    {"ConcatTransform", {Block::both, &R::move}},
    {"CoordSysTransform", {Block::both, nullptr}},
    {"CoordinateSystem", {Block::both, nullptr}},
    {"Film", {Block::options, &R::film}},
    {"Identity", {Block::both, &R::move}},
    {"Import", {Block::both, nullptr}},
    {"Include", {Block::both, &R::include}},
    {"Integrator", {Block::options, &R::integrator}},
    {"LightSource", {Block::world, &R::light_source}},
    {"LookAt", {Block::both, &R::move}},
    {"MakeNamedMaterial", {Block::world, &R::make_named_material}},
    {"MakeNamedMedium", {Block::both, nullptr}},
    {"Material", {Block::world, &R::material}},
    {"MediumInterface", {Block::both, nullptr}},
    {"NamedMaterial", {Block::world, &R::named_material}},
    {"ObjectBegin", {Block::both, nullptr}},
    {"ObjectEnd", {Block::both, nullptr}},
    {"ObjectInstance", {Block::both, nullptr}},
    {"Option", {Block::options, &R::option}},
    {"PixelFilter", {Block::options, &R::pixel_filter}},
    {"ReverseOrientation", {Block::world, &R::reverse_orientation}},
    {"Rotate", {Block::both, &R::move}},
    {"Sampler", {Block::options, &R::sampler}},
    {"Scale", {Block::both, &R::move}},
    {"Shape", {Block::world, &R::shape}},
    {"Texture", {Block::both, nullptr}},
    {"Transform", {Block::both, &R::move}},
    {"TransformBegin", {Block::world, &R::begin}},
    {"TransformEnd", {Block::world, &R::end}},
    {"TransformTimes", {Block::both, nullptr}},
    {"Translate", {Block::both, &R::move}},
    {"WorldBegin", {Block::options, &R::world_begin}},
};

// The one name of a file that has many, such as a/../b.
static std::string canonical(const std::string& path) {
    std::error_code none;
    return std::filesystem::weakly_canonical(path, none).string();
}

void SceneReader::read(const std::string& path, std::string text) {
    open_files_.push_back(canonical(path));
    Lexer lexer(path, std::move(text));
    for (Token token = lexer.next(); token.type != Token::end; token = lexer.next()) {
        read_directive(lexer, token);
    }
    open_files_.pop_back();
}

void SceneReader::read_directive(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    if (word.type != Token::word || to_number(word.text)) {
        fail(at, "expected a directive, not " + Lexer::describe(word));
    }
    std::string name(word.text);
    auto found = directives.find(name);
    if (found == directives.end()) {
        if (name == "WorldEnd") fail(at, "WorldEnd is not part of pbrt-v4: leave it out");
        std::vector<std::string> known;
        for (const auto& [directive, how] : directives) {
            if (how.read) known.push_back(directive);
        }
        fail_unknown(at, "directive", name, known);
    }
    auto [block, read] = found->second;
    if (!read) fail(at, name + " is not supported");
    if (name == "WorldBegin" && in_world_) fail(at, "a second WorldBegin");
    if (block == Block::options && in_world_) fail(at, name + " must stand before WorldBegin");
    if (block == Block::world && !in_world_) fail(at, name + " must stand after WorldBegin");
    (this->*read)(lexer, word);
}

void SceneReader::include(Lexer& lexer, const Token& word) {
    constexpr size_t deepest = 100;
    constexpr int most = 10000;
    Token token = expect_string(lexer, word, "a file name");
    Position at = lexer.at(token);
    std::string path = find_named_file(scene_.file, at, lexer.unescape(token));
    std::string file = canonical(path);
    if (std::find(open_files_.begin(), open_files_.end(), file) != open_files_.end()) {
        fail(at, quote(path) + " includes itself");
    }
    if (open_files_.size() > deepest) fail(at, "files include each other more than 100 deep");
    if (++includes_ > most) fail(at, "more than 10000 files are included");
    read(path, read_named_file(path, at));
}

void SceneReader::check_materials() const {
    std::vector<std::string> known;
    for (const auto& [name, material] : named_materials_) {
        if (material.defined) known.push_back(name);
    }
    for (const auto& [name, material] : named_materials_) {
        if (!material.defined) fail_unknown(material.first_use, "NamedMaterial", name, known);
    }
}

Scene SceneReader::finish() {
    auto refuse = [&](const std::string& text) {
        throw InputError(printable(scene_.file) + ": error: " + text);
    };
    if (!saved_.empty()) fail(saved_.back().at, saved_.back().begin + " is never closed");
    check_materials();
    if (!in_world_) refuse("no WorldBegin");
    if (!has_camera_) refuse("no Camera");
    if (scene_.geometry.size() == 0) refuse("no Shape");
    if (scene_.lights.empty()) refuse("no light: the picture would be black");
    number_light_primitives(scene_);

    // Give the lights what pbrt's film does: twice the exposure is a picture twice as bright.
    float exposure = exposure_.shutter * exposure_.iso / 100;
    for (Light& light : scene_.lights) {
        light.L *= exposure;
        if (too_bright(light.L) || is_black(light.L))
            refuse("shutter or iso leave no usable light");
    }
    if (!has_filter_) {
        notes_.push_back(printable(scene_.file) +
                         ": note: no PixelFilter: pbrt's \"gaussian\" is replaced by the box");
    }
    return std::move(scene_);
}

Scene parse_scene(const std::string& path, std::string text, std::vector<std::string>* notes) {
    Notes unread;
    SceneReader reader(path, notes ? *notes : unread);
    reader.read(path, std::move(text));
    return reader.finish();
}

Scene load_scene(const std::string& path, std::vector<std::string>* notes) {
    return parse_scene(path, read_file(path), notes);
}
