// A scene in memory: what the reader (scene_file/reader.h) fills in and the chapters trace.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "common/geometry/bvh.h"
#include "common/geometry/geometry.h"

enum class MaterialType : uint8_t { diffuse, conductor, dielectric };

struct Material {
    MaterialType type = MaterialType::diffuse;
    Rgb reflectance = {0.5f, 0.5f, 0.5f};  // diffuse: albedo, in [0,1]
    Rgb eta, k;                            // conductor: complex index of refraction eta + i k
    float alpha = 0;                       // conductor: GGX roughness; 0: a perfect mirror
    float ior = 1.5f;                      // dielectric: index inside over index outside
    int line = 0, column = 0;              // where the scene file makes it, for messages
};

/// Whether light that arrives from one direction leaves in one direction (or two) only.
inline bool is_specular(const Material& m) {
    return m.type == MaterialType::dielectric ||
           (m.type == MaterialType::conductor && m.alpha == 0);
}

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
    int line = 0, column = 0;            // where the scene file makes it, for messages
};

/// A primitive of a light, taken apart: a triangle p0 p1 p2, or a sphere or disk of radius r at p0.
struct Emitter {
    enum Kind : uint8_t { triangle, sphere, disk } kind = triangle;
    bool inward = false;  // a sphere that shines inwards
    Vec3 p0, p1, p2;
    Vec3 n;  // unit
    float r = 0;
    float eps = 0;  // m: how far a point of it may be off
};

/// What sampling an area light needs to know of it beforehand (light_shapes.h fills this in).
struct LightShape {
    Emitter first;   // of its primitives
    float area = 0;  // m^2, of all of them
    Vec3 centre;     // of a sphere around it, m
    float radius = 0;
    bool flat = false;           // one triangle or disk, or a parallelogram
    bool parallelogram = false;  // two triangles that make corner + s e1 + t e2
    Vec3 corner, e1, e2;
    std::vector<float> area_up_to;  // running sum over its primitives, where they are more than one
};

/// One column of the alias table that lights are chosen from (chapter 10).
struct AliasColumn {
    float own;       // share of the column that is the light of the same number
    uint32_t other;  // the light that the rest of the column is
    float pmf;       // of the light of the same number, over the whole table
};

/// A light of any type as its potential sees it, in one form (light_resampling.h fills this in).
struct LightBounds {
    Vec3 centre;          // m, of a sphere around it; unit, towards a light without a place
    float has_place = 1;  // 0: distant and infinite lights
    Vec3 n;               // unit, of a flat light; else 0
    float back = 1;       // -1: a flat light that shines to both sides
    float radius = 0;     // m
    float least_cos = 1;  // of cos_y: 0 for a flat light
    float power = 0;      // L A or what corresponds to it
    float inv_pmf = 0;    // 1 / its probability in the alias table
};

/// What one Shape directive gives all its primitives.
struct Shape {
    uint32_t material = 0;  // into Scene::materials
    int light = -1;         // into Scene::lights; -1: does not shine
    bool reverse = false;   // a sphere whose normal points inwards; others are turned when read
};

/// The camera as the file says it; camera_view() in camera.h makes it ready for one picture size.
struct Camera {
    Vec3 o, right, up, forward;                         // world from camera; +z is forward
    float fov = 90;                                     // degrees across the shorter side
    std::optional<float> frame_aspect;                  // width over height, else that of the film
    std::optional<std::array<float, 4>> screen_window;  // x0 x1 y0 y1, else [-1,1] on the shorter
};

struct Scene {
    std::string file;  // as named by the user, for messages
    Geometry geometry;
    std::vector<Shape> shapes;
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<LightShape> light_shapes;   // one for each light
    std::vector<AliasColumn> light_table;   // one for each light; from chapter 10 on
    std::vector<LightBounds> light_bounds;  // one for each light; from chapter 12 on
    float radius = 0;                       // m, of a sphere around all primitives
    int sky_light = -1;                     // the infinite light among them; -1: none
    Rgb sky;                                // what all infinite lights send from any direction
    Camera camera;
    int width = 1280, height = 720;  // pixels
    int spp = 16;                    // samples per pixel
    int max_depth = 5;               // scattering events: 0 shows emitters only, 1 direct light
    Bvh bvh;                         // over geometry
};
