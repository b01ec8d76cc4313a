// Textures of a pbrt-v4 scene file.
#pragma once
#include "common/scene/texture.h"
#include "common/scene_file/files.h"
#include "common/scene_file/params.h"

/// A texture, and what a material that names it must know.
struct NamedTexture {
    uint32_t index = 0;     // into Textures::all
    Rgb most, mean;         // an upper bound of its values, and what they are on average
    bool needs_uv = false;  // varies over the surface
    uint64_t depth = 1;     // of textures that are made of textures
};

/// Reads textures and finds them by name. Those of type "float" are read over.
class TextureReader {
public:
    TextureReader(const Limits& limits, NamedFiles& files, Messages& messages)
        : limits_(limits), files_(files), messages_(messages) {}

    /// Reads what stands after the word Texture.
    void read(Lexer& lexer, const Token& word, const std::vector<Param>& defaults);
    /// The texture that a parameter "texture NAME" names; nothing where it is not given.
    std::optional<NamedTexture> find(const Params& params, const std::string& name) const;
    /// What the texture of this number is on average.
    Rgb mean(uint32_t texture) const { return means_[texture]; }
    Textures take() { return std::move(textures_); }

private:
    NamedTexture read_texture(const Params& params);
    NamedTexture read_scaled(const Params& params);
    NamedTexture read_checkerboard(const Params& params);
    NamedTexture read_input(const Params& params, const std::string& name);
    NamedTexture read_picture(const Params& params);
    uint32_t picture(const Params& params, float gamma);
    NamedTexture add(const Params& params, const Texture& texture, NamedTexture named);
    NamedTexture constant(const Params& params, Rgb value);

    const Limits limits_;
    NamedFiles& files_;
    Messages& messages_;
    Textures textures_;
    std::vector<Rgb> means_;  // of each
    std::map<std::string, NamedTexture> known_;
    std::map<std::pair<std::string, float>, uint32_t> pictures_;  // by canonical name and gamma
    uint64_t texels_ = 0;
};
