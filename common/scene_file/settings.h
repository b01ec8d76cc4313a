// What the directives before the world of a pbrt-v4 scene file say: transforms, the camera, how
// pbrt renders.
#pragma once
#include <algorithm>
#include <array>

#include "common/geometry/transform.h"
#include "common/scene/scene.h"
#include "common/scene_file/params.h"

inline void note(const Params& params, const std::string& text) {
    params.note(params.owner() + ' ' + text);
}

// Reads what part of the plane in front of the camera is seen.
inline void read_screen(const Params& params, Camera& camera) {
    camera.fov = params.number("fov");
    if (params.find("frameaspectratio")) camera.frame_aspect = params.number("frameaspectratio");
    const Param* window = params.find("screenwindow");
    if (!window) return;
    auto& w = camera.screen_window.emplace();
    std::transform(window->numbers.begin(), window->numbers.end(), w.begin(),
                   [](double x) { return static_cast<float>(x); });
    // In a narrower one floats do not tell the rays of neighbouring pixels apart.
    constexpr float narrowest = 0.001f;  // degrees
    float shorter = std::min(w[1] - w[0], w[3] - w[2]);
    if (!(std::tan(camera.fov * pi / 360) * shorter >= narrowest * pi / 180)) {
        fail(window->at, "screenwindow shows less than 0.001 degrees");
    }
}

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

inline Camera read_camera(const Params& params, const Transform& camera_from_world) {
    Camera camera;
    camera.at = kept(params.at());
    const Transform world_from_camera = inverse(camera_from_world);
    camera.o = to_vec3(world_from_camera.o);
    camera.right = to_vec3(world_from_camera.x);
    camera.up = to_vec3(world_from_camera.y);
    camera.forward = to_vec3(world_from_camera.z);
    for (Vec3 axis : {camera.right, camera.up, camera.forward}) {
        bool usable = length(axis) > 1e-6f && length(axis) < 1e6f;
        if (!usable || !(max_component(abs(camera.o)) <= 1e9f)) {
            fail(params.at(), "the camera's transform is too large or too small");
        }
    }
    read_screen(params, camera);
    camera.lens_radius = params.stands_in() ? 0 : params.number("lensradius");
    // Of a pinhole a focal distance means nothing.
    if (camera.lens_radius > 0) camera.focal_distance = params.number("focaldistance");
    if (camera.focal_distance < 1e-6f) {
        fail(params.at("focaldistance"), "\"focaldistance\" must be at least 1e-06");
    }
    if (params.type() == "orthographic") {
        constexpr float far = 200;  // units, of which its view is 2 wide
        camera.o = camera.o - far * camera.forward;
        camera.fov = 2 * std::atan(1 / far) * 180 / pi;
    } else if (params.type() == "realistic") {
        camera.fov = 40;
    }
    camera.shutter_open = params.number("shutteropen");
    camera.shutter_close = params.number("shutterclose");
    if (!(camera.shutter_close > camera.shutter_open)) {
        fail(params.at("shutterclose"), "shutterclose must be after shutteropen");
    }
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

/// Film, PixelFilter, Sampler and Integrator: how pbrt renders, of which little counts here. iso:
/// the film's speed, which scales the picture.
inline void read_setting(const std::string& directive, const Params& params, Scene& scene,
                         float& iso) {
    const std::string& type = params.type();
    if (directive == "Film") {
        scene.width = params.integer("xresolution");
        scene.height = params.integer("yresolution");
        iso = params.number("iso");
        if (int64_t{scene.width} * scene.height > 1 << 28) {
            fail(params.at(), "more than 2^28 pixels");
        }
        if (params.find("maxcomponentvalue")) {
            note(params, "maxcomponentvalue is ignored: nothing is clamped");
        }
    } else if (directive == "PixelFilter") {
        float radius = std::max(params.number("xradius"), params.number("yradius"));
        if (type != "box" || radius != 0.5f) note(params, "is replaced by the box of one pixel");
    } else if (directive == "Sampler") {
        scene.spp = type == "stratified" ? params.integer("xsamples") * params.integer("ysamples")
                                         : params.integer("pixelsamples");
        if (type != "independent") note(params, "only sets the samples per pixel");
    } else {
        scene.max_depth = params.integer("maxdepth");
        if (type != "path") note(params, "only sets the depth: the program is the integrator");
    }
}

/// Whether it has an inverse, of numbers that are not too large.
inline bool is_usable(const Transform& t) {
    constexpr double largest = 1e30;
    for (Vec3d v : {t.x, t.y, t.z, t.o}) {
        for (double x : {v.x, v.y, v.z}) {
            if (!(std::abs(x) <= largest)) return false;
        }
    }
    return std::abs(determinant(t)) > 1 / (largest * largest);
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
