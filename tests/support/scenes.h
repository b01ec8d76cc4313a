// Scenes for tests: from pbrt text to a film, and the gates that films and paths are held to.
#pragma once
#include <doctest/doctest.h>

#include <map>
#include <thread>

#include "common/base/files.h"
#include "common/base/parallel.h"
#include "common/base/stats.h"
#include "common/render/render.h"
#include "common/scene/camera.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"

/// A seed's own stream of numbers, for tests that draw one by one.
Sampler random_numbers(uint32_t seed);

/// A direction of the whole sphere, all equally likely.
Vec3 uniform_direction(Vec2 u);

/// The scene that pbrt text describes, ready to trace.
Scene scene_of(const std::string& text);

/// The scene of world directives, seen by a camera of 40 degrees at (0, 0, -4) that looks along +z.
Scene world_of(const std::string& world, int size = 32);

/// A rough wall whose normals lean, so that they are not the surface's, before a lamp and a sky.
Scene leaning_wall();

/// A scene file at another size and depth.
Scene scene_from(const std::string& path, int size, int max_depth);

/// A square of side 2 at height y (before the transforms in front of it), facing +y or -y.
std::string square(float y, bool up);

/// A render; of the classes of path that the filter matches.
Rendering film_of(const Scene& scene, const Method& method, int spp, uint32_t seed = 1,
                  SamplerType sampler = SamplerType::independent, const std::string& paths = "");

/// A measured mean and its standard error.
struct Measured {
    double mean = 0, se = 0;
};

/// How many of their joint standard errors two measurements are apart.
double z_between(Measured a, Measured b);

/// The mean over a block of pixels (brightness), with the error that its own samples tell.
Measured block_of(const Film& film, int x0, int y0, int side);

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
Agreement hold_against(const Film& a, const Film& b, int block_side = 8);

/// The pictures agree, and the test would have seen a relative bias of 8 times `relative_se`.
void check_agreement(const Agreement& a, double relative_se);

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

/// What samples bring, each one a path or a pass: "all" of it; each class of path, "LDE"; each
/// length, "length 2"; and the classes that a filter matches, "all FILTER".
struct Census {
    int samples = 0;
    std::map<std::string, PathSum> parts = {};

    void merge(const Census& b) {
        samples += b.samples;
        for (const auto& [name, sum] : b.parts) parts[name].merge(sum);
    }
    Measured measured(const std::string& part) const {
        return parts.contains(part) ? parts.at(part).measured(samples) : Measured{};
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

/// Paths number `first` and so on through random points of the film, in classes or only in all.
Census census_of(const Scene& scene, const Method& method, int paths, uint32_t seed,
                 const std::vector<std::string>& filters = {}, bool classes = true, int first = 0);
