// Scenes for tests: from pbrt text to a film, and the gates that films and paths are held to.
#pragma once
#include <doctest/doctest.h>

#include <map>
#include <thread>

#include "common/base/files.h"
#include "common/base/parallel.h"
#include "common/base/stats.h"
#include "common/program/render.h"
#include "common/recording/class_filter.h"
#include "common/scene/camera.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"

/// A seed's own stream of numbers, for tests that draw one by one.
inline Sampler random_numbers(uint32_t seed) {
    Sampler sampler(SamplerType::independent, seed, 1);
    sampler.start(0, 0);
    return sampler;
}

/// A direction of the whole sphere, all equally likely.
inline Vec3 uniform_direction(Vec2 u) {
    float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// The scene that pbrt text describes, ready to trace.
inline Scene scene_of(const std::string& text) {
    Scene scene = parse_scene("test.pbrt", text, nullptr);
    prepare(scene, 1);
    return scene;
}

/// The scene of world directives, seen by a camera of 40 degrees at (0, 0, -4) that looks along +z.
inline Scene world_of(const std::string& world, int size = 32) {
    std::string pixels = std::to_string(size);
    Scene scene = scene_of(
        "LookAt 0 0 -4  0 0 0  0 1 0\n Camera \"perspective\" \"float fov\" 40\n"
        "Film \"rgb\" \"integer xresolution\" " +
        pixels + " \"integer yresolution\" " + pixels + "\nWorldBegin\n" + world);
    scene.max_depth = 100;
    return scene;
}

/// A rough wall whose normals lean, so that they are not the surface's, before a lamp and a sky.
inline Scene leaning_wall() {
    return world_of(
        "LightSource \"infinite\" \"rgb L\" [0.2 0.3 0.4]\n"
        "AttributeBegin AreaLightSource \"diffuse\" Translate 1 2 -2 Shape \"sphere\" \"float "
        "radius\" 0.3 AttributeEnd\nMaterial \"diffuse\" Shape \"trianglemesh\" \"integer "
        "indices\" [0 1 2 0 2 3] \"point3 P\" [-1 -1 0  -1 1 0  1 1 0  1 -1 0] \"normal N\" [0.4 "
        "0.3 -1  0.1 0.2 -1  -0.3 0 -1  0 -0.4 -1]\n",
        16);
}

/// A scene file at another size and depth.
inline Scene scene_from(const std::string& path, int size, int max_depth) {
    Scene scene = scene_of(read_file(path));
    scene.width = scene.height = size;
    scene.max_depth = max_depth;
    return scene;
}

/// A square of side 2 at height y (before the transforms in front of it), facing +y or -y.
inline std::string square(float y, bool up) {
    std::string h = std::to_string(y);
    return "Shape \"trianglemesh\" \"integer indices\" " +
           std::string(up ? "[0 1 2 0 2 3]" : "[0 2 1 0 3 2]") + " \"point3 P\" [-1 " + h +
           " -1  -1 " + h + " 1  1 " + h + " 1  1 " + h + " -1]\n";
}

template <class AnyTrace>
Rendering film_of(Scene scene, AnyTrace trace, int spp, uint32_t seed = 1,
                  SamplerType sampler = SamplerType::independent) {
    scene.spp = spp;
    RenderOptions options;
    options.seed = seed;
    options.sampler = sampler;
    options.threads = static_cast<int>(std::thread::hardware_concurrency());
    options.quiet = true;
    Rendering r = render_film(scene, options, trace);
    REQUIRE(r.stats.not_finite == 0);
    return r;
}

/// A measured mean and its standard error.
struct Measured {
    double mean = 0, se = 0;
};

/// How many of their joint standard errors two measurements are apart.
inline double z_between(Measured a, Measured b) {
    double se = std::hypot(a.se, b.se), difference = std::abs(a.mean - b.mean);
    if (difference <= 1e-6 * std::abs(a.mean)) return 0;  // rounding; also where neither has noise
    return difference / se;
}

/// The mean over a block of pixels (brightness), with the error that its own samples tell.
inline Measured block_of(const Film& film, int x0, int y0, int side) {
    double mean = 0, squares = 0;
    for (int y = y0; y < y0 + side; y++)
        for (int x = x0; x < x0 + side; x++) {
            const PixelSum& p = film.pixels()[static_cast<size_t>(y * film.width + x)];
            double n = static_cast<double>(p.n);
            mean += p.mean();
            squares += p.m2() / (n - 1) / n;
        }
    double pixels = static_cast<double>(side) * side;
    return {mean / pixels, std::sqrt(squares) / pixels};
}

/// Two pictures compared with each other: the whole, and each block of pixels.
struct Agreement {
    double z_image = 0, worst_z = 0;       // standard errors apart
    double relative_se = 0, relative = 0;  // of the image mean: joint standard error, difference
    int worst_x = 0, worst_y = 0;
    bool agrees() const { return z_image < 5 && worst_z < 5; }  // false for NaN
};

/// a(x0, y0, side) and b(x0, y0, side) give the blocks of pictures of size x size pixels. A block
/// must be so large that light was found in it some hundred times, else its error is unknown.
template <class BlockA, class BlockB>
Agreement hold_against(int size, int side, const BlockA& a, const BlockB& b) {
    Measured all_a = a(0, 0, size), all_b = b(0, 0, size);
    Agreement result;
    result.z_image = z_between(all_a, all_b);
    result.relative_se = std::hypot(all_a.se, all_b.se) / all_b.mean;
    result.relative = std::abs(all_a.mean / all_b.mean - 1);
    for (int y = 0; y < size; y += side)
        for (int x = 0; x < size; x += side) {
            double z = z_between(a(x, y, side), b(x, y, side));
            if (z <= result.worst_z) continue;
            result.worst_z = z, result.worst_x = x, result.worst_y = y;
        }
    return result;
}
inline Agreement hold_against(const Film& a, const Film& b, int block_side = 8) {
    return hold_against(
        a.width, block_side, [&](int x, int y, int side) { return block_of(a, x, y, side); },
        [&](int x, int y, int side) { return block_of(b, x, y, side); });
}

/// The pictures agree, and the test would have seen a relative bias of 8 times `relative_se`.
inline void check_agreement(const Agreement& a, double relative_se) {
    CAPTURE(a.z_image);
    CAPTURE(a.worst_z);
    CAPTURE(a.worst_x);
    CAPTURE(a.worst_y);
    CAPTURE(a.relative);
    CAPTURE(a.relative_se);
    CHECK(a.agrees());
    CHECK(a.relative_se <= relative_se);
}

/// Sums over independent paths, one number for each.
struct PathSum {
    double sum = 0, squares = 0;
    uint64_t not_zero = 0;
    void add(double x) {
        sum += x;
        squares += x * x;
        not_zero += x != 0;
    }
    void merge(const PathSum& b) {
        sum += b.sum;
        squares += b.squares;
        not_zero += b.not_zero;
    }
    Measured measured(double n) const {
        double mean = sum / n;
        return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
    }
};

/// What paths through random points of the film bring: in all, by length and by class.
struct PathCensus {
    double paths = 0;
    PathSum all;
    std::map<std::string, PathSum> by_class;
    std::map<size_t, PathSum> by_length;  // scattering events
    double worst_sum = 0;                 // largest relative difference of parts and whole

    void merge(const PathCensus& b) {
        all.merge(b.all);
        for (const auto& [name, sum] : b.by_class) by_class[name].merge(sum);
        for (const auto& [length, sum] : b.by_length) by_length[length].merge(sum);
        worst_sum = std::max(worst_sum, b.worst_sum);
    }
};

/// Joins part_of(first, last), a Result, of the numbers below `count`: in blocks on all processors,
/// joined in their order, so that the result is the same on any number of them.
template <class Result, class Part>
Result in_blocks(int count, const Part& part_of) {
    constexpr int block = 2048;
    std::vector<Result> parts(static_cast<size_t>((count + block - 1) / block));
    parallel_for(static_cast<int>(parts.size()),
                 static_cast<int>(std::thread::hardware_concurrency()), [&](int b) {
                     parts[static_cast<size_t>(b)] =
                         part_of(b * block, std::min(count, (b + 1) * block));
                 });
    Result all;
    for (const Result& part : parts) all.merge(part);
    return all;
}

/// The paths [first, last) of a census; of those whose class the filter matches.
inline PathCensus part_of_census(const Scene& scene, const SplatTrace& trace, int first, int last,
                                 uint32_t seed, const std::string& filter) {
    PathCensus census;
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Sampler sampler(SamplerType::independent, seed, 1);
    Recorder recorder(true);
    ClassSelection chosen(filter);
    Splats splats;
    for (int i = first; i < last; i++) {
        sampler.start(0, static_cast<uint32_t>(i));
        recorder.start();
        splats.clear();
        Vec2 u = sampler.u2();
        Vec2 film = {u.x * static_cast<float>(scene.width), u.y * static_cast<float>(scene.height)};
        Rgb L = trace(scene, camera_ray(view, film), splats, sampler, recorder);
        for (const Splat& splat : splats) L += splat.L;
        std::map<std::string, double> by_class;
        std::map<size_t, double> by_length;
        double sum = 0, counted = 0, whole = static_cast<double>(average(L));
        for (const Contribution& part : recorder.contributions()) {
            double y = static_cast<double>(average(part.L));
            sum += y;
            if (!chosen.contains(part.path_class)) continue;
            by_class[part.path_class] += y;
            by_length[part.path_class.size() - 2] += y;
            counted += y;
        }
        census.worst_sum = std::max(census.worst_sum, std::abs(sum - whole) / (whole + 1e-20));
        census.all.add(filter.empty() ? whole : counted);
        for (auto [name, y] : by_class) census.by_class[name].add(y);
        for (auto [length, y] : by_length) census.by_length[length].add(y);
    }
    return census;
}

inline PathCensus census_of(const Scene& scene, const SplatTrace& trace, int paths, uint32_t seed,
                            const std::string& filter = "") {
    PathCensus census = in_blocks<PathCensus>(paths, [&](int first, int last) {
        return part_of_census(scene, trace, first, last, seed, filter);
    });
    census.paths = paths;
    return census;
}
inline PathCensus census_of(const Scene& scene, const Trace& trace, int paths, uint32_t seed,
                            const std::string& filter = "") {
    SplatTrace without_splats = [&](const Scene& s, Ray ray, Splats&, Sampler& sampler,
                                    Recorder& recorder) {
        return trace(s, ray, sampler, recorder);
    };
    return census_of(scene, without_splats, paths, seed, filter);
}
