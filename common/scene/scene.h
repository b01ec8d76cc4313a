// A scene in memory: what the reader (scene_file/reader.h) fills in and the chapters trace.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "common/geometry/geometry.h"
#include "common/material/hit.h"

// What few look into: each is defined in a header of its own.
struct Bvh;
struct Mover;
struct Origin;
struct SkyImage;
struct Textures;

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

/// A primitive of a light, taken apart: a triangle p0 p1 p2, or a sphere or disk of radius r at p0.
struct Emitter {
    enum Kind : uint8_t { triangle, sphere, disk } kind = triangle;
    bool inward = false;  // a sphere that shines inwards
    Vec3 p0, p1, p2;
    Vec3 n;  // unit
    float r = 0;
    float eps = 0;        // m: how far a point of it may be off
    float off_plane = 0;  // m: how far off its plane, for one that is flat
};

/// What sampling an area light needs to know of it beforehand.
struct LightShape {
    Emitter first;   // of its primitives
    float area = 0;  // m^2, of all of them
    Vec3 centre;     // of a sphere around it, m
    float radius = 0;
    bool flat = false;              // one triangle or disk, or a parallelogram
    bool parallelogram = false;     // two triangles that make corners[0] + s e1 + t e2
    Vec3 corners[4], e1, e2;        // one corner after the other; the edges from the first
    std::vector<float> area_up_to;  // running sum over its primitives, where they are more than one
};

/// What one Shape directive gives all its primitives.
struct Shape {
    uint32_t material = 0;  // into Scene::materials
    int light = -1;         // into Scene::lights; -1: does not shine
    bool reverse = false;   // a sphere whose normal points inwards; others are turned when read
    const Position* at = nullptr;  // where a scene file makes it, for messages
    Vec3 x, y, z;  // of a sphere or disk: the axes of its own space in the world, unit vectors
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

/// That of a scene that was made without a file.
std::shared_ptr<const Origin> no_origin();

struct Scene {
    std::shared_ptr<const Origin> origin = no_origin();  // the files it was read from; never null
    Geometry geometry;
    std::vector<Shape> shapes;
    std::vector<Material> materials;
    std::shared_ptr<const Textures> textures;  // null: none
    std::vector<Light> lights;
    std::vector<LightShape> light_shapes;        // one for each light
    Vec3 centre;                                 // of a sphere around all primitives
    float radius = 0;                            // m, of that sphere
    int sky_light = -1;                          // the infinite light among them; -1: none
    Rgb sky;                                     // what infinite lights send, if none has an image
    std::shared_ptr<const SkyImage> sky_image;   // else the sum of all infinite lights
    std::vector<std::shared_ptr<Mover>> movers;  // shapes that move; they do not shine
    bool moves = false;                          // has movers; prepare() finds out
    Camera camera;
    int width = 1280, height = 720;  // pixels
    int spp = 16;                    // samples per pixel
    int max_depth = 5;               // scattering events: 0 shows emitters only, 1 direct light
    std::shared_ptr<const Bvh> bvh;  // over geometry; prepare() builds it

    /// What messages name: the place, if it is known, or else the file.
    Position place(const Position* at) const;
};
