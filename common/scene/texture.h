// Textures: reflectances that vary over a surface, as tables or patterns of its coordinates (u, v).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/base/vec.h"

struct Geometry;
struct Hit;
struct PrimHit;
struct Scene;

/// One texture. Its coordinates on the surface are (s, t) = scale * (u, v) + shift.
///
///   constant      value
///   picture       value * the picture at (s, t), which repeats itself; or 1 minus that (inverted)
///   checkerboard  the first input where floor(s) + floor(t) is even, else the second
struct Texture {
    enum class Kind : uint8_t { constant, picture, checkerboard };

    Kind kind = Kind::constant;
    bool nearest = false, inverted = false;  // nearest: the texel there, not a mean of four
    Rgb value = {1, 1, 1};
    Vec2 scale = {1, 1}, shift;
    uint32_t picture = 0;                 // into Textures::pictures
    std::array<uint32_t, 2> inputs = {};  // into Textures::all; they stand before this one
};

struct TexturePicture {
    int width = 0, height = 0;
    std::vector<Rgb> texels;  // linear reflectances, row by row from the top left
};

/// The nearest reflectance.
inline Rgb from_0_to_1(Rgb a) {
    return {std::clamp(a.r, 0.f, 1.f), std::clamp(a.g, 0.f, 1.f), std::clamp(a.b, 0.f, 1.f)};
}

struct Textures {
    std::vector<Texture> all;
    std::vector<TexturePicture> pictures;
};

/// The reflectance of a texture at (u, v), in [0,1].
///
///   (s, t) = (0, 0) is the lower left corner of a picture, (1, 1) the upper right; texel (i, j)
///   from the top left has its middle at s = (i + 1/2) / width, 1 - t = (j + 1/2) / height.
///   Between the middles of four texels the value is bilinear.
///
/// Each number of (u, v), scale and shift is at most 1e9.
/// source  pbrt-v4      tested by  "truth: textures as computed in double precision"
Rgb value_at(const Textures& textures, uint32_t texture, Vec2 uv);

/// Gives x, a point of the primitive that was found, the reflectance that its texture has there.
void look_up_texture(const Scene& scene, const Geometry& g, const PrimHit& found, Hit& x);
