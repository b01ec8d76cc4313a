// Chapter 25: the light paths of a pass, and the photons where they may merge.
#pragma once
#include "common/path/photon_map.h"
#include "common/path/stored_subpaths.h"

namespace ch25 {

/// A vertex of a path from a light, and what merging there needs.
struct LightVertex {
    const Material* material;
    Vec3 wi;            // unit, to the vertex before
    double others = 0;  // sr; times pdf_w: sum of p_i / p_merge on the light's side
};

/// The vertices of light paths, one path after the other, and photons at those that may merge.
struct LightPaths {
    std::vector<LightVertex> vertices;
    std::vector<Photon> photons;

    /// Adds photon to the last vertex.
    void add_photon(Vec3 p, Vec3 ng, Rgb flux, size_t depth, float cosines) {
        uint32_t place = static_cast<uint32_t>(vertices.size() - 1);
        photons.push_back({p, ng, flux, static_cast<int>(depth), place, cosines});
    }
    /// Adds the light paths of another part of the pass.
    void add(const LightPaths& other) {
        for (Photon photon : other.photons) {
            photon.vertex += static_cast<uint32_t>(vertices.size());
            photons.push_back(photon);
        }
        vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    }
};

/// Whether paths may merge at v, which light reaches from vertex `before`: at a diffuse point
/// behind a mirror or glass.
inline bool can_merge(const Vertex& v, const Vertex& before) {
    const Material *m = v.x.material, *of_before = before.x.material;
    return m && of_before && is_diffuse(*m) && is_specular(*of_before) && before.x.light < 0;
}

/// Adds the vertices of one of N light paths to those of the pass, and photons where it may merge.
inline void add_light_path(const Scene& scene, const Subpath& walk, float area, int N,
                           LightPaths& paths) {
    for (size_t j = 1; j < walk.path.size() && walk.path[j].x.material; j++) {
        const Vertex& v = walk.path[j];
        const MisTerms &terms = walk.terms[j], &before = walk.terms[j - 1];
        paths.vertices.push_back({v.x.material, terms.back});
        float cos_g = dot(terms.back, v.x.ng);
        if (!can_merge(v, walk.path[j - 1]) || !(cos_g > 0)) continue;
        double per_w = static_cast<double>(terms.to_area / before.pdf) * terms.sum;
        paths.vertices.back().others = per_w / static_cast<double>(area * terms.pdf);
        float cos_n = std::max(0.0f, dot(terms.back, smooth_normal(scene, v.x)));
        paths.add_photon(v.x.p, v.x.ng, v.beta / static_cast<float>(N), j, cos_n / cos_g);
    }
}

/// Multiplies the flux of photons by the weight of merging, without strategies on the eye's side.
///
///   mis_merge ~ 1 / (1 + sum of p_i / p_merge on the light's side)
inline void weigh(LightPaths& paths) {
    for (Photon& photon : paths.photons) {
        const LightVertex& y = paths.vertices[photon.vertex];
        float back_w = pdf_cosine_hemisphere(std::max(0.0f, dot(y.wi, photon.ng)));
        photon.flux /= 1 + back_w * static_cast<float>(y.others);
    }
}

/// What is prepared for a scene, and for each pass.
struct Merging {
    Endpoints endpoints;
    many_lights::Lights lights;
    float area = 0;  // m^2, N pi r^2: of the disks of N light paths; 0: nothing merges
    LightPaths paths = {};
    PhotonMap map = {};
};

}  // namespace ch25
