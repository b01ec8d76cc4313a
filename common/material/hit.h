// A point of a surface, ready for shading.
#pragma once
#include "common/material/material.h"
#include "common/material/metal.h"

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
