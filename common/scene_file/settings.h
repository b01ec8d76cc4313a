// What a pbrt-v4 scene file says of all but shapes and materials: transforms, the camera, how pbrt
// renders, lights.
#pragma once
#include <algorithm>
#include <array>

#include "common/geometry/transform.h"
#include "common/scene/scene.h"
#include "common/scene/sky_image.h"
#include "common/scene_file/materials.h"

inline Vec3d read_three(Lexer& lexer, const std::string& name) {
    Vec3d v;
    for (double* x : {&v.x, &v.y, &v.z}) *x = lexer.number(name);
    return v;
}

// Reads [ 16 numbers ], column by column.
inline Transform read_matrix(Lexer& lexer, const std::string& name) {
    lexer.expect(Token::opens, name + " needs [ and 16 numbers");
    std::array<double, 16> m;
    for (double& x : m) x = lexer.number(name);
    lexer.expect(Token::closes, name + " needs ] after 16 numbers");

    constexpr double tolerance = 1e-6;
    double bottom = std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1);
    if (bottom > tolerance) m = {};
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

/// Reads the numbers after Identity, Translate, Scale, Rotate, LookAt, Transform or
/// ConcatTransform: what the current transform is multiplied by from the right, or replaced by. A
/// matrix that projects becomes one that is not usable.
inline Transform read_transform(Lexer& lexer, const std::string& name) {
    if (name == "Identity") return {};
    if (name == "Transform" || name == "ConcatTransform") return read_matrix(lexer, name);
    if (name == "Translate") return translation(read_three(lexer, name));
    if (name == "Scale") return scaling(read_three(lexer, name));
    if (name == "Rotate") {
        double degrees = lexer.number(name);
        return rotation(degrees, read_three(lexer, name));
    }
    Vec3d eye = read_three(lexer, name), look = read_three(lexer, name);
    Vec3d up = read_three(lexer, name);
    return inverse(look_at(eye, look, up));
}

/// Whether it has an inverse, of numbers that are not too large.
inline bool is_usable(const Transform& t) {
    double size = length(t.x) + length(t.y) + length(t.z) + length(t.o);
    return size <= 1e30 && std::abs(determinant(t)) > 1e-60;
}

/// Throws for a point so far out that squares of areas would overflow a float.
inline void check_extent(const Params& params, Vec3 p) {
    if (is_finite(p) && max_component(abs(p)) <= 1e9f) return;
    fail(params.at(), params.owner() + " reaches farther than 1e9: choose a larger unit");
}

// Reads what part of the plane in front of the camera is seen.
inline void read_screen(const Params& params, Camera& camera) {
    camera.fov = params.number("fov");
    if (params.find("frameaspectratio")) camera.frame_aspect = params.number("frameaspectratio");
    const Param* window = params.find("screenwindow");
    if (!window) return;
    auto& w = camera.screen_window.emplace();
    for (size_t i = 0; i < 4; i++) w[i] = static_cast<float>(window->numbers[i]);
    if (!(w[0] < w[1] && w[2] < w[3])) fail(window->at, "nothing is seen in screenwindow");
}

inline Camera read_camera(const Params& params, const Transform& world_from_camera) {
    Camera camera;
    camera.at = kept(params.at());
    camera.o = to_vec3(world_from_camera.o);
    camera.right = to_vec3(world_from_camera.x);
    camera.up = to_vec3(world_from_camera.y);
    camera.forward = to_vec3(world_from_camera.z);
    check_extent(params, camera.o);
    for (Vec3 axis : {camera.right, camera.up, camera.forward}) {
        if (length(axis) > 1e-6f && length(axis) < 1e6f) continue;
        fail(params.at(), "the camera's transform is too large or too small");
    }
    read_screen(params, camera);
    camera.lens_radius = params.stands_in() ? 0 : params.number("lensradius");
    // Of a pinhole a focal distance means nothing.
    if (camera.lens_radius > 0) camera.focal_distance = params.number("focaldistance");
    if (camera.focal_distance < 1e-6f) {
        fail(params.at("focaldistance"), "\"focaldistance\" must be at least 1e-06");
    }
    camera.shutter_open = params.number("shutteropen");
    camera.shutter_close = params.number("shutterclose");
    // A pinhole has no size, so the unit of its axes is free: near 1, their products are neither
    // too small nor too large for floats. A power of two leaves all rays as they are.
    if (camera.lens_radius == 0) {
        int exponent = static_cast<int>(std::lround(std::log2(length(camera.forward))));
        for (Vec3* axis : {&camera.right, &camera.up, &camera.forward}) {
            *axis = std::ldexp(1.0f, -exponent) * *axis;
        }
    }
    return camera;
}

/// Film, PixelFilter, Sampler and Integrator: how pbrt renders, of which little counts here.
inline void read_setting(const std::string& directive, const Params& params, Scene& scene) {
    const std::string& type = params.type();
    if (directive == "Film") {
        scene.width = params.integer("xresolution");
        scene.height = params.integer("yresolution");
        if (int64_t{scene.width} * scene.height > 1 << 28) {
            fail(params.at(), "more than 2^28 pixels");
        }
        if (params.find("maxcomponentvalue")) params.note("does not clamp: no value is too large");
    } else if (directive == "PixelFilter") {
        float radius = std::max(params.number("xradius"), params.number("yradius"));
        if (type != "box" || radius != 0.5f) params.note("is replaced by the box of one pixel");
    } else if (directive == "Sampler") {
        scene.spp = type == "stratified" ? params.integer("xsamples") * params.integer("ysamples")
                                         : params.integer("pixelsamples");
        if (type != "independent") params.note("only sets the samples per pixel");
    } else {
        scene.max_depth = params.integer("maxdepth");
        if (type != "path") params.note("only sets the depth: the program is the integrator");
    }
}

// What L is multiplied by for "power" or "illuminance", if L = 1 makes `of_one`. As in pbrt, values
// of 0 or less have no effect.
inline float read_total(const Params& params, const std::string& name, float of_one) {
    float total = params.number(name);
    return total > 0 ? total / of_one : 1;
}

/// What AreaLightSource says about the shapes after it.
struct AreaEmission {
    Rgb L;
    float power = 0;  // W of each primitive, by which L is multiplied; 0: L is the radiance
    bool two_sided = false;
};
inline AreaEmission read_area_light(const Params& params) {
    return {params.color("L") * params.number("scale"), std::max(0.0f, params.number("power")),
            params.boolean("twosided")};
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
    if (max_component(abs(Vec3{dot(sky.x, sky.y), dot(sky.y, sky.z), dot(sky.z, sky.x)})) > 1e-4f) {
        fail(params.at(), "the sky's picture may be turned and mirrored, but not sheared");
    }
    if (params.number("illuminance") > 0) {
        params.stand_in("the illuminance of a picture of the sky", "illuminance");
    }
    std::optional<Image> image = read_picture(params, 0);
    if (!image) return {};
    sky.width = image->width;
    sky.height = image->height;
    bool is_square = sky.width == sky.height;
    if (!is_square && sky.width != 2 * sky.height) {
        fail(params.at("filename"), "the sky's picture must be a square or twice as wide as high");
    }
    sky.map = is_square ? SkyImage::Map::square : SkyImage::Map::wide;
    sky.pixels = std::move(image->pixels);
    float scale = params.number("scale");
    for (Rgb& L : sky.pixels) L *= scale;
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
        Rgb L = params.find("filename") ? Rgb{0.5f, 0.5f, 0.5f} : params.color("L");
        light.L = L * scale * read_total(params, "illuminance", pi);
    } else {
        light.type = LightType::point;
        light.p = to_vec3(transform_point(world_from_light, from));
        check_extent(params, light.p);
        light.L = params.color("I") * scale * read_total(params, "power", 4 * pi);
    }
    return light;
}
