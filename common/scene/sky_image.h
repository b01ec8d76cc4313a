// A picture of the sky: which pixel lies in which direction.
#pragma once
#include <cstdint>
#include <vector>

#include "common/base/vec.h"

struct Position;

/// What an infinite light sends, as a picture around the scene, from its top row to its bottom row.
///
/// square   pbrt's: equal areas of the picture are equal solid angles; z is the middle, -z the
///          corners
/// wide     longitude and latitude: z is the top, -z the bottom, x the left edge and the right
struct SkyImage {
    enum class Map : uint8_t { square, wide };

    Map map = Map::square;
    int width = 0, height = 0;
    std::vector<Rgb> pixels;                           // W m^-2 sr^-1
    Vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};  // its axes in the world, orthonormal
    const Position* at_file = nullptr;                 // where a scene file makes it, for messages

    /// The number of the pixel at (u, v), from the top left, in [0,1]^2.
    size_t pixel_at(Vec2 uv) const {
        int i = std::min(static_cast<int>(uv.x * static_cast<float>(width)), width - 1);
        int j = std::min(static_cast<int>(uv.y * static_cast<float>(height)), height - 1);
        return static_cast<size_t>(j) * static_cast<size_t>(width) + static_cast<size_t>(i);
    }
    /// A point of a pixel, u in [0,1)^2 from its top left.
    Vec2 point_in(size_t pixel, Vec2 u) const {
        size_t w = static_cast<size_t>(width);
        return {(static_cast<float>(pixel % w) + u.x) / static_cast<float>(width),
                (static_cast<float>(pixel / w) + u.y) / static_cast<float>(height)};
    }
    Vec2 middle_of(size_t pixel) const { return point_in(pixel, {0.5f, 0.5f}); }
    Rgb at(Vec2 uv) const { return pixels[pixel_at(uv)]; }
};

/// The unit vector towards the point uv of the picture, in the world.
///
/// tested by  "identity: each map of the sky and its inverse"
Vec3 direction_of(const SkyImage& sky, Vec2 uv);
/// The point of the picture that lies in direction wi.
Vec2 point_of(const SkyImage& sky, Vec3 wi);

/// Solid angle per area of the picture, at uv, in sr: the whole picture has area 1.
///
///   square: 4 pi      wide: 2 pi^2 sin(theta)
float solid_angle_per_area(const SkyImage& sky, Vec2 uv);
