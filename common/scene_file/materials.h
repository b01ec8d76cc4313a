// Materials and lights of a pbrt-v4 scene file.
#pragma once
#include <algorithm>

#include "common/geometry/transform.h"
#include "common/material/metal.h"
#include "common/material/spectrum.h"
#include "common/scene/scene.h"
#include "common/scene/sky_image.h"
#include "common/scene_file/textures.h"

inline constexpr float smooth_below =
    1e-3f;  // the alpha under which pbrt takes a surface for smooth

/// The roughness as GGX's alpha; sqrt(roughness) unless remaproughness is false.
inline float read_alpha(const Params& params, const std::string& prefix = "") {
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

// What L is multiplied by for "power" or "illuminance", if L = 1 makes `of_one`. As in pbrt, values
// of 0 or less have no effect.
inline float read_total(const Params& params, const std::string& name, float of_one) {
    float total = params.number(name);
    return total > 0 ? total / of_one : 1;
}

/// From all sides, and 1e9 m away: 1e35 W. Powers and sums of brighter lights may be no floats.
inline constexpr float brightest = 1e15f;
inline bool too_bright(Rgb L) { return !(is_finite(L) && max_component(L) <= brightest); }
inline void check_brightness(const Params& params, Rgb L) {
    if (!too_bright(L)) return;
    fail(params.at(), params.owner() + " shines brighter than 1e15: choose a larger unit");
}

/// Nothing for a material that is as if the surface were not there: it only bounds media.
inline std::optional<Material> read_material(const Params& params, const TextureReader& textures) {
    const std::string& type = params.type();
    for (const char* absent : {"", "interface", "none", "thindielectric"}) {
        if (type == absent) return {};
    }
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
    std::optional<NamedTexture> texture = textures.find(params, "reflectance");
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

/// What AreaLightSource says about the shapes after it.
struct AreaEmission {
    Rgb L;
    float power = 0;  // W of each primitive, by which L is multiplied; 0: L is the radiance
    bool two_sided = false;
};
inline AreaEmission read_area_light(const Params& params) {
    AreaEmission emission;
    emission.L = params.color("L") * params.number("scale");
    emission.two_sided = params.boolean("twosided");
    emission.power = std::max(0.0f, params.number("power"));
    check_brightness(params, emission.L);
    return emission;
}

/// The picture that an infinite light names: square or twice as wide as high, see SkyImage. Nothing
/// where its stand-in is to be taken, a sky that is grey.
inline std::optional<SkyImage> read_sky_image(const Params& params,
                                              const Transform& world_from_light) {
    SkyImage sky;
    sky.at_file = kept(params.at());
    sky.x = to_vec3(normalize(world_from_light.x));
    sky.y = to_vec3(normalize(world_from_light.y));
    sky.z = to_vec3(normalize(world_from_light.z));
    if (std::max({std::abs(dot(sky.x, sky.y)), std::abs(dot(sky.y, sky.z)),
                  std::abs(dot(sky.z, sky.x))}) > 1e-4f) {
        fail(params.at(), "the sky's picture may be turned and mirrored, but not sheared");
    }
    Position at = params.at("filename");
    if (params.number("illuminance") > 0) {
        params.input().stand_in(params.at("illuminance"),
                                "the illuminance of a picture of the sky");
    }
    float scale = params.number("scale");
    std::optional<Image> image = read_picture(params, 0, brightest / scale);
    if (!image) return {};
    sky.width = image->width;
    sky.height = image->height;
    bool is_square = sky.width == sky.height;
    if (!is_square && sky.width != 2 * sky.height) {
        fail(at, "the sky's picture must be a square or twice as wide as high");
    }
    sky.map = is_square ? SkyImage::Map::square : SkyImage::Map::wide;
    sky.pixels = std::move(image->pixels);
    for (Rgb& L : sky.pixels) L *= scale;
    if (std::all_of(sky.pixels.begin(), sky.pixels.end(), is_black)) {
        fail(at, "the sky's picture is black");
    }
    return sky;
}

inline Light read_light(const Params& params, const Transform& world_from_light) {
    Light light;
    light.at = kept(params.at());
    Vec3d from(params.point("from", {0, 0, 0})), to(params.point("to", {0, 0, 1}));
    float scale = params.number("scale");
    if (params.type() == "distant") {
        light.type = LightType::distant;
        if (from == to) fail(params.at("to"), "\"from\" and \"to\" are the same point");
        light.p = to_vec3(normalize(transform_vector(world_from_light, from - to)));
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
        light.p = to_vec3(transform_point(world_from_light, from));
        if (!(max_component(abs(light.p)) <= 1e9f)) {
            fail(params.at("from"), "the light is farther than 1e9");
        }
        light.L = params.color("I") * scale;
        light.L *= read_total(params, "power", 4 * pi);
    }
    check_brightness(params, light.L);
    return light;
}
