// The parameters that follow a directive of a pbrt-v4 scene file: `"float fov" 45`.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/vec.h"
#include "common/scene_file/param.h"
#include "common/scene_file/spectra.h"
#include "common/scene_file/stand_ins.h"

/// The colour of a parameter, or one of its numbers; throws for one that is not in the range.
Rgb read_rgb(const Param& param, float low, float high);
void check_range(const Param& param, double value, float low, float high);

/// The parameters of one directive. A directive asks for each that it knows; finish() then refuses
/// those that nobody asked for. Of a parameter given twice the last one counts, with a note.
///
/// Everything here throws InputError at the parameter for what cannot be used.
class Params {
public:
    /// Reads what follows `directive`: its type, such as "perspective" (where it has one), and the
    /// parameters up to a token that is none.
    ///
    /// defaults  parameters that Attribute has given: they count where the directive has none of
    ///           that name, and may be such as the directive does not know
    Params(Lexer& lexer, const Token& directive, SceneNotes& notes, bool has_type = true,
           const std::vector<Param>& defaults = {});

    const std::string& type() const { return type_; }
    const std::vector<Param>& all() const { return params_; }
    /// Takes the type from the parameter "string type", as MakeNamedMaterial gives it.
    void read_type();
    /// Whether the type has a stand-in that is to be taken, which is remembered.
    bool stands_in();
    /// Throws for a type that is none of the known ones.
    [[noreturn]] void fail_type(const std::vector<std::string>& known) const;

    /// Where the directive stands, and where a parameter does (the directive if it is not given).
    const Position& at() const { return at_; }
    const Position& at(const std::string& name) const;
    /// The directive and its type, for messages.
    std::string owner() const;

    /// The one value of a parameter, from `low` to `high`; `fallback` where it is not given.
    float number(const std::string& name, float fallback, float low = -infinity,
                 float high = infinity);
    int integer(const std::string& name, int fallback, int low, int high);
    bool boolean(const std::string& name, bool fallback);
    std::string string(const std::string& name, const std::string& fallback);
    Vec3 point(const std::string& name, Vec3 fallback);
    /// A color of components >= 0: `rgb`, or of luminance 1: `blackbody`.
    Rgb illuminant(const std::string& name, Rgb fallback);
    /// What a spectrum that is given by its name is; null where it is none of these, which is
    /// remembered.
    template <class Value>
    const Value* named(const Param& spectrum, const std::map<std::string, Value>& known);
    /// The parameter of this type and name; null if not given.
    const Param* find(const std::string& type, const std::string& name);
    /// The parameter of this type and name; an error unless it has exactly `count` values.
    const Param* find_exactly(const std::string& type, const std::string& name, size_t count);
    /// Accepts parameters that have no effect on what we render.
    void ignore(const std::string& type, const std::vector<std::string>& names);
    /// Remembers something that we have not, but have a stand-in for, named as in the table. It is
    /// an error for finish() to throw only where stand-ins are not allowed, `text` if it has one.
    void stand_in(const Position& at, const std::string& what, const std::string& text = "");
    /// The same for a parameter, where it is given.
    void replace(const std::string& type, const std::string& name, const std::string& what);
    /// Whether stand-ins are allowed.
    bool may_stand_in() const { return notes_->stand_ins(); }
    /// Reads something, such as a file that a parameter names, and returns whether that worked.
    /// What is wrong with it is remembered too, unless reading ends with it, or a stand-in is
    /// taken.
    bool read(const std::function<void()>& reader, const std::string& stand_in = "");
    /// Accepts all parameters that have not been asked for.
    void ignore_rest();
    /// Throws for what is not supported, and for parameters that have not been asked for.
    void finish();

private:
    void add(Param param);
    void refuse_old_type() const;
    std::string table_name() const;
    std::string what_is_wrong_with(const Param& param) const;

    SceneNotes* notes_;
    Position at_, type_at_;
    std::string directive_, type_;
    std::vector<Param> params_;
    std::vector<std::string> known_names_, known_types_;  // what was asked for
    std::vector<std::string> wrong_;                      // lines, for finish()
};
