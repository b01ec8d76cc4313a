// A scene in memory: what the reader (scene_file/reader.h) fills in and the chapters trace.
#pragma once
#include <array>
#include <optional>
#include <set>
#include <string>

#include "common/base/position.h"
#include "common/geometry/bvh.h"
#include "common/geometry/geometry.h"
#include "common/material/material.h"
#include "common/scene/light_shape.h"
#include "common/scene/mover.h"
#include "common/scene/sky_image.h"
#include "common/scene/texture.h"

enum class LightType : uint8_t { area, point, distant, infinite };

/// Something that shines. L is, for
///   area      the radiance of each of its primitives on the side of the normal (or both sides)
///   point     the intensity, W sr^-1
///   distant   the irradiance on a plane that faces it, W m^-2
///   infinite  the radiance of the sky, the same from everywhere
struct Light {
    LightType type = LightType::area;
    Rgb L;
    bool two_sided = false;
    Vec3 p;                              // point: where it is; distant: unit, towards the light
    uint32_t first_prim = 0, prims = 0;  // area: its primitives, one after the other
    const Position* at = nullptr;        // where a scene file makes it, for messages
};

/// What one Shape directive gives all its primitives.
struct Shape {
    uint32_t material = 0;  // into Scene::materials
    int light = -1;         // into Scene::lights; -1: does not shine
    bool reverse = false;   // a sphere whose normal points inwards; others are turned when read
    int axes = -1;          // of a sphere or disk, into Scene::axes; -1: the world's
    const Position* at = nullptr;  // where a scene file makes it, for messages
};

/// The axes of a shape's own space, in the world: unit vectors.
struct Axes {
    Vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    bool operator==(const Axes&) const = default;
};

/// The camera as the file says it; camera_view() in camera.h makes it ready for one picture size.
struct Camera {
    Vec3 o, right, up, forward;                         // world from camera; +z is forward
    float fov = 90;                                     // degrees across the shorter side
    std::optional<float> frame_aspect;                  // width over height, else that of the film
    std::optional<std::array<float, 4>> screen_window;  // x0 x1 y0 y1, else [-1,1] on the shorter
    float lens_radius = 0;                              // 0: a pinhole
    float focal_distance =
        1e6f;  // to the plane that is sharp, along the axis; both in camera units
    float shutter_open = 0, shutter_close = 1;  // s; shapes move from 0 to 1
    bool pixel_centre = false;  // rays through the middles of pixels alone: a mistake (chapter 16)
    const Position* at = nullptr;  // where a scene file sets it up, for messages
};

/// Something in the scene that is not modelled, and what is rendered in its place.
struct UsedStandIn {
    std::string what, instead;
    size_t places = 0;  // in the scene files
    Position first;

    /// `Shape "curve" as nothing (3 places, first scene.pbrt:4:1)`.
    std::string text() const {
        return what + " as " + instead + " (" + std::to_string(places) +
               (places == 1 ? " place, " : " places, first ") + place_text(first) + ')';
    }
};

struct Scene {
    std::string file;             // as named by the user, for messages
    std::set<std::string> files;  // all that it was read from
    uint64_t files_checksum = 0;  // of their bytes
    std::vector<UsedStandIn> stand_ins;
    Geometry geometry;
    std::vector<Shape> shapes;
    std::vector<Material> materials;
    Textures textures;
    std::vector<Axes> axes;
    std::vector<Light> lights;
    std::vector<LightShape> light_shapes;  // one for each light
    Vec3 centre;                           // of a sphere around all primitives
    float radius = 0;                      // m, of that sphere
    int sky_light = -1;                    // the infinite light among them; -1: none
    Rgb sky;                               // what infinite lights send, if none has an image
    std::optional<SkyImage> sky_image;     // else the sum of all infinite lights
    std::vector<Mover> movers;             // shapes that move; they do not shine
    bool moves_or_varies = false;          // has movers or textures; prepare() finds out
    bool has_normals = false;              // of a mesh's corners; prepare() finds out
    Camera camera;
    int width = 1280, height = 720;  // pixels
    int spp = 16;                    // samples per pixel
    int max_depth = 5;               // scattering events: 0 shows emitters only, 1 direct light
    Bvh bvh;                         // over geometry

    /// What messages name: the place, if it is known, or else the file.
    Position place(const Position* at) const { return at ? *at : Position{file}; }

    // The compiler's own; defined in prepare.cpp, or each file would compile them once more.
    Scene();
    Scene(const Scene&);
    Scene(Scene&&);
    Scene& operator=(const Scene&);
    Scene& operator=(Scene&&);
    ~Scene();
};
