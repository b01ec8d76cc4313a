#include "common/scene_file/materials.h"

#include <algorithm>

#include "common/material/metal.h"
#include "common/picture/image.h"
#include "common/scene_file/spectra.h"

namespace {

constexpr float smooth_below = 1e-3f;  // the alpha under which pbrt takes a surface for smooth

// "reflectance": one colour, or a texture and its largest value. Whether it is given.
bool read_reflectance(Params& params, TextureReader& textures, Material& material) {
    std::optional<Rgb> rgb = read_reflectance(params, "reflectance");
    std::optional<NamedTexture> texture = textures.find(params, "reflectance");
    if (rgb) material.reflectance = *rgb;
    if (texture) material.reflectance = texture->most;
    if (texture && texture->needs_uv) material.texture = static_cast<uint16_t>(texture->index + 1);
    return rgb || texture;
}

/// The roughness as GGX's alpha; sqrt(roughness) unless remaproughness is false.
float read_alpha(Params& params, const std::string& prefix = "") {
    constexpr float roughest = 100;
    float roughness = params.number(prefix + "roughness", 0, 0, roughest);
    float u = params.number(prefix + "uroughness", roughness, 0, roughest);
    float v = params.number(prefix + "vroughness", roughness, 0, roughest);
    bool remap = params.boolean("remaproughness", true);
    if (u != v) {
        params.stand_in(params.at(), "a roughness that differs between u and v");
        u = std::sqrt(u * v);
    }
    return remap ? std::sqrt(u) : u;
}

// "eta" or "k" of a metal: an rgb, or the name of a spectrum such as "metal-Cu-eta".
std::optional<Rgb> read_metal(Params& params, const std::string& name) {
    constexpr float largest = 1e4f;  // so that its fourth power is a float
    const Param* rgb = params.find_exactly("rgb", name, 3);
    if (rgb) return read_rgb(*rgb, 0, largest);
    const Param* spectrum = params.find("spectrum", name);
    if (!spectrum) return {};
    const Rgb* known = params.named(*spectrum, metals());
    return known ? std::optional(*known) : std::nullopt;
}

// `prefix` is what the names of its parameters begin with.
Material read_conductor(Params& params, TextureReader& textures, const std::string& prefix = "") {
    Material material;
    material.type = MaterialType::conductor;
    bool has_reflectance = read_reflectance(params, textures, material);
    std::optional<Rgb> eta = read_metal(params, prefix + "eta");
    std::optional<Rgb> k = read_metal(params, prefix + "k");
    if (has_reflectance && (eta || k)) {
        fail(params.at(), "a conductor has either reflectance or eta and k");
    }
    material.eta = eta.value_or(metals().at("metal-Cu-eta"));
    material.k = k.value_or(metals().at("metal-Cu-k"));
    if (has_reflectance) {
        // Find the metal of eta = 1 that reflects so much at normal incidence, as pbrt does.
        material.eta = {1, 1, 1};
        material.k = k_of_reflectance(material.reflectance);
    }
    float alpha = read_alpha(params, prefix);
    material.alpha = alpha >= smooth_below ? alpha : 0;
    return material;
}

// "spectrum eta" of a dielectric, the name of a measured glass.
void read_glass(Params& params, Material& material) {
    const Param* spectrum = params.find("spectrum", "eta");
    if (!spectrum) return;
    material.glass = params.named(*spectrum, glasses());
    if (material.glass) material.ior = index_of_refraction(*material.glass, 0.5875618);
}

Material read_dielectric(Params& params) {
    Material material;
    material.type = MaterialType::dielectric;
    constexpr float least = 1e-4f, most = 1e4f;
    material.ior = params.number("eta", 1.5f, least, most);
    read_glass(params, material);
    material.ior = std::clamp(material.ior, least, most);
    if (read_alpha(params) >= smooth_below) {
        params.stand_in(params.at(), "rough glass");
    }
    return material;
}

// What L is multiplied by for "power" or "illuminance", if L = 1 makes `of_one`. As in pbrt, values
// of 0 or less have no effect.
float read_total(Params& params, const std::string& name, float of_one) {
    float total = params.number(name, 0);
    return total > 0 ? total / of_one : 1;
}

// Where a point light stands.
Vec3 read_position(Params& params, const Transform& world_from_light) {
    Vec3d from(params.point("from", {0, 0, 0}));
    Vec3 p = to_vec3(transform_point(world_from_light, from));
    if (!(max_component(abs(p)) <= 1e9f)) fail(params.at("from"), "the light is farther than 1e9");
    return p;
}

// The unit vector towards a distant light.
Vec3 read_direction(Params& params, const Transform& world_from_light) {
    Vec3d from(params.point("from", {0, 0, 0})), to(params.point("to", {0, 0, 1}));
    if (from == to) fail(params.at("to"), "\"from\" and \"to\" are the same point");
    return to_vec3(normalize(transform_vector(world_from_light, from - to)));
}

}  // namespace

void check_brightness(const Params& params, Rgb L) {
    if (!too_bright(L)) return;
    fail(params.at(), params.owner() + " shines brighter than 1e15: choose a larger unit");
}

std::optional<Material> read_material(Params& params, TextureReader& textures) {
    Material material;
    const std::string& type = params.type();
    if (type == "diffuse") {
        read_reflectance(params, textures, material);
    } else if (type == "conductor") {
        material = read_conductor(params, textures);
    } else if (type == "dielectric") {
        material = read_dielectric(params);
    } else if (type == "interface" || type == "none" || type.empty()) {
        params.finish();
        return {};
    } else if (params.stands_in()) {
        if (type == "coatedconductor") {
            material = read_conductor(params, textures, "conductor.");
        } else {
            read_reflectance(params, textures, material);
        }
        params.ignore_rest();
        if (type == "thindielectric") return {};
    } else {
        params.fail_type({"conductor", "dielectric", "diffuse", "interface"});
    }
    material.at = kept(params.at());
    params.finish();
    return material;
}

AreaEmission read_area_light(Params& params) {
    if (params.type() != "diffuse") params.fail_type({"diffuse"});
    params.replace("string", "filename", "an image on an area light");
    AreaEmission emission;
    emission.L = params.illuminant("L", {1, 1, 1}) * params.number("scale", 1, 0);
    emission.two_sided = params.boolean("twosided", false);
    emission.power = std::max(0.0f, params.number("power", 0));
    check_brightness(params, emission.L);
    params.finish();
    return emission;
}

std::optional<SkyImage> read_sky_image(Params& params, const Transform& world_from_light,
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
    float scale = params.number("scale", 1, 0);
    Position at = params.at("filename");
    std::string path = files.find(at, params.string("filename", ""));
    Image image;
    if (params.number("illuminance", 0) > 0)
        params.replace("float", "illuminance", "the illuminance of a picture of the sky");
    bool is_read = params.read([&] { image = decode_image(path, files.read(path, at)); },
                               "a picture that cannot be read");
    params.finish();
    if (!is_read) return {};
    if (image.width != image.height && image.width != 2 * image.height) {
        fail(at, quote_file(path) +
                     " must be a square (equal areas), or twice as wide as high (longitude " +
                     "and latitude)");
    }
    sky.map = image.width == image.height ? SkyImage::Map::square : SkyImage::Map::wide;
    sky.width = image.width, sky.height = image.height;
    double sum = 0;
    for (Rgb& L : image.pixels) {
        L *= scale;
        if (!(std::min({L.r, L.g, L.b}) >= 0) || too_bright(L))
            fail(at,
                 quote_file(path) + " has a pixel that is negative, not a number, or above 1e15");
        sum += static_cast<double>(average(L));
    }
    if (sum == 0) fail(at, quote_file(path) + " is black");
    sky.pixels = std::move(image.pixels);
    return sky;
}

Light read_light(Params& params, const Transform& world_from_light) {
    Light light;
    light.at = kept(params.at());
    float scale = params.number("scale", 1, 0);
    const std::string& type = params.type();
    bool is_beam = type == "spot" || type == "goniometric" || type == "projection";
    if (type == "point" || (is_beam && params.stands_in())) {
        light.type = LightType::point;
        light.p = read_position(params, world_from_light);
        light.L = params.illuminant("I", {1, 1, 1}) * scale;
        light.L *= read_total(params, "power", 4 * pi);
        if (is_beam) params.ignore_rest();
    } else if (type == "distant") {
        light.type = LightType::distant;
        light.p = read_direction(params, world_from_light);
        light.L = params.illuminant("L", {1, 1, 1}) * scale * read_total(params, "illuminance", 1);
    } else if (type == "infinite") {
        light.type = LightType::infinite;
        // The mean of a picture is not known: it could not be read.
        bool is_picture = params.find("string", "filename");
        light.L = is_picture ? Rgb{0.5f, 0.5f, 0.5f} : params.illuminant("L", {1, 1, 1});
        light.L *= scale;
        light.L *= read_total(params, "illuminance", pi);
    } else {
        params.fail_type({"distant", "infinite", "point"});
    }
    check_brightness(params, light.L);
    params.finish();
    return light;
}
