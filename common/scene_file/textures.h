// Textures of a pbrt-v4 scene file, and the pictures that it names.
#pragma once
#include <algorithm>
#include <optional>

#include "common/picture/image.h"
#include "common/scene/texture.h"
#include "common/scene_file/params.h"

// What is made of each channel of one or two colors.
template <class Make>
Rgb each(const Make& make, Rgb a, Rgb b = {}) {
    return {make(a.r, b.r), make(a.g, b.g), make(a.b, b.b)};
}
inline Rgb larger(Rgb a, Rgb b) {
    return each([](float x, float y) { return std::max(x, y); }, a, b);
}

// Returns whether the mapping is "uv", not one that the mean of the texture stands in for.
inline bool read_mapping(const Params& params, Texture& texture) {
    texture.scale = {params.number("uscale"), params.number("vscale")};
    texture.shift = {params.number("udelta"), params.number("vdelta")};
    if (params.string("mapping", "uv") == "uv") return true;
    params.input().stand_in(params.at("mapping"), "a mapping other than \"uv\"");
    return false;
}

// How codes become linear values: to this power, or as sRGB codes (0).
inline float read_encoding(const Params& params) {
    std::string encoding = params.string("encoding", "sRGB");
    if (encoding == "sRGB") return 0;
    if (encoding == "linear") return 1;
    bool is_gamma = encoding.starts_with("gamma ");
    auto gamma = to_number(std::string_view(encoding).substr(is_gamma ? 6 : 0));
    if (is_gamma && gamma && *gamma >= 0.01 && *gamma <= 100) return static_cast<float>(*gamma);
    fail(params.at("encoding"), "encoding must be sRGB, linear, or gamma and 0.01 to 100");
}

inline const std::map<std::string, Texture::Wrap> wraps = {{"black", Texture::Wrap::black},
                                                           {"clamp", Texture::Wrap::clamp},
                                                           {"repeat", Texture::Wrap::repeat}};

/// The picture that "filename" names, of numbers from 0 to `most`. Nothing where its stand-in is to
/// be taken, grey.
///
/// gamma  how codes become linear values, see to_linear()
inline std::optional<Image> read_picture(const Params& params, float gamma, float most) {
    const Param& name = params.required("filename");
    Input& input = params.input();
    std::string path = input.find(name.at, name.strings[0]);
    Image image;
    bool is_read = input.try_to_read(params.at(), "a picture that cannot be read", [&] {
        image = decode_image(path, input.read(path, name.at), gamma);
        for (Rgb r : image.pixels) {
            if (is_finite(r) && std::min({r.r, r.g, r.b}) >= 0 && max_component(r) <= most)
                continue;
            fail(name.at, quote_file(path) +
                              " has a pixel that is negative, infinite, no number, or too bright");
        }
    });
    if (!is_read) return {};
    return image;
}

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
    /// Reads what stands after the word Texture.
    void read(Lexer& lexer, const Position& at, Input& input, const std::vector<Param>& defaults) {
        Token name_token = lexer.expect(Token::string, "Texture needs a name in quotes");
        Token type = lexer.expect(Token::string, "Texture needs \"float\" or \"spectrum\"");
        std::string name = lexer.unescape(name_token);
        if (type.text == "float") {
            lexer.expect(Token::string, "Texture needs a type in quotes");
            while (lexer.peek().type == Token::string) read_param(lexer);
            return;
        }
        Params params(lexer, "Texture", at, input, defaults);
        if (type.text != "spectrum") {
            fail_unknown(lexer.at(type), "type of texture", std::string(type.text),
                         {"float", "spectrum"});
        }
        if (known_.contains(name)) fail(lexer.at(name_token), "a second texture " + quote(name));
        known_[name] = read_texture(params);
    }
    /// The texture that a parameter "texture NAME" names; nothing where it is not given.
    std::optional<NamedTexture> find(const Params& params, const std::string& name) const {
        const Param* param = params.find(name);
        if (!param || param->type != "texture") return {};
        return look_up(known_, param->strings[0], "texture", param->at);
    }
    /// What the texture of this number is on average.
    Rgb mean(uint32_t texture) const { return means_[texture]; }
    Textures take() { return std::move(textures_); }

private:
    NamedTexture read_texture(const Params& params) {
        if (params.stands_in()) return constant(params, {0.5f, 0.5f, 0.5f});
        if (params.type() == "imagemap") return read_picture_texture(params);
        if (params.type() == "constant") return constant(params, params.color("value"));
        if (params.type() == "scale") return read_scaled(params);
        return read_checkerboard(params);
    }
    NamedTexture read_scaled(const Params& params) {
        NamedTexture result = read_input(params, "tex");
        float scale = params.number("scale");
        Texture texture;
        texture.kind = Texture::Kind::product;
        texture.value = {scale, scale, scale};
        texture.inputs = {result.index, result.index};
        auto scaled = [&](float x, float) { return std::min(1.0f, scale * x); };
        result.most = each(scaled, result.most);
        result.mean = each(scaled, result.mean);
        result.depth++;
        return add(params, texture, result);
    }
    NamedTexture read_checkerboard(const Params& params) {
        bool is_flat = params.integer("dimension") == 2;
        if (!is_flat) {
            params.input().stand_in(params.at("dimension"), "a checkerboard of 3 dimensions");
        }
        NamedTexture a = read_input(params, "tex1"), b = read_input(params, "tex2");
        Rgb mean = 0.5f * (a.mean + b.mean);
        Texture texture;
        texture.kind = Texture::Kind::checkerboard;
        texture.inputs = {a.index, b.index};
        is_flat &= read_mapping(params, texture);
        if (!is_flat) return constant(params, mean);
        return add(params, texture,
                   {0, larger(a.most, b.most), mean, true, 1 + std::max(a.depth, b.depth)});
    }
    // A texture, or one colour.
    NamedTexture read_input(const Params& params, const std::string& name) {
        std::optional<NamedTexture> texture = find(params, name);
        return texture ? *texture : constant(params, params.color(name));
    }
    NamedTexture read_picture_texture(const Params& params) {
        Texture texture;
        texture.kind = Texture::Kind::picture;
        bool is_uv = read_mapping(params, texture);
        texture.wrap = look_up(wraps, params.string("wrap", "repeat"), "wrap", params.at("wrap"));
        texture.nearest = params.string("filter") == "point";
        texture.inverted = params.boolean("invert");
        float scale = params.number("scale");
        texture.value = {scale, scale, scale};
        std::optional<uint32_t> number = picture(params, read_encoding(params));
        if (!number) return constant(params, {0.5f, 0.5f, 0.5f});
        texture.picture = *number;

        NamedTexture result;
        result.needs_uv = true;
        Rgbd sum;
        auto at_most_1 = [](float x, float) { return std::min(x, 1.0f); };
        const std::vector<Rgb>& texels = textures_.pictures[*number].texels;
        for (Rgb r : texels) {
            result.most = larger(result.most, r);
            sum += each(at_most_1, scale * r);
        }
        result.most *= scale;
        if (max_component(result.most) > 1) {
            params.input().note(
                params.at("filename"),
                "what is above 1 in " + quote_file(params.string("filename")) + " is read as 1");
        }
        result.mean = to_rgb(1 / static_cast<double>(texels.size()) * sum);
        if (texture.inverted) {
            result.most = {1, 1, 1};
            result.mean = Rgb{1, 1, 1} - result.mean;
        }
        result.most = each(at_most_1, result.most);
        return is_uv ? add(params, texture, result) : constant(params, result.mean);
    }
    // The number of the picture in the file that the parameters name, which is read once; nothing
    // where it cannot be read.
    std::optional<uint32_t> picture(const Params& params, float gamma) {
        const Param& name = params.required("filename");
        const std::pair file(canonical(params.input().find(name.at, name.strings[0])), gamma);
        auto known = pictures_.find(file);
        if (known != pictures_.end()) return known->second;
        std::optional<Image> image = read_picture(params, gamma, infinity);
        if (!image) return {};
        texels_ += image->pixels.size();
        check_limit(name.at, texels_, params.input().limits.texels,
                    "pixels in all textures together");
        textures_.pictures.push_back({image->width, image->height, std::move(image->pixels)});
        return pictures_[file] = static_cast<uint32_t>(textures_.pictures.size() - 1);
    }
    NamedTexture add(const Params& params, const Texture& texture, NamedTexture named) {
        check_limit(params.at(), named.depth, 100, "textures made of each other");
        check_limit(params.at(), textures_.all.size() + 1, 65535, "textures");
        named.index = static_cast<uint32_t>(textures_.all.size());
        textures_.all.push_back(texture);
        means_.push_back(named.mean);
        return named;
    }
    NamedTexture constant(const Params& params, Rgb value) {
        Texture texture;
        texture.value = value;
        return add(params, texture, {0, value, value});
    }

    Textures textures_;
    std::vector<Rgb> means_;  // of each
    std::map<std::string, NamedTexture> known_;
    std::map<std::pair<std::string, float>, uint32_t> pictures_;  // by canonical name and gamma
    uint64_t texels_ = 0;
};
