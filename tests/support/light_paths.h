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
inline Agreement hold_against(const BlockMeans& a, const BlockMeans& b) {
    return hold_against(
        a.size, a.side, [&](int x, int y, int side) { return a.block(x, y, side); },
        [&](int x, int y, int side) { return b.block(x, y, side); });
}

/// A scene whose metres are `unit` of those in the file: the same picture.
inline Scene in_units(const std::string& path, float unit, int size, int max_depth) {
    Scene scene = parse_scene(path, read_file(path), nullptr);
    for (Vec3& p : scene.geometry.positions) p = unit * p;
    for (Sphere& s : scene.geometry.spheres) s.c = unit * s.c, s.r *= unit;
    scene.camera.o = unit * scene.camera.o;
    prepare(scene, 1);
    scene.width = scene.height = size, scene.max_depth = max_depth;
    return scene;
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
