// Lights of a pbrt-v4 scene file.
#pragma once
#include <algorithm>

#include "common/geometry/transform.h"
#include "common/scene/scene.h"
#include "common/scene/sky_image.h"
#include "common/scene_file/textures.h"

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

// Adds the light of a primitive of this area, and returns its number.
inline int add_light(const Params& params, const AreaEmission& emission, float area, Scene& scene) {
    Light light;
    light.L = emission.L;
    if (emission.power > 0) {
        float of_one = pi * area * (emission.two_sided ? 2 : 1);  // W, of L = 1
        // Half of a patch's power for each of its triangles.
        float power = params.type() == "bilinearmesh" ? emission.power / 2 : emission.power;
        light.L *= power / of_one;
    }
    check_brightness(params, light.L);
    light.two_sided = emission.two_sided;
    light.at = kept(params.at());
    scene.lights.push_back(light);
    return static_cast<int>(scene.lights.size()) - 1;
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
