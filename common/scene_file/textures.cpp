#include "common/scene_file/textures.h"

#include <algorithm>
#include <array>

#include "common/base/numbers.h"
#include "common/picture/image.h"

namespace {

// What is made of each channel of one or two colors.
template <class Make>
Rgb each(const Make& make, Rgb a, Rgb b = {}) {
    return {make(a.r, b.r), make(a.g, b.g), make(a.b, b.b)};
}
Rgb larger(Rgb a, Rgb b) {
    return each([](float x, float y) { return std::max(x, y); }, a, b);
}

// Returns whether the mapping is "uv", not one that the mean of the texture stands in for.
bool read_mapping(const Params& params, Texture& texture) {
    texture.scale = {params.number("uscale"), params.number("vscale")};
    texture.shift = {params.number("udelta"), params.number("vdelta")};
    if (params.string("mapping", "uv") == "uv") return true;
    params.messages().stand_in(params.at("mapping"), "a mapping other than \"uv\"");
    return false;
}

// How codes become linear values: to this power, or as sRGB codes (0).
float read_encoding(const Params& params) {
    std::string encoding = params.string("encoding", "sRGB");
    if (encoding == "sRGB") return 0;
    if (encoding == "linear") return 1;
    bool is_gamma = encoding.starts_with("gamma ");
    auto gamma = to_number(std::string_view(encoding).substr(is_gamma ? 6 : 0));
    if (is_gamma && gamma && *gamma >= 0.01 && *gamma <= 100) return static_cast<float>(*gamma);
    fail(params.at("encoding"), "encoding must be sRGB, linear, or gamma and 0.01 to 100");
}

Texture::Wrap read_wrap(const Params& params) {
    const std::map<std::string, Texture::Wrap> known = {{"black", Texture::Wrap::black},
                                                        {"clamp", Texture::Wrap::clamp},
                                                        {"repeat", Texture::Wrap::repeat}};
    return look_up(known, params.string("wrap", "repeat"), "wrap", params.at("wrap"));
}

}  // namespace

void TextureReader::read(Lexer& lexer, const Token& word, const std::vector<Param>& defaults) {
    Token name_token = lexer.expect(Token::string, "Texture needs a name in quotes");
    Token type = lexer.expect(Token::string, "Texture needs \"float\" or \"spectrum\"");
    std::string name = lexer.unescape(name_token);
    if (type.text == "float") {
        lexer.expect(Token::string, "Texture needs a type in quotes");
        while (lexer.peek().type == Token::string) read_param(lexer);
        return;
    }
    Params params(lexer, word, messages_, defaults);
    if (type.text != "spectrum") {
        fail_unknown(lexer.at(type), "type of texture", std::string(type.text),
                     {"float", "spectrum"});
    }
    if (known_.contains(name)) fail(lexer.at(name_token), "a second texture " + quote(name));
    known_[name] = read_texture(params);
}

std::optional<NamedTexture> TextureReader::find(const Params& params,
                                                const std::string& name) const {
    const Param* param = params.find(name);
    if (!param || param->type != "texture") return {};
    return look_up(known_, param->strings[0], "texture", param->at);
}

NamedTexture TextureReader::read_texture(const Params& params) {
    if (params.stands_in()) return constant(params, {0.5f, 0.5f, 0.5f});
    if (params.type() == "imagemap") return read_picture(params);
    if (params.type() == "constant") return constant(params, params.color("value"));
    if (params.type() == "scale") return read_scaled(params);
    return read_checkerboard(params);
}

NamedTexture TextureReader::read_scaled(const Params& params) {
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

NamedTexture TextureReader::read_checkerboard(const Params& params) {
    bool is_flat = params.integer("dimension") == 2;
    if (!is_flat) {
        messages_.stand_in(params.at("dimension"), "a checkerboard of 3 dimensions");
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
NamedTexture TextureReader::read_input(const Params& params, const std::string& name) {
    std::optional<NamedTexture> texture = find(params, name);
    return texture ? *texture : constant(params, params.color(name));
}

NamedTexture TextureReader::read_picture(const Params& params) {
    Texture texture;
    texture.kind = Texture::Kind::picture;
    bool is_uv = read_mapping(params, texture);
    texture.wrap = read_wrap(params);
    texture.nearest = params.string("filter") == "point";
    texture.inverted = params.boolean("invert");
    float scale = params.number("scale"), gamma = read_encoding(params);
    texture.value = {scale, scale, scale};
    const Param& name = params.required("filename");
    if (!messages_.try_to_read(params.at(), "a picture that cannot be read",
                               [&] { texture.picture = picture(params, gamma); })) {
        return constant(params, {0.5f, 0.5f, 0.5f});
    }

    NamedTexture result;
    result.needs_uv = true;
    std::array<double, 3> sum = {};
    const std::vector<Rgb>& texels = textures_.pictures[texture.picture].texels;
    for (Rgb r : texels) {
        result.most = larger(result.most, r);
        const std::array<float, 3> channels = {r.r, r.g, r.b};
        for (size_t i = 0; i < 3; i++) sum[i] += double{std::min(1.0f, scale * channels[i])};
    }
    result.most *= scale;
    if (max_component(result.most) > 1) {
        messages_.note(name.at,
                       "what is above 1 in " + quote_file(name.strings[0]) + " is read as 1");
    }
    auto mean = [&](double of_all) {
        return static_cast<float>(of_all / static_cast<double>(texels.size()));
    };
    result.mean = {mean(sum[0]), mean(sum[1]), mean(sum[2])};
    if (texture.inverted) {
        result.most = {1, 1, 1};
        result.mean = Rgb{1, 1, 1} - result.mean;
    }
    result.most = each([](float x, float) { return std::min(x, 1.0f); }, result.most);
    return is_uv ? add(params, texture, result) : constant(params, result.mean);
}

// The number of the picture in the file that the parameters name, which is read once.
uint32_t TextureReader::picture(const Params& params, float gamma) {
    Position at = params.at("filename");
    std::string path = files_.find(at, params.string("filename"));
    auto known = pictures_.find({canonical(path), gamma});
    if (known != pictures_.end()) return known->second;
    Image image = decode_image(path, files_.read(path, at), gamma);
    for (Rgb r : image.pixels) {
        if (is_finite(r) && std::min({r.r, r.g, r.b}) >= 0) continue;
        fail(at, quote_file(path) + " has a pixel that is negative or not a number");
    }
    texels_ += image.pixels.size();
    check_limit(at, texels_, limits_.texels, "pixels in all textures together");
    textures_.pictures.push_back({image.width, image.height, std::move(image.pixels)});
    uint32_t number = static_cast<uint32_t>(textures_.pictures.size() - 1);
    return pictures_[{canonical(path), gamma}] = number;
}

NamedTexture TextureReader::add(const Params& params, const Texture& texture, NamedTexture named) {
    check_limit(params.at(), named.depth, 100, "textures made of each other");
    check_limit(params.at(), textures_.all.size() + 1, 65535, "textures");
    named.index = static_cast<uint32_t>(textures_.all.size());
    textures_.all.push_back(texture);
    means_.push_back(named.mean);
    return named;
}

NamedTexture TextureReader::constant(const Params& params, Rgb value) {
    Texture texture;
    texture.value = value;
    return add(params, texture, {0, value, value});
}
