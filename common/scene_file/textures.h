// Textures of a pbrt-v4 scene file.
#pragma once
#include <map>
#include <optional>

#include "common/scene/texture.h"
#include "common/scene_file/named_files.h"
#include "common/scene_file/params.h"

/// A texture, and what a material that names it must know.
struct NamedTexture {
    uint32_t index = 0;     // into Textures::all
    Rgb most, mean;         // an upper bound of its values, and what they are on average
    bool needs_uv = false;  // varies over the surface
    int depth = 1;          // of textures that are made of textures
};

/// Reads textures and finds them by name. Of those of type "float" only the names are kept.
class TextureReader {
public:
    TextureReader(const Limits& limits, NamedFiles& files, SceneNotes& notes)
        : limits_(limits), files_(files), notes_(notes) {}

    /// Reads what stands after the word Texture; defaults: of Attribute.
    void read(Lexer& lexer, const Token& word, const std::vector<Param>& defaults);
    /// The texture that a parameter "texture NAME" names; nothing where it is not given.
    std::optional<NamedTexture> find(Params& params, const std::string& name);
    /// What the texture of this number is on average.
    Rgb mean(uint32_t texture) const { return means_[texture]; }
    Textures take() { return std::move(textures_); }

private:
    struct Picture {
        uint32_t number = 0;  // into Textures::pictures
        std::string error;    // of a file that is no picture; the texel of its stand-in is grey
    };
    NamedTexture read_spectrum(Params& params);
    NamedTexture read_input(Params& params, const std::string& name, Rgb fallback);
    NamedTexture read_picture(Params& params);
    uint32_t picture(Params& params, const Position& at, float gamma);
    void read_texels(const std::string& path, const Position& at, float gamma);
    uint32_t add(const Position& at, const Texture& texture, Rgb mean);

    const Limits limits_;
    NamedFiles& files_;
    SceneNotes& notes_;
    Textures textures_;
    std::vector<Rgb> means_;  // of each
    std::map<std::string, NamedTexture> known_;
    std::set<std::string> floats_;
    std::map<std::pair<std::string, float>, Picture> pictures_;  // by canonical name and gamma
    uint64_t texels_ = 0;
};

/// A reflectance in [0,1]; nothing when it is not given.
std::optional<Rgb> read_reflectance(Params& params, const std::string& name);
