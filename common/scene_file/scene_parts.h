// What the directives of a pbrt-v4 scene file make: transforms, camera, textures, materials,
// lights, shapes.
#pragma once
#include "common/geometry/transform.h"
#include "common/picture/image.h"
#include "common/scene/scene.h"
#include "common/scene/sky_image.h"
#include "common/scene/texture.h"
#include "common/scene_file/params.h"

/// Reads the numbers after Identity, Translate, Scale, Rotate, LookAt, Transform or
/// ConcatTransform: what the current transform is multiplied by from the right, or replaced by. A
/// matrix that projects becomes one that is not usable.
Transform read_transform(Lexer& lexer, const std::string& directive);
/// Whether it has an inverse, of numbers that are not too large.
bool is_usable(const Transform& transform);

Camera read_camera(const Params& params, const Transform& camera_from_world);
/// Film, PixelFilter, Sampler and Integrator: how pbrt renders, of which little counts here. iso:
/// the film's speed, which scales the picture.
void read_setting(const std::string& directive, const Params& params, Scene& scene, float& iso);

/// The picture that "filename" names, of numbers from 0 to `most`. Nothing where its stand-in is to
/// be taken, grey.
///
/// gamma  how codes become linear values, see to_linear()
std::optional<Image> read_picture(const Params& params, float gamma, float most);

/// A texture, and what a material that names it must know.
struct NamedTexture {
    uint32_t index = 0;     // into Textures::all
    Rgb most, mean;         // an upper bound of its values, and what they are on average
    bool needs_uv = false;  // varies over the surface
    uint64_t depth = 1;     // of textures that are made of textures
};

/// Reads textures and finds them by name. Those of type "float" are read over.
class TextureReader {
public:
    /// Reads what stands after the word Texture.
    void read(Lexer& lexer, const Position& at, Input& input, const std::vector<Param>& defaults);
    /// The texture that a parameter "texture NAME" names; nothing where it is not given.
    std::optional<NamedTexture> find(const Params& params, const std::string& name) const;
    /// What the texture of this number is on average.
    Rgb mean(uint32_t texture) const { return means_[texture]; }
    Textures take() { return std::move(textures_); }

private:
    NamedTexture read_texture(const Params& params);
    NamedTexture read_scaled(const Params& params);
    NamedTexture read_checkerboard(const Params& params);
    NamedTexture read_input(const Params& params, const std::string& name);
    NamedTexture read_picture_texture(const Params& params);
    std::optional<uint32_t> picture(const Params& params, float gamma);
    NamedTexture add(const Params& params, const Texture& texture, NamedTexture named);
    NamedTexture constant(const Params& params, Rgb value);

    Textures textures_;
    std::vector<Rgb> means_;  // of each
    std::map<std::string, NamedTexture> known_;
    std::map<std::pair<std::string, float>, uint32_t> pictures_;  // by canonical name and gamma
    uint64_t texels_ = 0;
};

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
std::optional<SkyImage> read_sky_image(const Params& params, const Transform& world_from_light);

/// From all sides, and 1e9 m away: 1e35 W. Powers and sums of brighter lights may be no floats.
inline constexpr float brightest = 1e15f;
inline bool too_bright(Rgb L) { return !(is_finite(L) && max_component(L) <= brightest); }
void check_brightness(const Params& params, Rgb L);

/// What AttributeBegin saves and AttributeEnd restores.
struct State {
    std::string begin;  // what began the block, and where
    Position at;
    Transform start, end;  // the current transform when the shutter opens and when it closes
    std::string unusable;  // why nothing can stand there, as a message
    bool set_start = true, set_end = true;  // which of them a transform directive changes
    uint32_t material = 0;                  // into Scene::materials
    std::optional<AreaEmission> emission;
    bool reverse_orientation = false;
    std::map<std::string, std::vector<Param>> defaults = {
        {"light", {}}, {"material", {}}, {"medium", {}}, {"shape", {}}, {"texture", {}}};
};
/// Adds the primitives of one Shape directive, where they are at the start, and their lights, to
/// the scene; of a mesh those triangles that have an area.
///
/// The side of a surface, which decides where it shines:
///   triangle  (p1-p0) x (p2-p0), whatever the transform mirrors; where there are vertex normals,
///             theirs; the order of the corners in the scene says the same
///   sphere    outwards;   disk  object space's +z, carried along as a normal
/// and ReverseOrientation turns each to the other side.
void read_shape(const Params& params, const State& state, Scene& scene);
