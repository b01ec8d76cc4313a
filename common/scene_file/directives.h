// The state of reading a pbrt-v4 scene file, and what each directive does to it.
#pragma once
#include <map>
#include <optional>

#include "common/scene/mover.h"
#include "common/scene/sky_image.h"
#include "common/scene_file/shapes.h"

/// Keeps what has been read, and what holds for what comes next. Each directive is one function,
/// which reads what follows the directive's word.
class Directives {
public:
    Directives(const std::string& path, const Limits& limits, const Report& report,
               SceneNotes& notes)
        : limits_(limits), files_(path, limits, report), notes_(notes) {
        scene_.origin = std::make_shared<Origin>(Origin{path, {}, 0, {}});
        scene_.materials.emplace_back();  // of shapes that are given none
    }

    NamedFiles& files() { return files_; }
    bool in_world() const { return in_world_; }
    /// How many blocks are open.
    size_t depth() const { return saved_.size(); }
    /// The scene, once all directives are read; throws for what is missing.
    Scene finish();

    // Both before and after WorldBegin.
    void move(Lexer& lexer, const Token& word);
    void active_transform(Lexer& lexer, const Token& word);
    void attribute(Lexer& lexer, const Token& word);
    void coordinate_system(Lexer& lexer, const Token& word);
    void coord_sys_transform(Lexer& lexer, const Token& word);
    void color_space(Lexer& lexer, const Token& word);
    void make_named_medium(Lexer& lexer, const Token& word);
    void medium_interface(Lexer& lexer, const Token& word);
    void transform_times(Lexer& lexer, const Token& word);
    // Before WorldBegin.
    void camera(Lexer& lexer, const Token& word);
    void film(Lexer& lexer, const Token& word);
    void option(Lexer& lexer, const Token& word);
    void setting(Lexer& lexer, const Token& word);
    void world_begin(Lexer& lexer, const Token& word);
    // After WorldBegin.
    void area_light_source(Lexer& lexer, const Token& word);
    void begin(Lexer& lexer, const Token& word);
    void end(Lexer& lexer, const Token& word);
    void light_source(Lexer& lexer, const Token& word);
    void make_named_material(Lexer& lexer, const Token& word);
    void material(Lexer& lexer, const Token& word);
    void named_material(Lexer& lexer, const Token& word);
    void object_begin(Lexer& lexer, const Token& word);
    void object_end(Lexer& lexer, const Token& word);
    void object_instance(Lexer& lexer, const Token& word);
    void reverse_orientation(Lexer& lexer, const Token& word);
    void shape(Lexer& lexer, const Token& word);
    void texture(Lexer& lexer, const Token& word);

private:
    // What AttributeBegin saves and AttributeEnd restores.
    struct State {
        Transform start, end;  // the current transform when the shutter opens and when it closes
        std::string unusable;  // why nothing can stand there, as a message
        bool only_projects = false;             // that is no reason for a sky, which has no place
        bool set_start = true, set_end = true;  // which of them a transform directive changes
        uint32_t material = 0;                  // into Scene::materials
        std::optional<AreaEmission> emission;
        bool reverse_orientation = false;
        std::map<std::string, std::vector<Param>> defaults;  // of Attribute, by what they are for
    };

    struct SavedState {
        State state;
        Position at;
        std::string begin;  // AttributeBegin, or TransformBegin
    };

    /// The shapes between ObjectBegin and ObjectEnd, which each ObjectInstance places.
    struct Object {
        bool defined = false;
        std::vector<std::pair<Params, State>> shapes;
        std::vector<std::pair<Position, State>> early;  // instances that stand before it
    };

    struct NamedMaterial {
        uint32_t index = 0;  // into Scene::materials
        bool defined = false;
        Position first_use;
    };

    Params read_params(Lexer& lexer, const Token& word, const std::string& target);
    void place(Params& params, const State& where);
    void place_object(const Object& object, const Position& at, const State& state);
    uint32_t find_material(const std::string& name, const Position& at);
    const Transform& still_transform(Params& params) const;
    bool is_left_out(Params& params, const State& where);
    void check_names() const;
    void check_uvs(const Geometry& g);
    void check_complete();
    void stand_in_for_missing();
    void read_mover(Params& params, const State& where, ShapeState& state);

    Scene scene_;
    std::optional<SkyImage> sky_image_;
    const Limits limits_;
    NamedFiles files_;
    SceneNotes& notes_;
    TextureReader textures_{limits_, files_, notes_};
    Exposure exposure_;
    State state_;
    std::vector<SavedState> saved_;
    std::map<std::string, NamedMaterial> named_materials_;
    std::set<uint32_t> absent_;  // materials of surfaces that are as if they were not there
    std::map<std::string, std::pair<Transform, Transform>> coordinate_systems_;  // start and end
    std::map<std::string, Object> objects_;
    Object* open_object_ = nullptr;  // the one that is being defined
    uint64_t object_numbers_ = 0, placed_ = 0;
    uint64_t moving_primitives_ = 0, moving_vertices_ = 0;  // of all movers
    bool in_world_ = false, has_camera_ = false, has_filter_ = false, has_sky_image_ = false;
};

/// The string that must follow a directive; throws `DIRECTIVE needs WHAT in quotes`.
Token expect_string(Lexer& lexer, const Token& word, const std::string& what);
