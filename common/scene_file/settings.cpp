#include <algorithm>

#include "common/scene_file/scene_parts.h"

namespace {

void note(const Params& params, const std::string& text) {
    params.messages().note(params.at(), params.owner() + ' ' + text);
}

void place_camera(const Params& params, const Transform& world_from_camera, Camera& camera) {
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
}

// Reads what part of the plane in front of the camera is seen.
void read_screen(const Params& params, Camera& camera) {
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

}  // namespace

Camera read_camera(const Params& params, const Transform& camera_from_world) {
    Camera camera;
    camera.at = kept(params.at());
    place_camera(params, inverse(camera_from_world), camera);
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

void read_setting(const std::string& directive, const Params& params, Scene& scene, float& iso) {
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
