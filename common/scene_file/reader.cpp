#include "common/scene_file/reader.h"

#include <algorithm>

#include "common/base/numbers.h"
#include "common/scene/origin.h"
#include "common/scene_file/directives.h"

namespace {

// Where a directive may stand, and what reads it.
enum class Block { options, world, both };
struct Directive {
    Block block;
    void (Directives::*read)(Lexer&, const Token&);
};

// All but Include and Import, which are read here.
using D = Directives;
const std::map<std::string, Directive, std::less<>> known_directives = {
    {"Accelerator", {Block::options, &D::setting}},
    {"ActiveTransform", {Block::both, &D::active_transform}},
    {"AreaLightSource", {Block::world, &D::area_light_source}},
    {"Attribute", {Block::both, &D::attribute}},
    {"AttributeBegin", {Block::world, &D::begin}},
    {"AttributeEnd", {Block::world, &D::end}},
    {"Camera", {Block::options, &D::camera}},
    {"ColorSpace", {Block::both, &D::color_space}},
    {"ConcatTransform", {Block::both, &D::move}},
    {"CoordSysTransform", {Block::both, &D::coord_sys_transform}},
    {"CoordinateSystem", {Block::both, &D::coordinate_system}},
    {"Film", {Block::options, &D::film}},
    {"Identity", {Block::both, &D::move}},
    {"Integrator", {Block::options, &D::setting}},
    {"LightSource", {Block::world, &D::light_source}},
    {"LookAt", {Block::both, &D::move}},
    {"MakeNamedMaterial", {Block::world, &D::make_named_material}},
    {"MakeNamedMedium", {Block::both, &D::make_named_medium}},
    {"Material", {Block::world, &D::material}},
    {"MediumInterface", {Block::both, &D::medium_interface}},
    {"NamedMaterial", {Block::world, &D::named_material}},
    {"ObjectBegin", {Block::world, &D::object_begin}},
    {"ObjectEnd", {Block::world, &D::object_end}},
    {"ObjectInstance", {Block::world, &D::object_instance}},
    {"Option", {Block::options, &D::option}},
    {"PixelFilter", {Block::options, &D::setting}},
    {"ReverseOrientation", {Block::world, &D::reverse_orientation}},
    {"Rotate", {Block::both, &D::move}},
    {"Sampler", {Block::options, &D::setting}},
    {"Scale", {Block::both, &D::move}},
    {"Shape", {Block::world, &D::shape}},
    {"Texture", {Block::world, &D::texture}},
    {"Transform", {Block::both, &D::move}},
    {"TransformBegin", {Block::world, &D::begin}},
    {"TransformEnd", {Block::world, &D::end}},
    {"TransformTimes", {Block::options, &D::transform_times}},
    {"Translate", {Block::both, &D::move}},
    {"WorldBegin", {Block::options, &D::world_begin}},
};

/// Reads directive by directive, in one file and in all that it includes. What is wrong with one
/// directive does not keep it from reading the next.
class Reader {
public:
    Reader(const std::string& path, const Limits& limits, const Report& report,
           std::vector<std::string>& notes, bool stand_ins)
        : main_file_(path),
          limits_(limits),
          report_(report),
          notes_(notes, stand_ins),
          directives_(path, limits, report, notes_) {}

    Scene read_scene(std::string text);

private:
    void read(const std::string& path, std::string text);
    void read_directive(Lexer& lexer, const Token& word);
    void include(Lexer& lexer, const Token& word);

    const std::string main_file_;
    const Limits limits_;
    const Report report_;
    SceneNotes notes_;
    std::vector<std::string> error_lines_;
    Messages errors_{"error", error_lines_};
    Directives directives_;
    std::vector<std::string> open_files_;  // by their canonical names
    std::set<std::string> options_read_;   // Camera and its like
    uint64_t directives_read_ = 0;
    int includes_ = 0;
};

// Whether a token looks like none that begins a directive.
bool is_argument(const Token& token) {
    if (token.type != Token::word) return token.type != Token::end;
    return token.text[0] < 'A' || token.text[0] > 'Z';
}

// Reads over what a directive that cannot be used leaves behind, up to what looks like the next.
void skip_arguments(Lexer& lexer) {
    while (is_argument(lexer.peek())) lexer.next();
}

Scene Reader::read_scene(std::string text) {
    try {
        directives_.files().add_to_checksum(text);
        read(main_file_, std::move(text));
        // What is missing may be in what could not be used.
        if (error_lines_.empty()) {
            Scene scene = directives_.finish();
            Origin origin = {main_file_, directives_.files().files_read(),
                             directives_.files().checksum(), notes_.used()};
            origin.files.insert(main_file_);
            scene.origin = std::make_shared<Origin>(std::move(origin));
            return scene;
        }
    } catch (const InputError& error) {
        errors_.add(error);
    } catch (const ReadingEnds& end) {
        errors_.add(InputError(end.what()));
    }
    throw InputError(join_lines(error_lines_));
}

void Reader::read(const std::string& path, std::string text) {
    Lexer lexer(path, std::move(text), report_);
    open_files_.push_back(canonical(path));
    for (Token token = lexer.next(); token.type != Token::end; token = lexer.next()) {
        try {
            read_directive(lexer, token);
        } catch (const InputError& error) {
            errors_.add(error);
            if (error_lines_.size() >= most_errors) {
                stop_reading({main_file_}, too_much_is_wrong);
            }
            skip_arguments(lexer);
        }
    }
    open_files_.pop_back();
}

void Reader::read_directive(Lexer& lexer, const Token& word) {
    Position at = lexer.at(word);
    if (++directives_read_ > limits_.directives) {
        stop_reading(at, "more than " + std::to_string(limits_.directives) + " directives");
    }
    if (word.type != Token::word || to_number(word.text)) {
        fail(at, "expected a directive, not " + Lexer::describe(word));
    }
    std::string name(word.text);
    if (name == "Include" || name == "Import") return include(lexer, word);
    auto found = known_directives.find(name);
    if (found == known_directives.end()) {
        if (name == "WorldEnd") fail(at, "WorldEnd is not part of pbrt-v4: leave it out");
        std::vector<std::string> known = {"Import", "Include"};
        for (const auto& [directive, how] : known_directives) known.push_back(directive);
        // Else each directive of the block would be wrong too.
        bool is_block = nearest_word(name, known).ends_with("Begin");
        if (is_block) stop_reading(at, unknown("directive", name, known));
        fail_unknown(at, "directive", name, known);
    }
    auto [block, read] = found->second;
    bool in_world = directives_.in_world();
    if (name == "WorldBegin" && in_world) fail(at, "a second WorldBegin");
    if (block == Block::options && in_world) fail(at, name + " must stand before WorldBegin");
    if (block == Block::world && !in_world) fail(at, name + " must stand after WorldBegin");
    if (block == Block::options && name != "Option" && !options_read_.insert(name).second) {
        notes_.add(at, "a second " + name + ": the last one counts");
    }
    (directives_.*read)(lexer, word);
}

void Reader::include(Lexer& lexer, const Token& word) {
    constexpr size_t deepest = 100;
    constexpr int most = 10000;
    Token token = expect_string(lexer, word, "a file name");
    Position at = lexer.at(token);
    std::string path = directives_.files().find(at, lexer.unescape(token));
    std::string file = canonical(path);
    if (std::find(open_files_.begin(), open_files_.end(), file) != open_files_.end()) {
        fail(at, quote_file(path) + " includes itself");
    }
    if (open_files_.size() > deepest)
        stop_reading(at, "files include each other more than 100 deep");
    if (++includes_ > most) stop_reading(at, "more than 10000 files are included");
    std::string text;
    try {
        text = directives_.files().read(path, at);
    } catch (const InputError&) {
        if (!notes_.stand_ins()) throw;
        notes_.stand_in(at, "a scene file that cannot be read");
        return;
    }
    if (word.text == "Include") return read(path, std::move(text));
    // What Import changes, it changes for the file alone.
    if (!directives_.in_world()) fail(lexer.at(word), "Import must stand after WorldBegin");
    directives_.begin(lexer, word);
    size_t depth = directives_.depth();
    read(path, std::move(text));
    if (directives_.depth() != depth) fail(at, quote_file(path) + " has a block without its end");
    directives_.end(lexer, word);
}

}  // namespace

Scene parse_scene(const std::string& path, std::string text, std::vector<std::string>* notes,
                  const Report& report, const Limits& limits, bool stand_ins) {
    std::vector<std::string> unread;
    Reader reader(path, limits, report, notes ? *notes : unread, stand_ins);
    return reader.read_scene(std::move(text));
}

Scene load_scene(const std::string& path, std::vector<std::string>* notes, const Report& report,
                 bool stand_ins) {
    return parse_scene(path, read_scene_file(path), notes, report, {}, stand_ins);
}
