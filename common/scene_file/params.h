// The parameters that follow a directive of a pbrt-v4 scene file: `"float fov" 45`.
#pragma once
#include "common/base/vec.h"
#include "common/scene_file/input.h"
#include "common/scene_file/lexer.h"

struct Param {
    std::string type, name;
    Position at;
    std::vector<double> numbers;  // also of integers, points and colors; of bools 0 or 1
    std::vector<std::string> strings;
    bool is_default = false;  // given by Attribute, also to directives that do not know it
};

/// Reads a declaration and its value or values, and checks that they fit the type.
Param read_param(Lexer& lexer);

/// A row of the table of parameters, see supported.cpp. Words are separated by blanks.
struct ParamRow {
    const char *directive, *kinds;                 // kinds: the types of the directive
    const char *types, *names;                     // types: such as "rgb or texture"
    double fallback = 0, low = -double{infinity};  // of each number
    double high = double{infinity};
    size_t values = 1;          // how many numbers, points or strings; 0: any number
    const char* stand_in = "";  // of parameters that only pbrt has
};
/// The rows of the parameters of a directive of one type, by their names.
using KnownParams = std::map<std::string, const ParamRow*>;
/// Those of each directive, by its type, such as those of Shape and "disk".
const std::map<std::string, std::map<std::string, KnownParams>>& known_params();

/// The words between blanks.
std::vector<std::string> words_of(const std::string& text);

/// The parameters of one directive, of which all that is wrong is told. Those that cannot be used
/// are left out; of two with one name the last one counts.
class Params {
public:
    /// Reads what follows `directive`: its type, such as "perspective", and the parameters up to a
    /// token that is none; `defaults` count where it has none of their name. Throws for a type that
    /// is unknown.
    Params(Lexer& lexer, const std::string& directive, const Position& at, Input& input,
           const std::vector<Param>& defaults = {});

    const std::string& type() const { return type_; }
    /// Whether the type is not supported: what is read stands in for it.
    bool stands_in() const { return stands_in_; }
    Input& input() const { return *input_; }

    /// Where the directive stands, and where a parameter does (the directive if it is not given).
    const Position& at() const { return at_; }
    const Position& at(const std::string& name) const {
        const Param* param = find(name);
        return param ? param->at : at_;
    }
    /// The directive and its type, for messages.
    std::string owner() const { return directive_ + ' ' + quote(type_); }
    /// Says of the directive that it is not done as the file says, or is not modelled.
    void note(const std::string& text) const { input_->note(at_, text); }
    void stand_in(const std::string& what) const { input_->stand_in(at_, what); }

    /// The parameter of this name; null if not given.
    const Param* find(const std::string& name) const;
    /// The same; throws if not given.
    const Param& required(const std::string& name) const;
    /// The value of a parameter; where it is not given that of the table, or the one given here.
    float number(const std::string& name) const;
    float number(const std::string& name, float fallback) const;
    int integer(const std::string& name) const { return static_cast<int>(number(name)); }
    bool boolean(const std::string& name) const { return number(name) != 0; }
    std::string string(const std::string& name, const std::string& fallback = "") const {
        const Param* param = find(name);
        return param ? param->strings[0] : fallback;
    }
    /// All points, vectors or normals; none where the parameter is not given.
    std::vector<Vec3> points(const std::string& name) const;
    Vec3 point(const std::string& name, Vec3 fallback) const {
        std::vector<Vec3> all = points(name);
        return all.empty() ? fallback : all[0];
    }
    /// An `rgb`, or the color of luminance 1 of a `blackbody`.
    Rgb color(const std::string& name) const;

private:
    void check_type(const Position& at);
    bool is_usable(const Param& param) const;

    Input* input_;
    Position at_;
    std::string directive_, type_;
    bool stands_in_ = false;
    const KnownParams* known_ = nullptr;
    std::vector<Param> params_;
};
