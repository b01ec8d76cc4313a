// For chapters whose paths begin at lights: a picture's parts, measured over seeds, since pixels of
// such a picture do not know their own error.
#pragma once
#include "tests/support/estimators.h"

/// A picture of the classes of path that the filter matches.
inline Film film_of_classes(const Scene& scene, const Method& method, int spp,
                            const std::string& paths, uint32_t seed = 1) {
    return film_of(scene, method, spp, seed, SamplerType::independent, paths).film;
}
/// Its mean, and the standard error of this.
inline Measured picture_of(const Scene& scene, const Method& method, int spp,
                           const std::string& paths = "") {
    Film film = film_of_classes(scene, method, spp, paths);
    return {film.mean(), film.standard_error()};
}

/// The means of blocks of pixels, over renders with different seeds.
struct BlockMeans {
    int size = 0, side = 0;
    std::vector<RunningStats> blocks = {};
    RunningStats whole = {};

    void add(const Image& image) {
        int count = size / side;
        blocks.resize(static_cast<size_t>(count * count));
        double all = 0;
        for (int b = 0; b < count * count; b++) {
            double sum = 0;
            for (int y = 0; y < side; y++)
                for (int x = 0; x < side; x++)
                    sum += static_cast<double>(
                        average(image.at(b % count * side + x, b / count * side + y)));
            blocks[static_cast<size_t>(b)].add(sum / (side * side));
            all += sum;
        }
        whole.add(all / (size * size));
    }
    /// Sums over the blocks: of their variance, and of this over the squared mean.
    double variance() const {
        double sum = 0;
        for (const RunningStats& s : blocks) sum += s.variance();
        return sum;
    }
    double relative_variance() const {
        double sum = 0;
        for (const RunningStats& s : blocks) sum += s.variance() / (s.mean() * s.mean() + 1e-4);
        return sum;
    }
    Measured block(int x0, int y0, int block_side) const {
        const RunningStats& s =
            block_side == size ? whole
                               : blocks[static_cast<size_t>(y0 / side * (size / side) + x0 / side)];
        return {s.mean(), s.standard_error()};
    }
};

/// `runs` pictures of a square scene; of the classes of path that the filter matches.
inline BlockMeans blocks_of(const Scene& scene, const Method& method, int spp, int runs, int side,
                            const std::string& paths = "") {
    BlockMeans means{scene.width, side};
    for (int run = 0; run < runs; run++)
        means.add(film_of_classes(scene, method, spp, paths, static_cast<uint32_t>(run)).image());
    return means;
}
/// Makes all lights shine to both sides, or makes every surface metal, or lets all normals lean.
inline void change(Scene& scene, const std::string& how) {
    if (how == "two-sided") {
        for (Light& light : scene.lights) light.two_sided = true;
    }
    if (how == "metal") {
        for (Material& m : scene.materials) {
            m.type = MaterialType::conductor, m.alpha = 0.3f;
            m.eta = {0.2f, 0.2f, 0.2f}, m.k = {3.9f, 3.9f, 3.9f};
        }
    }
    if (how == "leaning normals") {
        Geometry& g = scene.geometry;
        Sampler random = random_numbers(3);
        g.normals.resize(g.positions.size());
        for (size_t i = 0; i < g.triangles.size(); i++) {
            for (uint32_t v : g.triangles[i].v) {
                g.normals[v] =
                    normalize(g.facet_normals[i] + 0.4f * uniform_direction(random.u2()));
            }
        }
    }
}

/// Paths that a light can show to a pinhole: those whose last vertex is no mirror and no glass.
inline const std::string shown_by_light = "L((D|S)*D)?E";

/// A floor under a point light, by direct light alone: irradiance h / (h^2 + d^2)^(3/2).
inline Scene bulb_over_a_floor() {
    Scene scene = scene_of(
        "LookAt 0 1 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 60\n"
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
        "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [0 0.5 0]\n"
        "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Scale 2 1 2\n" +
        square(0, true));
    scene.max_depth = 1;
    return scene;
}

/// The mean over pixels of the square of the relative error.
inline double mean_squared_error(const Film& film, const Film& exact) {
    double sum = 0, n = static_cast<double>(film.pixels().size());
    for (size_t i = 0; i < film.pixels().size(); i++) {
        double error = film.pixels()[i].mean() / exact.pixels()[i].mean() - 1;
        sum += error * error / n;
    }
    return sum;
}
