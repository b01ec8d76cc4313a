// Chapter 23: the vertices of light paths, and the two maps of their photons.
#pragma once
#include "common/path/photon_map.h"

namespace ch23 {

/// A vertex of a path from a light. Where the surface is diffuse it is a photon.
struct LightVertex {
    Vec3 p, ng;     // m; unit, on the side where the light arrived
    Rgb flux;       // W, of a photon
    float cosines;  // as in Photon
    int depth;      // scattering events on the path, this one included
    const Material* material;
};

/// The photons of one pass, and how they are gathered.
struct PhotonMaps {
    bool final_gathering;               // gather at the second diffuse vertex, not at the first
    std::vector<LightVertex> vertices;  // of all light paths, one path after the other
    PhotonMap global, caustic;          // all photons; only those of paths LS+D
};

/// Sorts the photons among these vertices into the two maps.
inline PhotonMaps build_maps(std::vector<LightVertex> vertices, float radius,
                             bool final_gathering) {
    std::vector<Photon> global, caustic;
    bool only_specular = true;  // so far, on this path
    for (uint32_t i = 0; i < vertices.size(); i++) {
        const LightVertex& v = vertices[i];
        if (v.depth == 1) only_specular = true;
        if (is_diffuse(*v.material)) {
            global.push_back({v.p, v.ng, v.flux, v.depth, i, v.cosines});
            if (only_specular && v.depth > 1) caustic.push_back(global.back());
        }
        only_specular = only_specular && is_specular(*v.material);
    }
    return {final_gathering, std::move(vertices), PhotonMap(global, radius),
            PhotonMap(caustic, radius)};
}

}  // namespace ch23
