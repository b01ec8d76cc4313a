#include "common/scene_file/textures.h"

#include "common/base/numbers.h"
#include "common/picture/image.h"

namespace {

constexpr int deepest = 100;  // textures made of textures

// A number of the mapping from (u, v) to the picture.
float read_mapping(Params& params, const std::string& name, float fallback) {
    constexpr float largest = 1e9f;
    float value = params.number(name, fallback);
    if (std::abs(value) <= largest) return value;
    fail(params.at(name), quote(name) + " must be from -1e9 to 1e9");
}

void read_mapping(Params& params, Texture& texture) {
    if (params.string("mapping", "uv") != "uv") {
        params.not_supported(params.at("mapping"), "only the mapping \"uv\" is supported");
    }
    texture.scale = {read_mapping(params, "uscale", 1), read_mapping(params, "vscale", 1)};
    texture.shift = {read_mapping(params, "udelta", 0), read_mapping(params, "vdelta", 0)};
}

// How codes become linear values: to this power, or as sRGB codes (0).
float read_encoding(Params& params) {
    std::string encoding = params.string("encoding", "sRGB");
    if (encoding == "sRGB") return 0;
    if (encoding == "linear") return 1;
    if (encoding.starts_with("gamma ")) {
        double gamma = to_number(std::string_view(encoding).substr(6)).value_or(0);
        if (gamma >= 0.01 && gamma <= 100) return static_cast<float>(gamma);
        fail(params.at("encoding"), "gamma must be from 0.01 to 100");
    }
    fail_unknown(params.at("encoding"), "encoding", encoding, {"gamma 2.2", "linear", "sRGB"});
}

Texture::Wrap read_wrap(Params& params) {
    std::string wrap = params.string("wrap", "repeat");
    if (wrap == "repeat") return Texture::Wrap::repeat;
    if (wrap == "clamp") return Texture::Wrap::clamp;
    if (wrap == "black") return Texture::Wrap::black;
    fail_unknown(params.at("wrap"), "wrap", wrap, {"black", "clamp", "repeat"});
}

// Whether the nearest texel alone counts.
bool read_filter(Params& params, Messages& notes) {
    params.ignore("float", {"maxanisotropy"});
    std::string filter = params.string("filter", "bilinear");
    if (filter == "point") return true;
    if (filter == "bilinear") return false;
    for (const char* known : {"trilinear", "ewa", "EWA"}) {
        if (filter != known) continue;
        notes.add(params.at("filter"), "filter " + quote(filter) + " is read as \"bilinear\"");
        return false;
    }
    fail_unknown(params.at("filter"), "filter", filter, {"EWA", "bilinear", "point", "trilinear"});
}

}  // namespace

std::optional<Rgb> read_reflectance(Params& params, const std::string& name) {
    const Param* param = params.find_exactly("rgb", name, 3);
    if (const Param* listed = params.find("spectrum", name)) {
        Spectrum spectrum = read_spectrum(*listed);
        for (const auto& [nm, value] : spectrum) {
            if (value > 1) fail(listed->at, quote(name) + " must be from 0 to 1");
        }
        return reflectance_rgb(spectrum);
    }
    if (!param) return {};
    Rgb r = {static_cast<float>(param->numbers[0]), static_cast<float>(param->numbers[1]),
             static_cast<float>(param->numbers[2])};
    if (std::min({r.r, r.g, r.b}) < 0 || max_component(r) > 1) {
        fail(param->at, quote(name) + " must be from 0 to 1");
    }
    return r;
}

void TextureReader::read(Lexer& lexer, const Token& word, Messages& notes) {
    Token name_token = lexer.next(), type = lexer.next();
    for (const Token& token : {name_token, type}) {
        if (token.type == Token::string) continue;
        fail(lexer.at(token), "Texture needs a name, \"spectrum\" and a type in quotes, not " +
                                  Lexer::describe(token));
    }
    std::string name = lexer.unescape(name_token);
    Params params(lexer, word, notes);
    if (type.text != "spectrum" && type.text != "float") {
        fail_unknown(lexer.at(type), "type of texture", std::string(type.text),
                     {"float", "spectrum"});
    }
    if (known_.contains(name)) fail(lexer.at(name_token), "a second texture " + quote(name));
    try {
        std::optional<NamedTexture> texture;
        if (type.text == "spectrum") texture = read_spectrum(params, notes);
        known_[name] = texture;
    } catch (const InputError&) {
        known_[name] = NamedTexture{};  // so that who names it is not wrong too
        throw;
    }
}

std::optional<NamedTexture> TextureReader::find(Params& params, const std::string& name) const {
    const Param* param = params.find_exactly("texture", name, 1);
    if (!param) return {};
    auto found = known_.find(param->strings[0]);
    if (found == known_.end()) {
        std::vector<std::string> names;
        for (const auto& [known, texture] : known_) names.push_back(known);
        fail_unknown(param->at, "texture", param->strings[0], names);
    }
    if (!found->second) {
        fail(param->at, "the texture " + quote(found->first) +
                            " is of type \"float\", and must be of type \"spectrum\"");
    }
    return found->second;
}

NamedTexture TextureReader::read_spectrum(Params& params, Messages& notes) {
    NamedTexture result;
    Texture texture;
    if (params.type() == "imagemap") {
        return read_picture(params, notes);
    } else if (params.type() == "constant") {
        texture.value = read_reflectance(params, "value").value_or(texture.value);
        result.most = texture.value;
    } else if (params.type() == "scale") {
        NamedTexture input = read_input(params, "tex", {1, 1, 1});
        float scale = params.number("scale", 1);
        if (!(scale >= 0 && scale <= 1e9f)) {
            fail(params.at("scale"), "\"scale\" must be from 0 to 1e9");
        }
        texture.kind = Texture::Kind::product;
        texture.value = {scale, scale, scale};
        texture.inputs = {input.index, input.index};
        result = input;
        result.depth++;
        auto most = [&](float x) { return std::min(1.0f, scale * x); };
        result.most = {most(input.most.r), most(input.most.g), most(input.most.b)};
    } else if (params.type() == "checkerboard") {
        if (params.integer("dimension", 2, 2, 3) == 3) {
            params.not_supported(params.at("dimension"),
                                 "a checkerboard of 3 dimensions is not supported");
        }
        NamedTexture a = read_input(params, "tex1", {1, 1, 1});
        NamedTexture b = read_input(params, "tex2", {0, 0, 0});
        texture.kind = Texture::Kind::checkerboard;
        read_mapping(params, texture);
        texture.inputs = {a.index, b.index};
        result.most = {std::max(a.most.r, b.most.r), std::max(a.most.g, b.most.g),
                       std::max(a.most.b, b.most.b)};
        result.needs_uv = true;
        result.depth = 1 + std::max(a.depth, b.depth);
    } else {
        params.fail_type({"checkerboard", "constant", "imagemap", "scale"});
    }
    params.finish();
    if (result.depth > deepest) fail(params.at(), "textures of textures, more than 100 deep");
    result.index = add(params.at(), texture);
    return result;
}

// A texture, or one colour.
NamedTexture TextureReader::read_input(Params& params, const std::string& name, Rgb fallback) {
    if (std::optional<NamedTexture> texture = find(params, name)) return *texture;
    Texture constant;
    constant.value = read_reflectance(params, name).value_or(fallback);
    return {add(params.at(), constant), constant.value};
}

NamedTexture TextureReader::read_picture(Params& params, Messages& notes) {
    Texture texture;
    texture.kind = Texture::Kind::picture;
    read_mapping(params, texture);
    texture.wrap = read_wrap(params);
    texture.nearest = read_filter(params, notes);
    texture.inverted = params.boolean("invert", false);
    float scale = params.number("scale", 1), gamma = read_encoding(params);
    if (!(scale >= 0 && scale <= 1e9f)) fail(params.at("scale"), "\"scale\" must be from 0 to 1e9");
    texture.value = {scale, scale, scale};
    const Param* name = params.find_exactly("string", "filename", 1);
    if (name) params.read([&] { texture.picture = picture(params, name->at, gamma); });
    params.finish();
    if (!name) fail(params.at(), params.owner() + " needs \"string filename\"");

    NamedTexture result;
    result.needs_uv = true;
    for (Rgb r : textures_.pictures[texture.picture].texels) {
        result.most = {std::max(result.most.r, r.r), std::max(result.most.g, r.g),
                       std::max(result.most.b, r.b)};
    }
    result.most *= scale;
    if (max_component(result.most) > 1) {
        notes.add(params.at("filename"),
                  "what is above 1 in " + quote_file(name->strings[0]) + " is read as 1");
    }
    auto most = [&](float x) { return texture.inverted ? 1 : std::min(x, 1.0f); };
    result.most = {most(result.most.r), most(result.most.g), most(result.most.b)};
    result.index = add(params.at(), texture);
    return result;
}

// The number of the picture in the file that the parameter names, which is read once.
uint32_t TextureReader::picture(Params& params, const Position& at, float gamma) {
    std::string path = files_.find(at, params.string("filename", ""));
    auto [place, is_new] = pictures_.try_emplace({canonical(path), gamma});
    Picture& known = place->second;
    if (!known.error.empty()) throw InputError(known.error);
    if (is_new) {
        known.number = static_cast<uint32_t>(textures_.pictures.size());
        try {
            read_texels(path, at, gamma);
        } catch (const InputError& error) {
            known.error = error.what();
            throw;
        }
    }
    files_.add_number(known.number);
    return known.number;
}

void TextureReader::read_texels(const std::string& path, const Position& at, float gamma) {
    Image image = decode_image(path, files_.read(path, at), gamma);
    for (Rgb r : image.pixels) {
        if (is_finite(r) && std::min({r.r, r.g, r.b}) >= 0) continue;
        fail(at, quote_file(path) + " has a pixel that is negative or not a number");
    }
    texels_ += image.pixels.size();
    if (texels_ > limits_.texels) {
        stop_reading(at, "the textures have more than " + std::to_string(limits_.texels) +
                             " pixels together");
    }
    textures_.pictures.push_back({image.width, image.height, std::move(image.pixels)});
}

uint32_t TextureReader::add(const Position& at, const Texture& texture) {
    constexpr size_t most = 65535;
    if (textures_.all.size() == most) stop_reading(at, "more than 65535 textures");
    textures_.all.push_back(texture);
    return static_cast<uint32_t>(textures_.all.size() - 1);
}
