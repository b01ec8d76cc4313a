// Materials and lights of a pbrt-v4 scene file.
#pragma once
#include <optional>

#include "common/geometry/transform.h"
#include "common/scene/scene.h"
#include "common/scene/sky_image.h"
#include "common/scene_file/textures.h"

/// Nothing for a material that is as if the surface were not there: it only bounds media.
std::optional<Material> read_material(Params& params, TextureReader& textures);

/// What AreaLightSource says about the shapes after it.
struct AreaEmission {
    Rgb L;
    float power = 0;  // W of each primitive, by which L is multiplied; 0: L is the radiance
    bool two_sided = false;
};
AreaEmission read_area_light(Params& params);

/// Whether powers and sums of such lights may be no floats. From all sides, and 1e9 m away: 1e35 W.
inline bool too_bright(Rgb L) { return !(is_finite(L) && max_component(L) <= 1e15f); }
void check_brightness(const Params& params, Rgb L);

/// The picture that an infinite light names: square or twice as wide as high, see SkyImage. Nothing
/// where its stand-in is to be taken, a sky that is grey.
std::optional<SkyImage> read_sky_image(Params& params, const Transform& world_from_light,
                                       NamedFiles& files);

Light read_light(Params& params, const Transform& world_from_light);
