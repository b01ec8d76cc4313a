// The material of a surface, as the scene file describes it; how much light a metal reflects; and a
// point of a surface, ready for shading.
#pragma once
#include <cstdint>

#include "common/base/vec.h"

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

/// The share of unpolarised light that a metal of complex index eta + i k reflects; one channel.
///
///   d = eta^2 - k^2 - sin^2,  a2_b2 = a^2 + b^2 = sqrt(d^2 + 4 eta^2 k^2),  a^2 = (a2_b2 + d) / 2
///   R_s = (a2_b2 - 2 a cos + cos^2) / (a2_b2 + 2 a cos + cos^2)
///   R_p = R_s (cos^2 a2_b2 - 2 a cos sin^2 + sin^4) / (cos^2 a2_b2 + 2 a cos sin^2 + sin^4)
///   R = (R_s + R_p) / 2
///
/// Numerators are sums of squares such as (a - cos)^2 + b^2, but rounding may make them negative.
/// For eta = k = 0 at normal incidence a2_b2 is 0, and R_p would be 0 / 0: R is then 1.
/// source  Born, Wolf, "Principles of Optics", ch. 14
/// tested by  "identity: a metal's reflectance is Fresnel's with a complex index"
inline float fresnel_conductor(float cos_i, float eta, float k) {
    float cos2 = cos_i * cos_i, sin2 = std::max(0.0f, 1 - cos2);
    float d = eta * eta - k * k - sin2;
    float a2_b2 = std::max(std::sqrt(d * d + 4 * eta * eta * k * k), 1e-20f);
    float a = std::sqrt(std::max(0.0f, (a2_b2 + d) / 2));
    float s = 2 * a * cos_i, p = s * sin2;
    float R_s = std::max(0.0f, a2_b2 - s + cos2) / (a2_b2 + s + cos2);
    float R_p =
        R_s * std::max(0.0f, cos2 * a2_b2 - p + sin2 * sin2) / (cos2 * a2_b2 + p + sin2 * sin2);
    return (R_s + R_p) / 2;
}

/// The k of the metal with eta = 1 that reflects so much of light that arrives along the normal.
///
///   k = 2 sqrt(r) / sqrt(1 - r),  r at most 0.9999      source  pbrt-v4
inline Rgb k_of_reflectance(Rgb reflectance) {
    auto k = [](float r) {
        r = std::min(r, 0.9999f);
        return 2 * std::sqrt(r) / std::sqrt(1 - r);
    };
    return {k(reflectance.r), k(reflectance.g), k(reflectance.b)};
}

inline Rgb fresnel_conductor(float cos_i, Rgb eta, Rgb k) {
    return {fresnel_conductor(cos_i, eta.r, k.r), fresnel_conductor(cos_i, eta.g, k.g),
            fresnel_conductor(cos_i, eta.b, k.b)};
}

/// The material at a point: that of the surface and, where a texture varies it, its reflectance
/// there. Square roots in 16 bits keep that to 2e-5, and a hit as small as without textures.
class MaterialAt {
public:
    MaterialAt() = default;
    MaterialAt(const Material* material) : material_(material) {}
    MaterialAt(const Material* material, Rgb reflectance)
        : material_(material),
          roots_{pack(reflectance.r), pack(reflectance.g), pack(reflectance.b)} {}

    MaterialAt& operator=(const Material* material) {  // the texture stays
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
    uint16_t roots_[3] = {};
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
