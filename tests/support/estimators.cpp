#include "tests/support/estimators.h"

#include "common/scene/intersect.h"

Scene floor_under(const std::string& light) {
    Scene scene = world_of(
        "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [1 1 1] Scale 500 1 500 " +
        square(0, true) + "AttributeEnd\n" + light);
    scene.max_depth = 1;
    return scene;
}

Hit origin_of(const Scene& scene) { return *intersect(scene, onto_origin); }

std::string unit_square(double h, double x, double z) {
    return "Translate " + std::to_string(x) + " " + std::to_string(h) + " " + std::to_string(z) +
           " Scale 0.5 1 0.5 " + square(0, false);
}

std::string disk(double R, double h, double x) {
    return "Translate " + std::to_string(x) + " " + std::to_string(h) +
           " 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" " + std::to_string(R) + "\n";
}

Scene closed_sphere(double a, int max_depth) {
    std::string albedo = std::to_string(a) + " ";
    Scene scene = world_of(
        "ReverseOrientation AreaLightSource \"diffuse\"\n"
        "Material \"diffuse\" \"rgb reflectance\" [" +
        albedo + albedo + albedo + "] Shape \"sphere\"");
    scene.camera.o = {0, 0, 0};
    scene.max_depth = max_depth;
    return scene;
}

RunningStats repeat(const Scene& scene, const Ray& ray, const Method& trace, int paths,
                    uint32_t seed, double scale) {
    return in_blocks<RunningStats>(paths, [&](int first, int last) {
        RunningStats stats;
        Sampler sampler(SamplerType::independent, seed, 1);
        Recorder recorder;
        for (int i = first; i < last; i++) {
            sampler.start(0, static_cast<uint32_t>(i));
            stats.add(scale * static_cast<double>(trace(scene, ray, sampler, recorder).g));
        }
        return stats;
    });
}

RunningStats irradiance(const Scene& scene, const Method& trace, int paths, uint32_t seed) {
    return repeat(scene, onto_origin, trace, paths, seed, pi_exact);
}

void check_bounded(const RunningStats& s, double truth, double relative_se) {
    INFO(s.mean() << " +- " << s.standard_error() << ", truth " << truth);
    CHECK(std::isfinite(s.mean()));
    CHECK(std::abs(s.mean() - truth) <= 5 * s.standard_error() + 2e-6 * truth);
    CHECK(s.standard_error() <= relative_se * truth);
}

double rel_mse(const Film& film) {
    double sum = 0, n = film.spp();
    for (int y = 0; y < film.height; y += 8)
        for (int x = 0; x < film.width; x += 8) {
            Measured block = block_of(film, x, y, 8);
            sum += 64 * n * block.se * block.se / (block.mean * block.mean + 0.01);
        }
    return sum / (film.width * film.height / 64);
}
