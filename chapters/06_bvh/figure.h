// What the program of chapter 06 shows: a table of its steps, and a heat map.
#pragma once
#include "chapters/06_bvh/estimator.h"
#include "common/picture/drawing.h"
#include "common/render/options.h"

namespace ch06 {

/// The rays through every stride-th pixel.
inline std::vector<Ray> pixel_rays(const Scene& scene, size_t stride) {
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    std::vector<Ray> rays;
    size_t pixels = static_cast<size_t>(scene.width) * static_cast<size_t>(scene.height);
    for (size_t i = 0; i < pixels; i += stride)
        rays.push_back(pixel_ray(scene, view, static_cast<int>(i)));
    return rays;
}

/// Builds what the step needs and traces the rays, for a tenth of a second or longer.
inline std::vector<std::string> measure(const Scene& scene, Step step,
                                        const std::vector<Ray>& rays) {
    double start = cpu_seconds();
    Finder finder = make_finder(scene, step);
    double build_seconds = cpu_seconds() - start;

    Work work;
    double traced = 0, seconds = 0;
    volatile float t = 0;  // or else the compiler leaves out what nobody asks for
    while (seconds < 0.1) {
        for (const Ray& ray : rays) t = find(finder, scene.geometry, ray, work).t;
        traced += static_cast<double>(rays.size());
        seconds = cpu_seconds() - start - build_seconds;
    }
    static_cast<void>(t);
    auto per_ray = [&](uint64_t count) { return digits(static_cast<double>(count) / traced, 4); };
    size_t nodes = finder.hierarchy.nodes.size() + finder.four.nodes.size();
    bool binary = !finder.hierarchy.nodes.empty();
    return {step_names[static_cast<size_t>(step)],
            digits(build_seconds, 3),
            std::to_string(nodes),
            binary ? digits(sah_cost(finder.hierarchy), 4) : "-",
            per_ray(work.nodes),
            per_ray(work.boxes),
            per_ray(work.prims),
            digits(traced / seconds / 1e6, 3)};
}

/// A row for each step; the linear scan, which is slow, traces a few of the rays only.
inline Table steps_table(const Scene& scene) {
    Table table{
        {"step", "build s", "nodes", "SAH", "nodes/ray", "boxes/ray", "prims/ray", "M rays/s"}, {}};
    size_t pixels = static_cast<size_t>(scene.width) * static_cast<size_t>(scene.height);
    std::vector<Ray> rays = pixel_rays(scene, 1 + pixels / (1 << 20));
    std::vector<Ray> few = pixel_rays(scene, 1 + scene.geometry.size() / 100);
    for (size_t i = 0; i < step_names.size(); i++) {
        Step step = static_cast<Step>(i);
        table.rows.push_back(measure(scene, step, step == Step::linear ? few : rays));
    }
    return table;
}

/// The boxes and primitives that the ray through each pixel is tested against; white: 200.
inline Image work_picture(const Scene& scene, Step step) {
    Finder finder = make_finder(scene, step);
    Image numbers(scene.width, scene.height);
    std::vector<Ray> rays = pixel_rays(scene, 1);
    for (size_t i = 0; i < rays.size(); i++) {
        Work work;
        find(finder, scene.geometry, rays[i], work);
        numbers.pixels[i].r = static_cast<float>(work.boxes + work.prims);
    }
    return heat_map(numbers, 200);
}

}  // namespace ch06
