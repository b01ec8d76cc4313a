#include "common/scene_file/reader.h"

#include <algorithm>
#include <filesystem>

#include "common/base/files.h"
#include "common/base/numbers.h"
#include "common/scene_file/directives.h"
#include "common/scene_file/named_files.h"

namespace {

// Where a directive may stand, and what reads it; null: pbrt has it and we do not.
enum class Block { options, world, both };
struct Directive {
    Block block;
    void (Directives::*read)(Lexer&, const Token&);
};

// All but Include, which is read here.
using D = Directives;
const std::map<std::string, Directive, std::less<>> known_directives = {
    {"Accelerator", {Block::options, &D::accelerator}},
    {"ActiveTransform", {Block::both, &D::active_transform}},
    {"AreaLightSource", {Block::world, &D::area_light_source}},
    {"Attribute", {Block::both, nullptr}},
    {"AttributeBegin", {Block::world, &D::begin}},
    {"AttributeEnd", {Block::world, &D::end}},
    {"Camera", {Block::options, &D::camera}},
    {"ColorSpace", {Block::both, &D::color_space}},
    {"ConcatTransform", {Block::both, &D::move}},
    {"CoordSysTransform", {Block::both, nullptr}},
    {"CoordinateSystem", {Block::both, nullptr}},
    {"Film", {Block::options, &D::film}},
    {"Identity", {Block::both, &D::move}},
    {"Import", {Block::both, nullptr}},
    {"Integrator", {Block::options, &D::integrator}},
    {"LightSource", {Block::world, &D::light_source}},
    {"LookAt", {Block::both, &D::move}},
    {"MakeNamedMaterial", {Block::world, &D::make_named_material}},
    {"MakeNamedMedium", {Block::both, nullptr}},
    {"Material", {Block::world, &D::material}},
    {"MediumInterface", {Block::both, nullptr}},
    {"NamedMaterial", {Block::world, &D::named_material}},
    {"ObjectBegin", {Block::both, nullptr}},
    {"ObjectEnd", {Block::both, nullptr}},
    {"ObjectInstance", {Block::both, nullptr}},
    {"Option", {Block::options, &D::option}},
    {"PixelFilter", {Block::options, &D::pixel_filter}},
    {"ReverseOrientation", {Block::world, &D::reverse_orientation}},
    {"Rotate", {Block::both, &D::move}},
    {"Sampler", {Block::options, &D::sampler}},
    {"Scale", {Block::both, &D::move}},
    {"Shape", {Block::world, &D::shape}},
    {"Texture", {Block::both, nullptr}},
    {"Transform", {Block::both, &D::move}},
    {"TransformBegin", {Block::world, &D::begin}},
    {"TransformEnd", {Block::world, &D::end}},
    {"TransformTimes", {Block::both, nullptr}},
    {"Translate", {Block::both, &D::move}},
    {"WorldBegin", {Block::options, &D::world_begin}},
};

/// Reads directive by directive, in one file and in all that it includes.
class Reader {
public:
    Reader(const std::string& path, Notes& notes) : directives_(path, notes) {}

    void read(const std::string& path, std::string text);
    Scene finish() { return directives_.finish(); }

private:
    void read_directive(Lexer& lexer, const Token& word);
    void include(Lexer& lexer, const Token& word);

    Directives directives_;
    std::vector<std::string> open_files_;  // by their canonical names
    int includes_ = 0;
};

// The one name of a file that has many, such as a/../b.
std::string canonical(const std::string& path) {
    std::error_code none;
    return std::filesystem::weakly_canonical(path, none).string();
}

void Reader::read(const std::string& path, std::string text) {
    open_files_.push_back(canonical(path));
    Lexer lexer(path, std::move(text));
    for (Token token = lexer.next(); token.type != Token::end; token = lexer.next()) {
        read_directive(lexer, token);
    }
    open_files_.pop_back();
}

void Reader::read_directive(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    if (word.type != Token::word || to_number(word.text)) {
        fail(at, "expected a directive, not " + Lexer::describe(word));
    }
    std::string name(word.text);
    if (name == "Include") return include(lexer, word);
    auto found = known_directives.find(name);
    if (found == known_directives.end()) {
        if (name == "WorldEnd") fail(at, "WorldEnd is not part of pbrt-v4: leave it out");
        std::vector<std::string> known = {"Include"};
        for (const auto& [directive, how] : known_directives) {
            if (how.read) known.push_back(directive);
        }
        fail_unknown(at, "directive", name, known);
    }
    auto [block, read] = found->second;
    bool in_world = directives_.in_world();
    if (!read) fail(at, name + " is not supported");
    if (name == "WorldBegin" && in_world) fail(at, "a second WorldBegin");
    if (block == Block::options && in_world) fail(at, name + " must stand before WorldBegin");
    if (block == Block::world && !in_world) fail(at, name + " must stand after WorldBegin");
    (directives_.*read)(lexer, word);
}

void Reader::include(Lexer& lexer, const Token& word) {
    constexpr size_t deepest = 100;
    constexpr int most = 10000;
    Token token = expect_string(lexer, word, "a file name");
    Position at = lexer.at(token);
    std::string path = find_named_file(directives_.main_file(), at, lexer.unescape(token));
    std::string file = canonical(path);
    if (std::find(open_files_.begin(), open_files_.end(), file) != open_files_.end()) {
        fail(at, quote(path) + " includes itself");
    }
    if (open_files_.size() > deepest) fail(at, "files include each other more than 100 deep");
    if (++includes_ > most) fail(at, "more than 10000 files are included");
    read(path, read_named_file(path, at));
}

}  // namespace

Scene parse_scene(const std::string& path, std::string text, std::vector<std::string>* notes) {
    Notes unread;
    Reader reader(path, notes ? *notes : unread);
    reader.read(path, std::move(text));
    return reader.finish();
}

Scene load_scene(const std::string& path, std::vector<std::string>* notes) {
    return parse_scene(path, read_file(path), notes);
}
