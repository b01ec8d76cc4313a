// Materials of a pbrt-v4 scene file.
#pragma once
#include "common/material/hit.h"
#include "common/material/spectrum.h"
#include "common/scene/scene.h"
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
