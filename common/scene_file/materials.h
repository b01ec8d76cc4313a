// Materials and textures of a pbrt-v4 scene file, and the pictures that it names.
#pragma once
#include <algorithm>
#include <optional>

#include "common/material/hit.h"
#include "common/material/spectrum.h"
#include "common/picture/image.h"
#include "common/scene/scene.h"
#include "common/scene/texture.h"
#include "common/scene_file/params.h"

inline Rgb larger(Rgb a, Rgb b) {
    return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)};
}

// Returns whether the mapping is "uv", not one that grey stands in for.
inline bool read_mapping(const Params& params, Texture& texture) {
    texture.scale = {params.number("uscale"), params.number("vscale")};
    texture.shift = {params.number("udelta"), params.number("vdelta")};
    bool is_uv = params.string("mapping", "uv") == "uv";
    if (!is_uv) params.stand_in("a mapping other than \"uv\"", "mapping");
    return is_uv;
}

// How codes become linear values, see to_linear().
inline const std::map<std::string, float> encodings = {{"linear", 1.0f}, {"sRGB", 0.0f}};
/// The picture that "filename" names. Nothing where its stand-in is to be taken, grey.
///
/// gamma  how codes become linear values, see to_linear()
inline std::optional<Image> read_picture(const Params& params, float gamma) {
    const Param& name = params.required("filename");
    Input& input = params.input();
    std::string path = input.find(name.at, name.strings[0]);
    Image image;
    bool is_read = input.try_to_read(params.at(), "a picture that cannot be read", [&] {
        image = decode_image(path, input.read(path, name.at), gamma);
        for (Rgb r : image.pixels) {
            if (is_finite(r) && std::min({r.r, r.g, r.b}) >= 0) continue;
            fail(name.at, quote(path, 4096) + " has a pixel that is negative or no number");
        }
    });
    if (!is_read) return {};
    return image;
}

/// A texture, and what a material that names it must know.
struct NamedTexture {
    uint32_t index = 0;     // into Textures::all
    Rgb most;               // an upper bound of its values
    bool needs_uv = false;  // varies over the surface
};

/// Reads textures and finds them by name. Those of type "float" are read over.
class TextureReader {
public:
    /// Reads what stands after the word Texture.
    void read(Lexer& lexer, const Position& at, Input& input, const ParamMap& defaults) {
        Token name_token = lexer.expect(Token::string, "Texture needs a name in quotes");
        const std::string needs = "Texture needs \"float\" or \"spectrum\"";
        Token type = lexer.expect(Token::string, needs);
        std::string name = lexer.unescape(name_token);
        if (type.text == "float") return lexer.skip_arguments();
        Params params(lexer, "Texture", at, input, defaults);
        if (type.text != "spectrum") lexer.fail_at(type, needs);
        if (known_.contains(name)) fail(lexer.at(name_token), "a second texture " + quote(name));
        known_[name] = read_texture(params);
    }
    /// The texture that a parameter "texture NAME" names; null where it is not given.
    const NamedTexture* find(const Params& params, const std::string& name) const {
        const Param* param = params.find(name);
        if (!param || param->type != "texture") return nullptr;
        return &look_up(known_, param->strings[0], "texture", param->at);
    }
    Textures take() { return std::move(textures_); }

private:
    NamedTexture read_texture(const Params& params) {
        if (params.stands_in()) return grey(params);
        if (params.type() == "imagemap") return read_picture_texture(params);
        if (params.type() == "constant") return constant(params, params.color("value"));
        return read_checkerboard(params);
    }
    NamedTexture read_checkerboard(const Params& params) {
        bool is_flat = params.integer("dimension") == 2;
        if (!is_flat) params.stand_in("a checkerboard of 3 dimensions", "dimension");
        NamedTexture a = read_input(params, "tex1"), b = read_input(params, "tex2");
        Texture texture;
        texture.kind = Texture::Kind::checkerboard;
        texture.inputs = {a.index, b.index};
        is_flat &= read_mapping(params, texture);
        if (!is_flat) return grey(params);
        return add(params, texture, {0, larger(a.most, b.most), true});
    }
    // A texture, or one colour.
    NamedTexture read_input(const Params& params, const std::string& name) {
        const NamedTexture* texture = find(params, name);
        return texture ? *texture : constant(params, params.color(name));
    }
    NamedTexture read_picture_texture(const Params& params) {
        Texture texture;
        texture.kind = Texture::Kind::picture;
        bool is_uv = read_mapping(params, texture);
        bool repeats = params.string("wrap", "repeat") == "repeat";
        if (!repeats) params.stand_in("a wrap other than \"repeat\"", "wrap");
        texture.nearest = params.string("filter") == "point";
        texture.inverted = params.boolean("invert");
        float scale = params.number("scale");
        texture.value = {scale, scale, scale};
        const std::string encoding = params.string("encoding", "sRGB");
        float gamma = look_up(encodings, encoding, "encoding", params.at("encoding"));
        std::optional<Image> image = read_picture(params, gamma);
        if (!image || !is_uv) return grey(params);
        Rgb most;
        for (Rgb r : image->pixels) most = larger(most, scale * r);
        if (max_component(most) > 1) params.note("has values above 1, which are read as 1");
        most = texture.inverted ? Rgb{1, 1, 1} : from_0_to_1(most);
        texture.picture = static_cast<uint32_t>(textures_.pictures.size());
        textures_.pictures.push_back({image->width, image->height, std::move(image->pixels)});
        return add(params, texture, {0, most, true});
    }
    NamedTexture add(const Params& params, const Texture& texture, NamedTexture named) {
        check_limit(params.at(), textures_.all.size() + 1, 65535, "textures");
        named.index = static_cast<uint32_t>(textures_.all.size());
        textures_.all.push_back(texture);
        return named;
    }
    NamedTexture constant(const Params& params, Rgb value) {
        Texture texture;
        texture.value = value;
        return add(params, texture, {0, value});
    }
    NamedTexture grey(const Params& params) { return constant(params, {0.5f, 0.5f, 0.5f}); }

    Textures textures_;
    std::map<std::string, NamedTexture> known_;
};

/// The roughness as GGX's alpha; sqrt(roughness) unless remaproughness is false.
inline float read_alpha(const Params& params, const std::string& prefix = "") {
    constexpr float smooth_below = 1e-3f;  // where pbrt takes a surface for smooth
    float roughness = params.number(prefix + "roughness");
    float u = params.number(prefix + "uroughness", roughness);
    float v = params.number(prefix + "vroughness", roughness);
    if (u != v) {
        params.stand_in("a roughness that differs between u and v");
        u = std::sqrt(u * v);
    }
    float alpha = params.boolean("remaproughness") ? std::sqrt(u) : u;
    return alpha >= smooth_below ? alpha : 0;
}

// What a spectrum is of which the name is given, such as "metal-Cu-eta"; null if it is not known.
template <class Value>
const Value* find_spectrum(const Params& params, const std::string& parameter,
                           const std::map<std::string, Value>& known) {
    const Param* spectrum = params.find(parameter);
    if (!spectrum || spectrum->type != "spectrum") return nullptr;
    const std::string& name = spectrum->strings[0];
    auto found = known.find(name);
    if (found != known.end()) return &found->second;
    params.input().stand_in(spectrum->at, "a spectrum that is not known",
                            unknown("spectrum", name, names_of(known)));
    return nullptr;
}

// "eta" or "k" of a metal, by default copper's: an rgb, or the name of a spectrum.
inline Rgb read_metal(const Params& params, const std::string& prefix, const std::string& name) {
    const Param* param = params.find(prefix + name);
    if (param && param->type == "rgb") return params.color(prefix + name);
    const Rgb* known = find_spectrum(params, prefix + name, metals());
    return known ? *known : metals().at("metal-Cu-" + name);
}

/// Nothing for a material that is as if the surface were not there: it only bounds media.
inline std::optional<Material> read_material(const Params& params, const TextureReader& textures) {
    const std::string& type = params.type();
    if (type.empty() || has_word("interface none thindielectric", type)) return {};
    Material material;
    material.at = kept(params.at());
    if (type == "dielectric") {
        material.type = MaterialType::dielectric;
        material.ior = params.number("eta");
        material.glass = find_spectrum(params, "eta", glasses());
        if (material.glass) material.ior = index_of_refraction(*material.glass, 0.5875618);
        if (read_alpha(params) > 0) params.stand_in("rough glass");
        return material;
    }

    // One colour, or a texture and its largest value.
    material.reflectance = params.color("reflectance");
    const NamedTexture* texture = textures.find(params, "reflectance");
    if (texture) material.reflectance = texture->most;
    if (texture && texture->needs_uv) material.texture = static_cast<uint16_t>(texture->index + 1);
    if (!type.ends_with("conductor")) return material;

    const std::string prefix = type == "conductor" ? "" : "conductor.";
    material.type = MaterialType::conductor;
    material.eta = read_metal(params, prefix, "eta");
    material.k = read_metal(params, prefix, "k");
    if (params.find("reflectance")) {
        if (params.find(prefix + "eta") || params.find(prefix + "k")) {
            fail(params.at(), "a conductor has either reflectance or eta and k");
        }
        // Find the metal of eta = 1 that reflects so much at normal incidence, as pbrt does.
        material.eta = {1, 1, 1};
        material.k = k_of_reflectance(material.reflectance);
    }
    material.alpha = read_alpha(params, prefix);
    return material;
}
