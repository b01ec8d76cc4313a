#include "common/render/lamp_edges.h"

#include "common/base/parallel.h"
#include "common/scene/camera.h"
#include "common/scene/intersect.h"

void mark_lamp_edges(const Scene& scene, int threads, Film& film) {
    CameraView view = camera_view(scene.camera, film.width, film.height);
    size_t width = static_cast<size_t>(film.width), height = static_cast<size_t>(film.height);
    std::vector<float> seen(width * height);
    parallel_for(film.height, threads, [&](int y) {
        for (size_t x = 0; x < width; x++) {
            Vec2 middle = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
            std::optional<Hit> hit = intersect(scene, camera_ray(view, middle));
            Rgb Le = hit ? emission(scene, *hit) : scene.sky;
            seen[static_cast<size_t>(y) * width + x] = average(Le);
        }
    });
    auto compare = [&](size_t a, size_t b) {
        if (std::abs(seen[a] - seen[b]) <= 0.01f * std::max(seen[a], seen[b])) return;
        film.mark_edge(a);
        film.mark_edge(b);
    };
    for (size_t i = 0; i < seen.size(); i++) {
        if (i % width + 1 < width) compare(i, i + 1);
        if (i + width < seen.size()) compare(i, i + width);
    }
}
