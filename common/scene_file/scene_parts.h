// What the directives of a pbrt-v4 scene file make: transforms, camera, materials, lights, shapes.
#pragma once
#include "common/geometry/transform.h"
#include "common/scene/scene.h"
#include "common/scene/sky_image.h"
#include "common/scene_file/textures.h"

/// Reads the numbers after Identity, Translate, Scale, Rotate, LookAt, Transform or
/// ConcatTransform: what the current transform is multiplied by from the right, or replaced by. A
/// matrix that projects becomes one that is not usable.
Transform read_transform(Lexer& lexer, const Token& directive);
/// Whether it has an inverse, of numbers that are not too large.
bool is_usable(const Transform& transform);

Camera read_camera(const Params& params, const Transform& camera_from_world);
/// Film, PixelFilter, Sampler and Integrator: how pbrt renders, of which little counts here. iso:
/// the film's speed, which scales the picture.
void read_setting(const std::string& directive, const Params& params, Scene& scene, float& iso);

/// Nothing for a material that is as if the surface were not there: it only bounds media.
std::optional<Material> read_material(const Params& params, const TextureReader& textures);

/// What AreaLightSource says about the shapes after it.
struct AreaEmission {
    Rgb L;
    float power = 0;  // W of each primitive, by which L is multiplied; 0: L is the radiance
    bool two_sided = false;
};
AreaEmission read_area_light(const Params& params);
Light read_light(const Params& params, const Transform& world_from_light);
/// The picture that an infinite light names: square or twice as wide as high, see SkyImage. Nothing
/// where its stand-in is to be taken, a sky that is grey.
std::optional<SkyImage> read_sky_image(const Params& params, const Transform& world_from_light,
                                       NamedFiles& files);

/// Whether powers and sums of such lights may be no floats. From all sides, and 1e9 m away: 1e35 W.
inline bool too_bright(Rgb L) { return !(is_finite(L) && max_component(L) <= 1e15f); }
void check_brightness(const Params& params, Rgb L);

/// What is in force where a Shape directive stands.
struct ShapeState {
    Transform world_from_object;
    uint32_t material = 0;  // into Scene::materials
    std::optional<AreaEmission> emission;
    bool reverse_orientation = false;
};
/// Adds the primitives of one Shape directive, and their lights, to the scene; of a mesh those
/// triangles that have an area.
///
/// The side of a surface, which decides where it shines:
///   triangle  (p1-p0) x (p2-p0), whatever the transform mirrors; where there are vertex normals,
///             theirs; the order of the corners in the scene says the same
///   sphere    outwards;   disk  object space's +z, carried along as a normal
/// and ReverseOrientation turns each to the other side.
void read_shape(const Params& params, ShapeState state, NamedFiles& files, Scene& scene);
/// Gives each area light its range of primitives, once all are read.
void number_light_primitives(Scene& scene);
