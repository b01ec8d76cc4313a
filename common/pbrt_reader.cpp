#include "common/pbrt_reader.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>

#include "common/files.h"
#include "common/pbrt_files.h"
#include "common/pbrt_shapes.h"

namespace {

// What AttributeBegin saves and AttributeEnd restores.
struct State {
    Transform start, end;  // the current transform when the shutter opens and when it closes
    bool set_start = true, set_end = true;  // which of them the next transform changes
    uint32_t material = 0;
    std::optional<AreaEmission> emission;
    bool reverse_orientation = false;
};

struct NamedMaterial {
    uint32_t index;
    bool defined = false;
    Position first_use;
};

const std::vector<std::string> transform_words = {
    "Identity", "Translate", "Scale", "Rotate", "LookAt", "Transform", "ConcatTransform"};
const std::vector<std::string> option_words = {"Camera",  "Film",       "PixelFilter",
                                               "Sampler", "Integrator", "Accelerator",
                                               "Option",  "WorldBegin"};
const std::vector<std::string> world_words = {
    "AttributeBegin",     "AttributeEnd", "TransformBegin", "TransformEnd",
    "ReverseOrientation", "Material",     "NamedMaterial",  "MakeNamedMaterial",
    "AreaLightSource",    "LightSource",  "Shape"};
const std::vector<std::string> other_words = {"ActiveTransform", "ColorSpace", "Include"};
// What pbrt has and we do not.
const std::vector<std::string> pbrt_only = {"Attribute",   "CoordinateSystem", "CoordSysTransform",
                                            "Import",      "MakeNamedMedium",  "MediumInterface",
                                            "ObjectBegin", "ObjectEnd",        "ObjectInstance",
                                            "Texture",     "TransformTimes"};

bool contains(const std::vector<std::string>& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

// Reads directive by directive, and keeps what pbrt calls the graphics state.
class SceneReader {
public:
    SceneReader(const std::string& path, Notes& notes) : notes_(notes) {
        scene_.file = path;
        scene_.materials.emplace_back();  // what shapes have that are given none
    }

    void read(const std::string& path, std::string text);
    Scene finish();

private:
    void read_directive(Lexer& lexer, const Token& word);
    void read_transform(Lexer& lexer, const Token& word);
    void read_option_directive(Lexer& lexer, const Token& word);
    void read_world_directive(Lexer& lexer, const Token& word);
    void read_other_directive(Lexer& lexer, const Token& word);
    void begin_attribute(const Position& at, const Token& word);
    void end_attribute(const Position& at, const Token& word);
    void include(Lexer& lexer);
    void name_material(Lexer& lexer, const Token& word);
    void use_material(Lexer& lexer);
    uint32_t find_material(const std::string& name, const Position& at);
    const Transform& still_transform(const Position& at) const;
    void check_scene() const;

    Scene scene_;
    Notes& notes_;
    Exposure exposure_;
    State state_;
    struct Saved {
        State state;
        Position at;
        std::string begin;
    };
    std::vector<Saved> saved_;
    std::map<std::string, NamedMaterial> named_materials_;
    std::vector<std::string> open_files_;
    int includes_ = 0;
    bool in_world_ = false, has_camera_ = false, has_filter_ = false;
};

double read_plain_number(Lexer& lexer, const Token& word) {
    Token token = lexer.next();
    std::optional<double> value = to_number(token.text);
    if (token.type != Token::word || !value) {
        fail(lexer.at(token),
             std::string(word.text) + " needs a number here, not " + Lexer::describe(token));
    }
    if (!(std::abs(*value) <= std::numeric_limits<float>::max())) {
        fail(lexer.at(token), "number too large: " + std::string(token.text.substr(0, 60)));
    }
    return *value;
}

Double3 read_three(Lexer& lexer, const Token& word) {
    double x = read_plain_number(lexer, word), y = read_plain_number(lexer, word);
    return {x, y, read_plain_number(lexer, word)};
}

// [ 16 numbers ], column by column.
Transform read_matrix(Lexer& lexer, const Token& word) {
    auto expect = [&](Token::Type type, const char* bracket) {
        Token token = lexer.next();
        if (token.type == type) return;
        fail(lexer.at(token),
             std::string(word.text) + " needs " + bracket + " here, not " + Lexer::describe(token));
    };
    expect(Token::open, "[ and 16 numbers");
    std::array<double, 16> m;
    for (double& x : m) x = read_plain_number(lexer, word);
    expect(Token::close, "] after 16 numbers");
    constexpr double tolerance = 1e-6;
    double bottom = std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1);
    if (bottom > tolerance) {
        fail(lexer.at(word), std::string(word.text) +
                                 " must not project: the 4th, 8th, 12th and "
                                 "16th number must be 0 0 0 1");
    }
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

bool is_usable(const Transform& t) {
    double det = determinant(t);
    bool finite = std::isfinite(det) && std::isfinite(t.o[0] + t.o[1] + t.o[2]);
    return finite && std::abs(det) > 1e-60 && std::abs(det) < 1e60;
}

void SceneReader::read(const std::string& path, std::string text) {
    open_files_.push_back(path);
    Lexer lexer(path, std::move(text));
    for (Token token = lexer.next(); token.type != Token::end; token = lexer.next()) {
        if (token.type != Token::word) {
            fail(lexer.at(token), "expected a directive, not " + Lexer::describe(token));
        }
        read_directive(lexer, token);
    }
    open_files_.pop_back();
}

void SceneReader::read_directive(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    bool is_option = contains(option_words, word.text);
    bool is_world = contains(world_words, word.text);
    if (is_option && in_world_) {
        fail(at, std::string(word.text) + " must stand before WorldBegin");
    }
    if (is_world && !in_world_) fail(at, std::string(word.text) + " must stand after WorldBegin");
    if (contains(transform_words, word.text)) {
        read_transform(lexer, word);
    } else if (is_option) {
        read_option_directive(lexer, word);
    } else if (is_world) {
        read_world_directive(lexer, word);
    } else {
        read_other_directive(lexer, word);
    }
}

void SceneReader::read_transform(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    Transform t;
    bool replaces = word.text == "Identity" || word.text == "Transform";
    if (word.text == "Translate") {
        t = translation(read_three(lexer, word));
    } else if (word.text == "Scale") {
        t = scaling(read_three(lexer, word));
    } else if (word.text == "Rotate") {
        double degrees = read_plain_number(lexer, word);
        Double3 axis = read_three(lexer, word);
        if (length(axis) == 0) fail(at, "Rotate needs an axis that is not 0 0 0");
        t = rotation(degrees, axis);
    } else if (word.text == "LookAt") {
        Double3 eye = read_three(lexer, word), look = read_three(lexer, word);
        t = look_at(eye, look, read_three(lexer, word));
        if (!is_usable(t))
            fail(at, "LookAt needs two points, and an up that is not along the view");
        t = inverse(t);
    } else if (word.text != "Identity") {
        t = read_matrix(lexer, word);
    }
    for (auto [transform, set] :
         {std::pair{&state_.start, state_.set_start}, std::pair{&state_.end, state_.set_end}}) {
        if (set) *transform = replaces ? t : *transform * t;
        if (!is_usable(*transform)) {
            fail(at, "the transform has no inverse, or its numbers are too large or too small");
        }
    }
}

// The current transform; throws where it moves while the shutter is open.
const Transform& SceneReader::still_transform(const Position& at) const {
    if (state_.start != state_.end) fail(at, "motion is not supported yet");
    return state_.start;
}

void SceneReader::read_option_directive(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    if (word.text == "WorldBegin") {
        in_world_ = true;
        state_.start = state_.end = {};
        state_.set_start = state_.set_end = true;
        return;
    }
    Params params(lexer, word, word.text != "Option");
    if (word.text == "Camera") {
        read_camera(params, still_transform(at), scene_.camera, exposure_);
        has_camera_ = true;
    } else if (word.text == "Film") {
        read_film(params, scene_, exposure_, notes_);
    } else if (word.text == "PixelFilter") {
        read_pixel_filter(params, notes_);
        has_filter_ = true;
    } else if (word.text == "Sampler") {
        read_sampler(params, scene_, notes_);
    } else if (word.text == "Integrator") {
        read_integrator(params, scene_, notes_);
    } else if (word.text == "Accelerator") {
        read_accelerator(params, notes_);
    } else {
        read_option(params, notes_);
    }
}

void SceneReader::read_world_directive(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    if (word.text == "AttributeBegin" || word.text == "TransformBegin") {
        begin_attribute(at, word);
    } else if (word.text == "AttributeEnd" || word.text == "TransformEnd") {
        end_attribute(at, word);
    } else if (word.text == "ReverseOrientation") {
        state_.reverse_orientation = !state_.reverse_orientation;
    } else if (word.text == "NamedMaterial") {
        use_material(lexer);
    } else if (word.text == "MakeNamedMaterial") {
        name_material(lexer, word);
    } else {
        Params params(lexer, word);
        if (word.text == "Material") {
            scene_.materials.push_back(read_material(params));
            state_.material = static_cast<uint32_t>(scene_.materials.size()) - 1;
        } else if (word.text == "AreaLightSource") {
            state_.emission = read_area_light(params);
        } else if (word.text == "LightSource") {
            Light light = read_light(params, still_transform(at));
            if (!is_black(light.L)) scene_.lights.push_back(light);
        } else {
            read_shape(
                params,
                {still_transform(at), state_.material, state_.emission, state_.reverse_orientation},
                scene_, notes_);
        }
    }
}

void SceneReader::read_other_directive(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    if (word.text == "Include") return include(lexer);
    if (word.text == "ColorSpace") {
        Params params(lexer, word);
        std::vector<std::string> known = {"aces2065-1", "dci-p3", "rec2020", "srgb"};
        if (!contains(known, params.type())) params.fail_type(known);
        params.finish();
        if (params.type() != "srgb") {
            notes_.push_back(message_at(at, "note", params.owner() + " is read as \"srgb\""));
        }
    } else if (word.text == "ActiveTransform") {
        Token which = lexer.next();
        bool all = which.text == "All";
        if (!all && which.text != "StartTime" && which.text != "EndTime") {
            fail_unknown(lexer.at(which), "time", std::string(which.text),
                         {"All", "EndTime", "StartTime"});
        }
        state_.set_start = all || which.text == "StartTime";
        state_.set_end = all || which.text == "EndTime";
    } else {
        if (contains(pbrt_only, word.text)) {
            fail(at, std::string(word.text) + " is not supported");
        }
        if (to_number(word.text) || word.type != Token::word) {
            fail(at, "expected a directive, not " + Lexer::describe(word));
        }
        std::vector<std::string> known = transform_words;
        for (const auto& words : {option_words, world_words, other_words}) {
            known.insert(known.end(), words.begin(), words.end());
        }
        fail_unknown(at, "directive", std::string(word.text), known);
    }
}

void SceneReader::begin_attribute(const Position& at, const Token& word) {
    saved_.push_back({state_, at, std::string(word.text)});
}

void SceneReader::end_attribute(const Position& at, const Token& word) {
    if (saved_.empty()) fail(at, std::string(word.text) + " without its beginning");
    if (saved_.back().begin.front() != word.text.front()) {
        fail(at, std::string(word.text) + " closes the " + saved_.back().begin + " of line " +
                     std::to_string(saved_.back().at.line));
    }
    state_ = saved_.back().state;
    saved_.pop_back();
}

void SceneReader::include(Lexer& lexer) {
    Token token = lexer.next();
    Position at = lexer.at(token);
    if (token.type != Token::string) {
        fail(at, "Include needs a file name in quotes, not " + Lexer::describe(token));
    }
    constexpr int most = 10000;
    if (++includes_ > most) fail(at, "more than 10000 files included");
    NamedFile file = read_named_file(scene_.file, at, lexer.unescape(token));
    std::error_code ignored;
    for (const std::string& open : open_files_) {
        if (std::filesystem::equivalent(open, file.path, ignored)) {
            fail(at, "the file includes itself");
        }
    }
    read(file.path, std::move(file.bytes));
}

// The number of the named material, which may be defined only later.
uint32_t SceneReader::find_material(const std::string& name, const Position& at) {
    auto [place, is_new] = named_materials_.try_emplace(name);
    if (is_new) {
        place->second.index = static_cast<uint32_t>(scene_.materials.size());
        place->second.first_use = at;
        scene_.materials.emplace_back();
    }
    return place->second.index;
}

void SceneReader::name_material(Lexer& lexer, const Token& word) {
    Token token = lexer.peek();
    Position at = lexer.at(token);
    if (token.type != Token::string) {
        fail(at, "MakeNamedMaterial needs a name in quotes, not " + Lexer::describe(token));
    }
    std::string name = lexer.unescape(lexer.next());
    Params params(lexer, word, false);
    params.read_type();
    uint32_t index = find_material(name, at);
    if (named_materials_[name].defined) fail(at, "a second material " + quote(name));
    named_materials_[name].defined = true;
    scene_.materials[index] = read_material(params);
}

void SceneReader::use_material(Lexer& lexer) {
    Token token = lexer.next();
    if (token.type != Token::string) {
        fail(lexer.at(token),
             "NamedMaterial needs a name in quotes, not " + Lexer::describe(token));
    }
    state_.material = find_material(lexer.unescape(token), lexer.at(token));
}

void SceneReader::check_scene() const {
    auto refuse = [&](const std::string& text) {
        throw InputError(printable(scene_.file) + ": error: " + text);
    };
    if (!saved_.empty()) {
        fail(saved_.back().at, saved_.back().begin + " is never closed");
    }
    std::vector<std::string> known;
    for (const auto& [name, material] : named_materials_) {
        if (material.defined) known.push_back(name);
    }
    for (const auto& [name, material] : named_materials_) {
        if (!material.defined) fail_unknown(material.first_use, "NamedMaterial", name, known);
    }
    if (!in_world_) refuse("no WorldBegin");
    if (!has_camera_) refuse("no Camera");
    if (scene_.geometry.size() == 0) refuse("no Shape");
    if (scene_.lights.empty()) refuse("no lights: all would be black");
}

Scene SceneReader::finish() {
    check_scene();
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
