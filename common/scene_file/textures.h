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
    Rgb most;               // an upper bound of its values
    bool needs_uv = false;  // varies over the surface
    int depth = 1;          // of textures that are made of textures
};

/// Reads textures and finds them by name. Those of type "float" are known by name alone: a material
/// that names one is refused.
class TextureReader {
public:
    TextureReader(const Limits& limits, NamedFiles& files) : limits_(limits), files_(files) {}

    /// Reads what stands after the word Texture.
    void read(Lexer& lexer, const Token& word, Messages& notes);
    /// The texture that a parameter "texture NAME" names; nothing where it is not given.
    std::optional<NamedTexture> find(Params& params, const std::string& name) const;

    const Textures& textures() const { return textures_; }
    Textures take() { return std::move(textures_); }

private:
    struct Picture {
        uint32_t number = 0;  // into Textures::pictures
        std::string error;    // of a file that is no picture
    };
    NamedTexture read_spectrum(Params& params, Messages& notes);
    NamedTexture read_input(Params& params, const std::string& name, Rgb fallback);
    NamedTexture read_picture(Params& params, Messages& notes);
    uint32_t picture(Params& params, const Position& at, float gamma);
    void read_texels(const std::string& path, const Position& at, float gamma);
    uint32_t add(const Position& at, const Texture& texture);

    const Limits limits_;
    NamedFiles& files_;
    Textures textures_;
    std::map<std::string, std::optional<NamedTexture>> known_;   // nothing: of type "float"
    std::map<std::pair<std::string, float>, Picture> pictures_;  // by canonical name and gamma
    uint64_t texels_ = 0;
};

/// A reflectance in [0,1]; nothing when it is not given.
std::optional<Rgb> read_reflectance(Params& params, const std::string& name);
