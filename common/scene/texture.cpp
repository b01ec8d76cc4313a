#include "common/scene/texture.h"

#include "common/scene/intersect.h"

namespace {

int floor_to_int(float x) { return static_cast<int>(std::floor(x)); }

// A texel; i and j may lie beside the picture.
Rgb texel(const TexturePicture& picture, Texture::Wrap wrap, int i, int j) {
    auto inside = [&](int k, int n) {
        if (wrap == Texture::Wrap::repeat) return (k % n + n) % n;
        return std::clamp(k, 0, n - 1);
    };
    int x = inside(i, picture.width), y = inside(j, picture.height);
    if (wrap == Texture::Wrap::black && (x != i || y != j)) return {};
    return picture.texels[static_cast<size_t>(y) * static_cast<size_t>(picture.width) +
                          static_cast<size_t>(x)];
}

// The picture's value at (s, t).
Rgb look_up(const TexturePicture& picture, const Texture& texture, Vec2 st) {
    // Keep x and y near the picture, so that the numbers of texels fit into an int.
    auto near = [&](float x) {
        return texture.wrap == Texture::Wrap::repeat ? x - std::floor(x) : std::clamp(x, -1.f, 2.f);
    };
    float x = near(st.x) * static_cast<float>(picture.width);
    float y = near(1 - st.y) * static_cast<float>(picture.height);
    auto at = [&](int i, int j) { return texel(picture, texture.wrap, i, j); };
    if (texture.nearest) return at(floor_to_int(x), floor_to_int(y));

    int i = floor_to_int(x - 0.5f), j = floor_to_int(y - 0.5f);
    float dx = x - 0.5f - static_cast<float>(i), dy = y - 0.5f - static_cast<float>(j);
    return (1 - dy) * ((1 - dx) * at(i, j) + dx * at(i + 1, j)) +
           dy * ((1 - dx) * at(i, j + 1) + dx * at(i + 1, j + 1));
}

Rgb from_0_to_1(Rgb a) {
    return {std::clamp(a.r, 0.f, 1.f), std::clamp(a.g, 0.f, 1.f), std::clamp(a.b, 0.f, 1.f)};
}

// In radians. Computed in double: in float the last bit differs between libraries.
float angle(float y, float x) { return static_cast<float>(std::atan2(double{y}, double{x})); }

// What part of a turn the direction (x, y) is after (1, 0), in [0,1).
float part_of_turn(float x, float y) {
    float u = angle(y, x) * (1 / (2 * pi));
    return u < 0 ? std::min(u + 1, 0x1.fffffep-1f) : u;
}

// The coordinates of a point p of a primitive, as pbrt defines them.
Vec2 coordinates(const Scene& scene, const Geometry& g, const PrimHit& found, Vec3 p) {
    auto axes_of = [&](uint32_t shape) {
        int axes = scene.shapes[shape].axes;
        return axes < 0 ? Axes{} : scene.axes[static_cast<size_t>(axes)];
    };
    return visit(
        g, found.prim,
        [&](const Triangle& t) {
            Vec2 a = g.uvs[t.v[0]], b = g.uvs[t.v[1]], c = g.uvs[t.v[2]];
            float b0 = 1 - found.b1 - found.b2;
            return Vec2{b0 * a.x + found.b1 * b.x + found.b2 * c.x,
                        b0 * a.y + found.b1 * b.y + found.b2 * c.y};
        },
        [&](const Sphere& sphere) {
            Axes axes = axes_of(sphere.shape);
            Vec3 d = p - sphere.c;
            float x = dot(d, axes.x), y = dot(d, axes.y), z = dot(d, axes.z);
            return Vec2{part_of_turn(x, y), 1 - angle(std::sqrt(x * x + y * y), z) / pi};
        },
        [&](const Disk& disk) {
            Axes axes = axes_of(disk.shape);
            Vec3 d = p - disk.c;
            return Vec2{part_of_turn(dot(d, axes.x), dot(d, axes.y)), 1 - length(d) / disk.r};
        });
}

}  // namespace

Rgb value_at(const Textures& textures, uint32_t texture, Vec2 uv) {
    const Texture& t = textures.all[texture];
    Vec2 st = {t.scale.x * uv.x + t.shift.x, t.scale.y * uv.y + t.shift.y};
    switch (t.kind) {
        case Texture::Kind::constant: return t.value;
        case Texture::Kind::picture: {
            Rgb value = t.value * look_up(textures.pictures[t.picture], t, st);
            return from_0_to_1(t.inverted ? Rgb{1, 1, 1} - value : value);
        }
        case Texture::Kind::checkerboard: {
            float squares = std::floor(st.x) + std::floor(st.y);
            bool is_even = squares == 2 * std::floor(squares / 2);
            return value_at(textures, t.inputs[is_even ? 0 : 1], uv);
        }
        case Texture::Kind::product:
            return from_0_to_1(t.value * value_at(textures, t.inputs[0], uv));
    }
    return {};
}

void look_up_texture(const Scene& scene, const Geometry& g, const PrimHit& found, Hit& x) {
    const Material* material = x.material;
    x.material = {material, value_at(*scene.textures, material->texture - 1u,
                                     coordinates(scene, g, found, x.p))};
}
