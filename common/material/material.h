// The material of a surface, as the scene file describes it.
#pragma once
#include <cstdint>

#include "common/base/vec.h"

struct Glass;     // glass.h
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

/// Whether it is rough metal.
inline bool is_rough(const Material& m) { return m.type == MaterialType::conductor && m.alpha > 0; }
