#include <algorithm>

#include "common/material/metal.h"
#include "common/picture/image.h"
#include "common/scene_file/scene_parts.h"
#include "common/scene_file/spectra.h"

namespace {

constexpr float smooth_below = 1e-3f;  // the alpha under which pbrt takes a surface for smooth

// "reflectance": one colour, or a texture and its largest value. Whether it is given.
bool read_reflectance(const Params& params, const TextureReader& textures, Material& material) {
    material.reflectance = params.color("reflectance");
    std::optional<NamedTexture> texture = textures.find(params, "reflectance");
    if (texture) material.reflectance = texture->most;
    if (texture && texture->needs_uv) material.texture = static_cast<uint16_t>(texture->index + 1);
    return params.find("reflectance");
}

/// The roughness as GGX's alpha; sqrt(roughness) unless remaproughness is false.
float read_alpha(const Params& params, const std::string& prefix = "") {
    float roughness = params.number(prefix + "roughness");
    float u = params.number(prefix + "uroughness", roughness);
    float v = params.number(prefix + "vroughness", roughness);
    if (u != v) {
        params.messages().stand_in(params.at(), "a roughness that differs between u and v");
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
    params.messages().stand_in(spectrum->at, "a spectrum that is not known",
                               unknown("spectrum", name, names_of(known)));
    return nullptr;
}

// "eta" or "k" of a metal, by default copper's: an rgb, or the name of a spectrum.
Rgb read_metal(const Params& params, const std::string& prefix, const std::string& name) {
    const Param* param = params.find(prefix + name);
    if (param && param->type == "rgb") return params.color(prefix + name);
    const Rgb* known = find_spectrum(params, prefix + name, metals());
    return known ? *known : metals().at("metal-Cu-" + name);
}

void read_conductor(const Params& params, bool has_reflectance, Material& material) {
    const std::string prefix = params.type() == "conductor" ? "" : "conductor.";
    material.type = MaterialType::conductor;
    material.eta = read_metal(params, prefix, "eta");
    material.k = read_metal(params, prefix, "k");
    if (has_reflectance) {
        if (params.find(prefix + "eta") || params.find(prefix + "k")) {
            fail(params.at(), "a conductor has either reflectance or eta and k");
        }
        // Find the metal of eta = 1 that reflects so much at normal incidence, as pbrt does.
        material.eta = {1, 1, 1};
        material.k = k_of_reflectance(material.reflectance);
    }
    material.alpha = read_alpha(params, prefix);
}

void read_dielectric(const Params& params, Material& material) {
    material.type = MaterialType::dielectric;
    material.ior = params.number("eta");
    material.glass = find_spectrum(params, "eta", glasses());
    if (material.glass) material.ior = index_of_refraction(*material.glass, 0.5875618);
    if (read_alpha(params) > 0) params.messages().stand_in(params.at(), "rough glass");
}

// What L is multiplied by for "power" or "illuminance", if L = 1 makes `of_one`. As in pbrt, values
// of 0 or less have no effect.
float read_total(const Params& params, const std::string& name, float of_one) {
    float total = params.number(name);
    return total > 0 ? total / of_one : 1;
}

// Where a point light stands.
Vec3 read_position(const Params& params, const Transform& world_from_light) {
    Vec3 p = to_vec3(transform_point(world_from_light, Vec3d(params.point("from", {0, 0, 0}))));
    if (!(max_component(abs(p)) <= 1e9f)) fail(params.at("from"), "the light is farther than 1e9");
    return p;
}

// The unit vector towards a distant light.
Vec3 read_direction(const Params& params, const Transform& world_from_light) {
    Vec3d from(params.point("from", {0, 0, 0})), to(params.point("to", {0, 0, 1}));
    if (from == to) fail(params.at("to"), "\"from\" and \"to\" are the same point");
    return to_vec3(normalize(transform_vector(world_from_light, from - to)));
}

}  // namespace

void check_brightness(const Params& params, Rgb L) {
    if (!too_bright(L)) return;
    fail(params.at(), params.owner() + " shines brighter than 1e15: choose a larger unit");
}

std::optional<Material> read_material(const Params& params, const TextureReader& textures) {
    const std::string& type = params.type();
    for (const char* absent : {"", "interface", "none", "thindielectric"}) {
        if (type == absent) return {};
    }
    Material material;
    material.at = kept(params.at());
    if (type == "dielectric") {
        read_dielectric(params, material);
        return material;
    }
    bool has_reflectance = read_reflectance(params, textures, material);
    if (type.ends_with("conductor")) read_conductor(params, has_reflectance, material);
    return material;
}

AreaEmission read_area_light(const Params& params) {
    AreaEmission emission;
    emission.L = params.color("L") * params.number("scale");
    emission.two_sided = params.boolean("twosided");
    emission.power = std::max(0.0f, params.number("power"));
    check_brightness(params, emission.L);
    return emission;
}

std::optional<SkyImage> read_sky_image(const Params& params, const Transform& world_from_light,
                                       NamedFiles& files) {
    SkyImage sky;
    sky.at_file = kept(params.at());
    sky.x = to_vec3(normalize(world_from_light.x));
    sky.y = to_vec3(normalize(world_from_light.y));
    sky.z = to_vec3(normalize(world_from_light.z));
    if (std::max({std::abs(dot(sky.x, sky.y)), std::abs(dot(sky.y, sky.z)),
                  std::abs(dot(sky.z, sky.x))}) > 1e-4f) {
        fail(params.at(), "the sky's picture may be turned and mirrored, but not sheared");
    }
    if (params.number("illuminance") > 0) {
        params.messages().stand_in(params.at("illuminance"),
                                   "the illuminance of a picture of the sky");
    }
    Position at = params.at("filename");
    std::string path = files.find(at, params.string("filename"));
    Image image;
    if (!params.messages().try_to_read(params.at(), "a picture that cannot be read",
                                       [&] { image = decode_image(path, files.read(path, at)); })) {
        return {};
    }
    if (image.width != image.height && image.width != 2 * image.height) {
        fail(at, quote_file(path) + " must be a square or twice as wide as high");
    }
    sky.map = image.width == image.height ? SkyImage::Map::square : SkyImage::Map::wide;
    sky.width = image.width;
    sky.height = image.height;
    float scale = params.number("scale");
    double sum = 0;
    for (Rgb& L : image.pixels) {
        L *= scale;
        sum += static_cast<double>(average(L));
        if (std::min({L.r, L.g, L.b}) >= 0 && !too_bright(L)) continue;
        fail(at, quote_file(path) + " has a pixel that is negative, not a number, or above 1e15");
    }
    if (sum == 0) fail(at, quote_file(path) + " is black");
    sky.pixels = std::move(image.pixels);
    return sky;
}

Light read_light(const Params& params, const Transform& world_from_light) {
    Light light;
    light.at = kept(params.at());
    float scale = params.number("scale");
    if (params.type() == "distant") {
        light.type = LightType::distant;
        light.p = read_direction(params, world_from_light);
        light.L = params.color("L") * scale * read_total(params, "illuminance", 1);
    } else if (params.type() == "infinite") {
        light.type = LightType::infinite;
        // The mean of a picture is not known: it could not be read.
        bool is_picture = params.find("filename");
        light.L = is_picture ? Rgb{0.5f, 0.5f, 0.5f} : params.color("L");
        light.L *= scale;
        light.L *= read_total(params, "illuminance", pi);
    } else {
        light.type = LightType::point;
        light.p = read_position(params, world_from_light);
        light.L = params.color("I") * scale;
        light.L *= read_total(params, "power", 4 * pi);
    }
    check_brightness(params, light.L);
    return light;
}
