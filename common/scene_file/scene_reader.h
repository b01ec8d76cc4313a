// The state of reading a pbrt-v4 scene file, and what each directive does to it.
#pragma once
#include <map>

#include "common/scene_file/shapes.h"

/// Reads directive by directive, and keeps the state that they change.
class SceneReader {
public:
    SceneReader(const std::string& path, Notes& notes) : notes_(notes) {
        scene_.file = path;
        scene_.materials.emplace_back();  // of shapes that are given none
    }

    void read(const std::string& path, std::string text);
    Scene finish();

private:
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
    std::vector<std::string> open_files_;  // by their canonical names
    int includes_ = 0;
    bool in_world_ = false, has_camera_ = false, has_filter_ = false;
};

/// The string that must follow a directive; throws `DIRECTIVE needs WHAT in quotes`.
Token expect_string(Lexer& lexer, const Token& word, const std::string& what);
