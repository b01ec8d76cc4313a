#include "common/scene_file/settings.h"

#include <algorithm>

namespace {

// Finds the kind, and reads over the parameters of pbrt's own ways to render.
void accept(Params& params, const std::vector<std::string>& kinds) {
    if (std::find(kinds.begin(), kinds.end(), params.type()) == kinds.end())
        params.fail_type(kinds);
    params.ignore("integer", {"bootstrapsamples", "chains", "intersectcost", "maxdepth",
                              "maxnodeprims", "maxprims", "mutationsperpixel",
                              "photonsperiteration", "seed", "traversalcost"});
    params.ignore("float", {"B", "C", "emptybonus", "largestepprobability", "maxdistance", "radius",
                            "rrthreshold", "sigma", "tau", "xradius", "yradius"});
    params.ignore("string", {"lightsampler", "randomization", "splitmethod"});
    params.ignore("bool", {"cossample", "jitter", "regularize", "samplebsdf", "samplelights",
                           "visualizestrategies", "visualizeweights"});
    params.finish();
}

void note(SceneNotes& notes, const Params& params, const std::string& text) {
    notes.add(params.at(), params.owner() + ' ' + text);
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

// The narrowest field of view, in degrees: in a narrower one floats do not tell the rays of
// neighbouring pixels apart.
constexpr float narrowest = 0.001f;

// Reads what part of the plane in front of the camera is seen.
void read_screen(Params& params, Camera& camera) {
    camera.fov = params.number("fov", 90, narrowest, 180 - narrowest);
    if (params.find("float", "frameaspectratio"))
        camera.frame_aspect = params.number("frameaspectratio", 1, 1e-4f, 1e4f);
    if (const Param* window = params.find_exactly("float", "screenwindow", 4)) {
        auto& w = camera.screen_window.emplace();
        std::transform(window->numbers.begin(), window->numbers.end(), w.begin(),
                       [](double x) { return static_cast<float>(x); });
        if (!(w[0] < w[1] && w[2] < w[3])) fail(window->at, "screenwindow is empty");
        float shorter = std::min(w[1] - w[0], w[3] - w[2]);
        if (!(std::tan(camera.fov * pi / 360) * shorter >= narrowest * pi / 180)) {
            fail(window->at, "screenwindow shows less than 0.001 degrees");
        }
        for (float edge : w) {
            if (std::abs(edge) > 1e4f) fail(window->at, "screenwindow reaches farther than 1e4");
        }
    }
}

// Makes a perspective camera that shows about what one of the other types does.
void stand_in_for(const std::string& type, Camera& camera) {
    camera.lens_radius = 0;
    constexpr float far = 200;  // units, of which the view of an orthographic camera is 2 wide
    if (type == "orthographic") {
        camera.o = camera.o - far * camera.forward;
        camera.fov = 2 * std::atan(1 / far) * 180 / pi;
    } else if (type == "realistic") {
        camera.fov = 40;
    }
}

void read_lens(Params& params, Camera& camera) {
    camera.lens_radius = params.number("lensradius", 0, 0, 1e6f);
    bool is_pinhole = camera.lens_radius == 0;  // of which a focal distance means nothing
    if (is_pinhole) params.ignore("float", {"focaldistance"});
    camera.focal_distance = is_pinhole ? 1e6f : params.number("focaldistance", 1e6f, 1e-6f, 1e9f);
    camera.at = kept(params.at());
}

}  // namespace

void read_camera(Params& params, const Transform& camera_from_world, Camera& camera,
                 Exposure& exposure) {
    bool stands_in = params.type() != "perspective" && params.stands_in();
    if (params.type() != "perspective" && !stands_in) params.fail_type({"perspective"});
    camera = {};
    place_camera(params, inverse(camera_from_world), camera);
    read_screen(params, camera);
    read_lens(params, camera);
    if (stands_in) stand_in_for(params.type(), camera);
    camera.shutter_open = params.number("shutteropen", 0);
    camera.shutter_close = params.number("shutterclose", 1);
    // A pinhole has no size, so the unit of its axes is free: near 1, their products are neither
    // too small nor too large for floats. A power of two leaves all rays as they are.
    if (camera.lens_radius == 0) {
        int exponent = static_cast<int>(std::lround(std::log2(length(camera.forward))));
        for (Vec3* axis : {&camera.right, &camera.up, &camera.forward}) {
            *axis = std::ldexp(1.0f, -exponent) * *axis;
        }
    }
    if (stands_in) params.ignore_rest();
    exposure.shutter = camera.shutter_close - camera.shutter_open;
    if (!(exposure.shutter > 0)) {
        fail(params.at("shutterclose"), "shutterclose must be after shutteropen");
    }
    params.finish();
}

void read_film(Params& params, Scene& scene, Exposure& exposure, SceneNotes& notes) {
    bool stands_in = params.type() != "rgb" && params.stands_in();
    if (params.type() != "rgb" && !stands_in) params.fail_type({"rgb"});
    constexpr int widest = 1 << 16;
    constexpr int64_t most_pixels = 1 << 28;
    scene.width = params.integer("xresolution", 1280, 1, widest);
    scene.height = params.integer("yresolution", 720, 1, widest);
    if (int64_t{scene.width} * scene.height > most_pixels) {
        fail(params.at(), "more than 2^28 pixels");
    }
    exposure.iso = params.number("iso", 100, 1e-30f);

    params.replace("float", "cropwindow", "a part of the film");
    params.replace("integer", "pixelbounds", "a part of the film");
    if (params.string("sensor", "cie1931") != "cie1931")
        params.replace("string", "sensor", "a sensor or white balance");
    if (params.number("whitebalance", 0) != 0)
        params.replace("float", "whitebalance", "a sensor or white balance");
    if (params.find("float", "maxcomponentvalue")) {
        note(notes, params, "maxcomponentvalue is ignored: nothing is clamped");
    }
    params.ignore("string", {"filename"});
    params.ignore("float", {"diagonal"});
    params.ignore("bool", {"savefp16"});
    if (stands_in) params.ignore_rest();
    params.finish();
}

void read_setting(const std::string& directive, Params& params, Scene& scene, SceneNotes& notes) {
    const std::string& type = params.type();
    if (directive == "PixelFilter") {
        float radius = std::max(params.number("xradius", 0.5f), params.number("yradius", 0.5f));
        accept(params, {"box", "gaussian", "mitchell", "sinc", "triangle"});
        if (type != "box" || radius != 0.5f)
            note(notes, params, "is replaced by the box of one pixel");
    } else if (directive == "Sampler") {
        constexpr int most = 1 << 24, most_strata = 1 << 12;  // along one axis
        scene.spp = type == "stratified"
                        ? params.integer("xsamples", 4, 1, most_strata) *
                              params.integer("ysamples", 4, 1, most_strata)
                        : params.integer("pixelsamples", type == "independent" ? 4 : 16, 1, most);
        accept(params, {"halton", "independent", "paddedsobol", "pmj02bn", "sobol", "stratified",
                        "zsobol"});
        if (type != "independent") note(notes, params, "only sets the samples per pixel");
    } else if (directive == "Integrator") {
        scene.max_depth = params.integer("maxdepth", 5, 0, 1 << 30);
        accept(params, {"ambientocclusion", "bdpt", "lightpath", "mlt", "path", "randomwalk",
                        "simplepath", "simplevolpath", "sppm", "volpath"});
        if (type != "path")
            note(notes, params, "only sets the depth: the program is the integrator");
    } else {
        accept(params, {"bvh", "kdtree"});
        if (type != "bvh") note(notes, params, "is ignored: all programs use a BVH");
    }
}
