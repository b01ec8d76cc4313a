#include "common/pbrt_reader.h"

#include <filesystem>
#include <map>

#include "common/files.h"
#include "common/pbrt_files.h"
#include "common/pbrt_shapes.h"
#include "common/pbrt_transforms.h"

namespace {

// What AttributeBegin saves and AttributeEnd restores.
struct State {
    Transform start, end;  // the current transform when the shutter opens and when it closes
    bool set_start = true, set_end = true;  // which of them a transform directive changes
    uint32_t material = 0;                  // into Scene::materials
    std::optional<AreaEmission> emission;
    bool reverse_orientation = false;
};

struct SavedState {
    State state;
    Position at;
    std::string begin;  // AttributeBegin, or TransformBegin
};

struct NamedMaterial {
    uint32_t index = 0;  // into Scene::materials
    bool defined = false;
    Position first_use;
};

// Reads directive by directive, and keeps the state that they change.
class SceneReader {
public:
    SceneReader(const std::string& path, Notes& notes) : notes_(notes) {
        scene_.file = path;
        scene_.materials.emplace_back();  // of shapes that are given none
    }

    void read(const std::string& path, std::string text);
    Scene finish();

private:
    // Where a directive may stand, and what reads it; null: pbrt has it and we do not.
    enum class Block { options, world, both };
    struct Directive {
        Block block;
        void (SceneReader::*read)(Lexer&, const Token&);
    };
    static const std::map<std::string, Directive, std::less<>> directives;

    void read_directive(Lexer& lexer, const Token& word);

    // Both before and after WorldBegin.
    void move(Lexer& lexer, const Token& word);
    void active_transform(Lexer& lexer, const Token& word);
    void color_space(Lexer& lexer, const Token& word);
    void include(Lexer& lexer, const Token& word);
    // Before WorldBegin.
    void accelerator(Lexer& lexer, const Token& word);
    void camera(Lexer& lexer, const Token& word);
    void film(Lexer& lexer, const Token& word);
    void integrator(Lexer& lexer, const Token& word);
    void option(Lexer& lexer, const Token& word);
    void pixel_filter(Lexer& lexer, const Token& word);
    void sampler(Lexer& lexer, const Token& word);
    void world_begin(Lexer& lexer, const Token& word);
    // After WorldBegin.
    void area_light_source(Lexer& lexer, const Token& word);
    void begin(Lexer& lexer, const Token& word);
    void end(Lexer& lexer, const Token& word);
    void light_source(Lexer& lexer, const Token& word);
    void make_named_material(Lexer& lexer, const Token& word);
    void material(Lexer& lexer, const Token& word);
    void named_material(Lexer& lexer, const Token& word);
    void reverse_orientation(Lexer& lexer, const Token& word);
    void shape(Lexer& lexer, const Token& word);

    uint32_t find_material(const std::string& name, const Position& at);
    const Transform& still_transform(const Position& at) const;
    void check_materials() const;

    Scene scene_;
    Notes& notes_;
    Exposure exposure_;
    State state_;
    std::vector<SavedState> saved_;
    std::map<std::string, NamedMaterial> named_materials_;
    std::vector<std::string> open_files_;
    int includes_ = 0;
    bool in_world_ = false, has_camera_ = false, has_filter_ = false;
};

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

// The string that must follow a directive.
Token expect_string(Lexer& lexer, const Token& word, const std::string& what) {
    Token token = lexer.next();
    if (token.type == Token::string) return token;
    fail(lexer.at(token),
         std::string(word.text) + " needs " + what + " in quotes, not " + Lexer::describe(token));
}

void SceneReader::read(const std::string& path, std::string text) {
    open_files_.push_back(path);
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
    if (block == Block::options && in_world_) fail(at, name + " must stand before WorldBegin");
    if (block == Block::world && !in_world_) fail(at, name + " must stand after WorldBegin");
    (this->*read)(lexer, word);
}

void SceneReader::move(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    TransformStep step = read_transform(lexer, word);
    if (state_.set_start) state_.start = apply(step, state_.start, at);
    if (state_.set_end) state_.end = apply(step, state_.end, at);
}

void SceneReader::active_transform(Lexer& lexer, const Token&) {
    Token which = lexer.next();
    bool all = which.text == "All", start = which.text == "StartTime";
    if (which.type != Token::word || !(all || start || which.text == "EndTime")) {
        fail(lexer.at(which),
             "ActiveTransform needs All, StartTime or EndTime, not " + Lexer::describe(which));
    }
    state_.set_start = all || start;
    state_.set_end = all || !start;
}

void SceneReader::color_space(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    if (token.text == "srgb") return;
    for (const char* name : {"aces2065-1", "dci-p3", "rec2020"}) {
        if (token.text != name) continue;
        notes_.push_back(message_at(lexer.at(word), "note",
                                    "ColorSpace " + quote(name) + " is read as \"srgb\""));
        return;
    }
    fail_unknown(lexer.at(token), "ColorSpace", std::string(token.text),
                 {"aces2065-1", "dci-p3", "rec2020", "srgb"});
}

void SceneReader::include(Lexer& lexer, const Token& word) {
    constexpr size_t deepest = 100;
    constexpr int most = 10000;
    Token token = expect_string(lexer, word, "a file name");
    Position at = lexer.at(token);
    NamedFile file = read_named_file(scene_.file, at, lexer.unescape(token));
    for (const std::string& open : open_files_) {
        std::error_code none;
        if (open == file.path || std::filesystem::equivalent(open, file.path, none)) {
            fail(at, quote(file.path) + " includes itself");
        }
    }
    if (open_files_.size() > deepest) fail(at, "files include each other more than 100 deep");
    if (++includes_ > most) fail(at, "more than 10000 files are included");
    read(file.path, std::move(file.bytes));
}

void SceneReader::accelerator(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    read_accelerator(params, notes_);
}

void SceneReader::camera(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    read_camera(params, still_transform(params.at()), scene_.camera, exposure_);
    has_camera_ = true;
}

void SceneReader::film(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    read_film(params, scene_, exposure_, notes_);
}

void SceneReader::integrator(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    read_integrator(params, scene_, notes_);
}

void SceneReader::option(Lexer& lexer, const Token& word) {
    Token name = expect_string(lexer, word, "a name");
    Token value = lexer.next();
    if (value.type != Token::word && value.type != Token::string) {
        fail(lexer.at(value), "Option needs a value, not " + Lexer::describe(value));
    }
    read_option(lexer.at(name), lexer.unescape(name), notes_);
}

void SceneReader::pixel_filter(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    read_pixel_filter(params, notes_);
    has_filter_ = true;
}

void SceneReader::sampler(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    read_sampler(params, scene_, notes_);
}

void SceneReader::world_begin(Lexer&, const Token&) {
    in_world_ = true;
    state_ = {};
}

void SceneReader::area_light_source(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    state_.emission = read_area_light(params);
}

void SceneReader::begin(Lexer& lexer, const Token& word) {
    saved_.push_back({state_, lexer.at(word), std::string(word.text)});
}

void SceneReader::end(Lexer& lexer, const Token& word) {
    std::string name(word.text);
    if (saved_.empty()) fail(lexer.at(word), name + " without a beginning");
    const SavedState& saved = saved_.back();
    if (saved.begin.front() != name.front()) {
        fail(lexer.at(word), name + " cannot close the " + saved.begin + " of line " +
                                 std::to_string(saved.at.line));
    }
    state_ = saved.state;
    saved_.pop_back();
}

void SceneReader::light_source(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    Light light = read_light(params, still_transform(params.at()));
    if (!is_black(light.L)) scene_.lights.push_back(light);
}

void SceneReader::make_named_material(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    std::string name = lexer.unescape(token);
    Params params(lexer, word, false);
    params.read_type();
    uint32_t index = find_material(name, lexer.at(token));
    NamedMaterial& named = named_materials_[name];
    if (named.defined) fail(lexer.at(token), "a second material " + quote(name));
    named.defined = true;
    scene_.materials[index] = read_material(params);
}

void SceneReader::material(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    state_.material = static_cast<uint32_t>(scene_.materials.size());
    scene_.materials.push_back(read_material(params));
}

void SceneReader::named_material(Lexer& lexer, const Token& word) {
    Token token = expect_string(lexer, word, "a name");
    state_.material = find_material(lexer.unescape(token), lexer.at(token));
}

void SceneReader::reverse_orientation(Lexer&, const Token&) {
    state_.reverse_orientation = !state_.reverse_orientation;
}

void SceneReader::shape(Lexer& lexer, const Token& word) {
    Params params(lexer, word);
    ShapeState state = {still_transform(params.at()), state_.material, state_.emission,
                        state_.reverse_orientation};
    read_shape(params, state, scene_, notes_);
}

// The number of the named material, which may be defined after its use.
uint32_t SceneReader::find_material(const std::string& name, const Position& at) {
    auto [place, is_new] = named_materials_.try_emplace(name);
    if (is_new) {
        place->second = {static_cast<uint32_t>(scene_.materials.size()), false, at};
        scene_.materials.emplace_back();
    }
    return place->second.index;
}

// The current transform; throws where it moves while the shutter is open.
const Transform& SceneReader::still_transform(const Position& at) const {
    if (state_.start != state_.end) fail(at, "motion is not supported yet");
    return state_.start;
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
    for (Light& light : scene_.lights) light.L *= exposure;
    if (!has_filter_) {
        notes_.push_back(printable(scene_.file) +
                         ": note: no PixelFilter: pbrt's \"gaussian\" is replaced by the box");
    }
    return std::move(scene_);
}

}  // namespace

Scene parse_scene(const std::string& path, std::string text, std::vector<std::string>* notes) {
    Notes unread;
    SceneReader reader(path, notes ? *notes : unread);
    reader.read(path, std::move(text));
    return reader.finish();
}

Scene load_scene(const std::string& path, std::vector<std::string>* notes) {
    return parse_scene(path, read_file(path), notes);
}
