// The material of a surface, as the scene file describes it; and a point of one, ready for shading.
#pragma once
#include <cstdint>

#include "common/material/metal.h"

struct Glass;     // spectrum.h
struct Position;  // base/error.h

enum class MaterialType : uint8_t { diffuse, conductor, dielectric };

struct Material {
    MaterialType type = MaterialType::diffuse;
    uint16_t texture = 0;  // of the reflectance: 1 + its number in Textures::all; 0: none
    Rgb reflectance = {0.5f, 0.5f, 0.5f};  // diffuse: albedo, in [0,1]; the largest of a texture
    Rgb eta, k;                            // conductor: complex index of refraction eta + i k
    float alpha = 0;                       // conductor: GGX roughness; 0: a perfect mirror
    float ior = 1.5f;                      // dielectric: index inside over index outside
    const Glass* glass = nullptr;  // dielectric with dispersion; ior is then the one at 587.6 nm
    const Position* at = nullptr;  // where a scene file defines it, for messages
};

/// Whether light that arrives from one direction leaves in one direction (or two) only.
inline bool is_specular(const Material& m) {
    return m.type == MaterialType::dielectric ||
           (m.type == MaterialType::conductor && m.alpha == 0);
}

inline bool is_diffuse(const Material& m) { return m.type == MaterialType::diffuse; }

/// Whether it is rough metal.
inline bool is_rough(const Material& m) { return m.type == MaterialType::conductor && m.alpha > 0; }

/// The material at a point: that of the surface and, where a texture varies it, its reflectance
/// there. Square roots in 16 bits keep that to 2e-5, and a hit as small as without textures.
class MaterialAt {
public:
    MaterialAt() = default;
    MaterialAt(const Material* material) : material_(material) {}
    MaterialAt(const Material* material, Rgb reflectance)
        : material_(material),
          roots_{pack(reflectance.r), pack(reflectance.g), pack(reflectance.b)} {}
    MaterialAt& operator=(const Material* material) {
        material_ = material;
        return *this;
    }

    /// All of the material, as it is at the point.
    struct Here : Material {
        const Here* operator->() const { return this; }
    };
    Here operator->() const {
        Here here = {*material_};
        if (here.texture != 0) [[unlikely]]
            vary(here);
        return here;
    }
    operator const Material*() const { return material_; }

private:
    static uint16_t pack(float x) { return static_cast<uint16_t>(65535 * std::sqrt(x) + 0.5f); }
    static float unpack(uint16_t root) {
        float x = static_cast<float>(root) / 65535;
        return x * x;
    }
    void vary(Material& here) const {
        here.reflectance = {unpack(roots_[0]), unpack(roots_[1]), unpack(roots_[2])};
        if (here.type == MaterialType::conductor) here.k = k_of_reflectance(here.reflectance);
    }

    const Material* material_;
    uint16_t roots_[3];
};

/// A point of a surface, hit by a ray: n and ng are on the side that the ray came from.
struct Hit {
    Vec3 p;      // m
    Vec3 n;      // shading normal, unit
    Vec3 ng;     // geometric normal, unit
    float eps;   // m: largest distance of p from the surface, by rounding
    float t;     // distance along the ray, in lengths of its d
    float time;  // the ray's
    [[no_unique_address]] MaterialAt material;  // front takes the room that this leaves
    bool front;     // on the normal's side: where a light emits, outside of glass
    int light;      // index into Scene::lights; -1: emits no light
    uint32_t prim;  // index into Scene::geometry, and behind that into those of the movers
};
