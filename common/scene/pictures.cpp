#include "common/scene/intersect.h"
#include "common/scene/sky_image.h"
#include "common/scene/texture.h"

namespace {

// Computed in double: in float the last bit differs between libraries.
float sine_of(float x) { return static_cast<float>(std::sin(double{x})); }
float cosine_of(float x) { return static_cast<float>(std::cos(double{x})); }
float angle_of(float y, float x) { return static_cast<float>(std::atan2(double{y}, double{x})); }

int floor_to_int(float x) { return static_cast<int>(std::floor(x)); }

// A texel; i and j may lie beside the picture, which repeats itself there.
Rgb texel(const TexturePicture& picture, int i, int j) {
    auto inside = [](int k, int n) { return static_cast<size_t>((k % n + n) % n); };
    size_t width = static_cast<size_t>(picture.width);
    return picture.texels[inside(j, picture.height) * width + inside(i, picture.width)];
}

// The picture's value at (s, t).
Rgb look_up(const TexturePicture& picture, const Texture& texture, Vec2 st) {
    // Keep x and y near the picture, so that the numbers of texels fit into an int.
    auto near = [](float x) { return x - std::floor(x); };
    float x = near(st.x) * static_cast<float>(picture.width);
    float y = near(1 - st.y) * static_cast<float>(picture.height);
    auto at = [&](int i, int j) { return texel(picture, i, j); };
    if (texture.nearest) return at(floor_to_int(x), floor_to_int(y));

    int i = floor_to_int(x - 0.5f), j = floor_to_int(y - 0.5f);
    float dx = x - 0.5f - static_cast<float>(i), dy = y - 0.5f - static_cast<float>(j);
    return (1 - dy) * ((1 - dx) * at(i, j) + dx * at(i + 1, j)) +
           dy * ((1 - dx) * at(i, j + 1) + dx * at(i + 1, j + 1));
}

// What part of a turn the direction (x, y) is after (1, 0), in [0,1).
float part_of_turn(float x, float y) {
    float u = angle_of(y, x) * (1 / (2 * pi));
    return u < 0 ? std::min(u + 1, 0x1.fffffep-1f) : u;
}

// The coordinates of a point p of a primitive, as pbrt defines them.
Vec2 coordinates(const Scene& scene, const Geometry& g, const PrimHit& found, Vec3 p) {
    return visit(
        g, found.prim,
        [&](const Triangle& t) {
            Vec2 a = g.uvs[t.v[0]], b = g.uvs[t.v[1]], c = g.uvs[t.v[2]];
            float b0 = 1 - found.b1 - found.b2;
            return Vec2{b0 * a.x + found.b1 * b.x + found.b2 * c.x,
                        b0 * a.y + found.b1 * b.y + found.b2 * c.y};
        },
        [&](const Sphere& sphere) {
            const Shape& axes = scene.shapes[sphere.shape];
            Vec3 d = p - sphere.c;
            float x = dot(d, axes.x), y = dot(d, axes.y), z = dot(d, axes.z);
            return Vec2{part_of_turn(x, y), 1 - angle_of(std::sqrt(x * x + y * y), z) / pi};
        },
        [&](const Disk& disk) {
            const Shape& axes = scene.shapes[disk.shape];
            Vec3 d = p - disk.c;
            return Vec2{part_of_turn(dot(d, axes.x), dot(d, axes.y)), 1 - length(d) / disk.r};
        });
}

/// The unit sphere from the unit square, equal areas for equal areas: the middle half (a diamond)
/// is the half above, folded out at the corners is the half below.      source  Clarberg 2008
Vec3 sphere_from_square(Vec2 uv) {
    float a = 2 * uv.x - 1, b = 2 * uv.y - 1;
    float inside = 1 - (std::abs(a) + std::abs(b));  // of the diamond; below 0 outside
    float r = 1 - std::abs(inside);
    float phi = (r == 0 ? 1 : (std::abs(b) - std::abs(a)) / r + 1) * (pi / 4);
    float sine = r * std::sqrt(2 - r * r);
    return {std::copysign(sine * cosine_of(phi), a), std::copysign(sine * sine_of(phi), b),
            std::copysign(1 - r * r, inside)};
}

Vec2 square_from_sphere(Vec3 w) {
    float r = std::sqrt(std::max(0.0f, 1 - std::abs(w.z)));
    float b = r * (2 / pi) * angle_of(std::abs(w.y), std::abs(w.x)), a = r - b;
    if (w.z < 0) {
        float inner = a;
        a = 1 - b, b = 1 - inner;
    }
    return {(std::copysign(a, w.x) + 1) / 2, (std::copysign(b, w.y) + 1) / 2};
}

}  // namespace

Rgb value_at(const Textures& textures, uint32_t texture, Vec2 uv) {
    while (true) {
        const Texture& t = textures.all[texture];
        Vec2 st = {t.scale.x * uv.x + t.shift.x, t.scale.y * uv.y + t.shift.y};
        if (t.kind == Texture::Kind::constant) return t.value;
        if (t.kind == Texture::Kind::picture) {
            Rgb value = t.value * look_up(textures.pictures[t.picture], t, st);
            return from_0_to_1(t.inverted ? Rgb{1, 1, 1} - value : value);
        }
        float squares = std::floor(st.x) + std::floor(st.y);
        bool is_even = squares == 2 * std::floor(squares / 2);
        texture = t.inputs[is_even ? 0 : 1];
    }
}

void look_up_texture(const Scene& scene, const Geometry& g, const PrimHit& found, Hit& x) {
    const Material* material = x.material;
    x.material = {material, value_at(*scene.textures, material->texture - 1u,
                                     coordinates(scene, g, found, x.p))};
}

Vec3 direction_of(const SkyImage& sky, Vec2 uv) {
    Vec3 w;
    if (sky.map == SkyImage::Map::square) {
        w = sphere_from_square(uv);
    } else {
        float theta = pi * uv.y, phi = 2 * pi * uv.x;
        w = {sine_of(theta) * cosine_of(phi), sine_of(theta) * sine_of(phi), cosine_of(theta)};
    }
    return normalize(w.x * sky.x + w.y * sky.y + w.z * sky.z);
}

Vec2 point_of(const SkyImage& sky, Vec3 wi) {
    Vec3 w = {dot(wi, sky.x), dot(wi, sky.y), dot(wi, sky.z)};
    if (sky.map == SkyImage::Map::square) return square_from_sphere(w);
    float phi = angle_of(w.y, w.x), sine = std::sqrt(w.x * w.x + w.y * w.y);
    return {(phi < 0 ? phi + 2 * pi : phi) / (2 * pi), angle_of(sine, w.z) / pi};
}

Rgb sky_towards(const Scene& scene, Vec3 wi) {
    return scene.sky_image ? scene.sky_image->at(point_of(*scene.sky_image, wi)) : scene.sky;
}

float solid_angle_per_area(const SkyImage& sky, Vec2 uv) {
    if (sky.map == SkyImage::Map::square) return 4 * pi;
    return 2 * pi * pi * std::max(sine_of(pi * uv.y), 1e-20f);
}
