#include "common/scene_file/textures.h"

#include <algorithm>
#include <array>

#include "common/base/numbers.h"
#include "common/picture/image.h"

namespace {

constexpr const char* unreadable_picture = "a picture that cannot be read";
constexpr int deepest = 100;  // textures made of textures

// Returns whether the mapping is "uv", not one that the mean of the texture stands in for.
bool read_mapping(Params& params, Texture& texture) {
    bool is_uv = params.string("mapping", "uv") == "uv";
    if (!is_uv) {
        params.ignore("vector3", {"v1", "v2"});
        params.stand_in(params.at("mapping"), "a mapping other than \"uv\"");
    }
    auto number = [&](const char* name, float fallback) {
        return params.number(name, fallback, -1e9f, 1e9f);
    };
    texture.scale = {number("uscale", 1), number("vscale", 1)};
    texture.shift = {number("udelta", 0), number("vdelta", 0)};
    return is_uv;
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
    if (wrap == "octahedralsphere") {
        params.stand_in(params.at("wrap"), "wrap \"octahedralsphere\"");
        return Texture::Wrap::repeat;
    }
    fail_unknown(params.at("wrap"), "wrap", wrap, {"black", "clamp", "repeat"});
}

// Whether the nearest texel alone counts.
bool read_filter(Params& params, SceneNotes& notes) {
    params.ignore("float", {"maxanisotropy"});
    std::string filter = params.string("filter", "bilinear");
    if (filter == "point") return true;
    if (filter != "bilinear")
        notes.add(params.at("filter"), "filter " + quote(filter) + " is read as \"bilinear\"");
    return false;
}

}  // namespace

std::optional<Rgb> read_reflectance(Params& params, const std::string& name) {
    const Param* rgb = params.find_exactly("rgb", name, 3);
    if (const Param* spectrum = params.find("spectrum", name)) params.named<Rgb>(*spectrum, {});
    if (!rgb) return {};
    return read_rgb(*rgb, 0, 1);
}

void TextureReader::read(Lexer& lexer, const Token& word, const std::vector<Param>& defaults) {
    Token name_token = lexer.next(), type = lexer.next();
    for (const Token& token : {name_token, type}) {
        if (token.type == Token::string) continue;
        fail(lexer.at(token), "Texture needs a name, \"spectrum\" and a type in quotes, not " +
                                  Lexer::describe(token));
    }
    std::string name = lexer.unescape(name_token);
    Params params(lexer, word, notes_, true, defaults);
    if (type.text != "spectrum" && type.text != "float") {
        fail_unknown(lexer.at(type), "type of texture", std::string(type.text),
                     {"float", "spectrum"});
    }
    bool is_float = type.text == "float";
    if (is_float ? floats_.contains(name) : known_.contains(name)) {
        fail(lexer.at(name_token), "a second texture " + quote(name));
    }
    try {
        if (is_float) floats_.insert(name);
        if (!is_float) known_[name] = read_spectrum(params);
    } catch (const InputError&) {
        known_[name] = NamedTexture{};  // so that who names it is not wrong too
        throw;
    }
}

std::optional<NamedTexture> TextureReader::find(Params& params, const std::string& name) {
    const Param* param = params.find_exactly("texture", name, 1);
    if (!param) return {};
    auto found = known_.find(param->strings[0]);
    if (found != known_.end()) return found->second;
    if (floats_.contains(param->strings[0])) {
        fail(param->at, "the texture " + quote(param->strings[0]) +
                            " is of type \"float\", and must be of type \"spectrum\"");
    }
    std::vector<std::string> names;
    for (const auto& [known, texture] : known_) names.push_back(known);
    fail_unknown(param->at, "texture", param->strings[0], names);
}

NamedTexture TextureReader::read_spectrum(Params& params) {
    NamedTexture result;
    Texture texture;
    auto constant = [&](Rgb value) {
        params.ignore_rest();
        texture.kind = Texture::Kind::constant;
        texture.value = {std::clamp(value.r, 0.0f, 1.0f), std::clamp(value.g, 0.0f, 1.0f),
                         std::clamp(value.b, 0.0f, 1.0f)};
        return NamedTexture{0, texture.value, texture.value};
    };
    if (params.type() == "imagemap") {
        return read_picture(params);
    } else if (params.type() == "constant") {
        texture.value = read_reflectance(params, "value").value_or(texture.value);
        result.most = result.mean = texture.value;
    } else if (params.type() == "scale") {
        NamedTexture input = read_input(params, "tex", {1, 1, 1});
        float scale = params.number("scale", 1, 0, 1e9f);
        texture.kind = Texture::Kind::product;
        texture.value = {scale, scale, scale};
        texture.inputs = {input.index, input.index};
        result = input;
        result.depth++;
        auto scaled = [&](Rgb x) {
            return Rgb{std::min(1.0f, scale * x.r), std::min(1.0f, scale * x.g),
                       std::min(1.0f, scale * x.b)};
        };
        result.most = scaled(input.most), result.mean = scaled(input.mean);
    } else if (params.type() == "checkerboard") {
        bool is_flat = params.integer("dimension", 2, 2, 3) == 2;
        if (!is_flat) {
            params.stand_in(params.at("dimension"), "a checkerboard of 3 dimensions");
        }
        NamedTexture a = read_input(params, "tex1", {1, 1, 1});
        NamedTexture b = read_input(params, "tex2", {0, 0, 0});
        texture.kind = Texture::Kind::checkerboard;
        is_flat &= read_mapping(params, texture);
        texture.inputs = {a.index, b.index};
        result.most = {std::max(a.most.r, b.most.r), std::max(a.most.g, b.most.g),
                       std::max(a.most.b, b.most.b)};
        result.mean = 0.5f * (a.mean + b.mean);
        result.needs_uv = true;
        result.depth = 1 + std::max(a.depth, b.depth);
        if (!is_flat && params.may_stand_in()) result = constant(result.mean);
    } else if (params.stands_in()) {
        result = constant({0.5f, 0.5f, 0.5f});
    } else {
        params.fail_type({"checkerboard", "constant", "imagemap", "scale"});
    }
    params.finish();
    if (result.depth > deepest) fail(params.at(), "textures of textures, more than 100 deep");
    result.index = add(params.at(), texture, result.mean);
    return result;
}

// A texture, or one colour.
NamedTexture TextureReader::read_input(Params& params, const std::string& name, Rgb fallback) {
    if (std::optional<NamedTexture> texture = find(params, name)) return *texture;
    Texture constant;
    constant.value = read_reflectance(params, name).value_or(fallback);
    return {add(params.at(), constant, constant.value), constant.value, constant.value};
}

NamedTexture TextureReader::read_picture(Params& params) {
    Texture texture;
    texture.kind = Texture::Kind::picture;
    bool is_uv = read_mapping(params, texture);
    texture.wrap = read_wrap(params);
    texture.nearest = read_filter(params, notes_);
    texture.inverted = params.boolean("invert", false);
    float scale = params.number("scale", 1, 0, 1e9f), gamma = read_encoding(params);
    texture.value = {scale, scale, scale};
    const Param* name = params.find_exactly("string", "filename", 1);
    if (name) texture.picture = picture(params, name->at, gamma);
    params.finish();
    if (!name) fail(params.at(), params.owner() + " needs \"string filename\"");

    NamedTexture result;
    result.needs_uv = true;
    std::array<double, 3> sum = {};
    const std::vector<Rgb>& texels = textures_.pictures[texture.picture].texels;
    for (Rgb r : texels) {
        result.most = {std::max(result.most.r, r.r), std::max(result.most.g, r.g),
                       std::max(result.most.b, r.b)};
        const std::array<float, 3> channels = {r.r, r.g, r.b};
        for (size_t i = 0; i < 3; i++) sum[i] += double{std::min(1.0f, scale * channels[i])};
    }
    result.most *= scale;
    if (max_component(result.most) > 1) {
        notes_.add(params.at("filename"),
                   "what is above 1 in " + quote_file(name->strings[0]) + " is read as 1");
    }
    auto most = [&](float x) { return texture.inverted ? 1 : std::min(x, 1.0f); };
    result.most = {most(result.most.r), most(result.most.g), most(result.most.b)};
    auto mean = [&](double of_all) {
        float value = static_cast<float>(of_all / static_cast<double>(texels.size()));
        return texture.inverted ? 1 - value : value;
    };
    result.mean = {mean(sum[0]), mean(sum[1]), mean(sum[2])};
    if (!is_uv) {
        texture = {};
        texture.value = result.most = result.mean;
        result.needs_uv = false;
    }
    result.index = add(params.at(), texture, result.mean);
    return result;
}

// The number of the picture in the file that the parameter names, which is read once.
uint32_t TextureReader::picture(Params& params, const Position& at, float gamma) {
    std::string path = files_.find(at, params.string("filename", ""));
    auto [place, is_new] = pictures_.try_emplace({canonical(path), gamma});
    Picture& known = place->second;
    if (is_new) {
        known.number = static_cast<uint32_t>(textures_.pictures.size());
        try {
            read_texels(path, at, gamma);
        } catch (const InputError& error) {
            known.error = error.what();
            if (params.may_stand_in()) textures_.pictures.push_back({1, 1, {{0.5f, 0.5f, 0.5f}}});
        }
    }
    if (!known.error.empty()) {
        params.read([&] { throw InputError(known.error); }, unreadable_picture);
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

uint32_t TextureReader::add(const Position& at, const Texture& texture, Rgb mean) {
    constexpr size_t most = 65535;
    if (textures_.all.size() == most) stop_reading(at, "more than 65535 textures");
    textures_.all.push_back(texture);
    means_.push_back(mean);
    return static_cast<uint32_t>(textures_.all.size() - 1);
}
