#include "common/explaining/scene_outline.h"

#include <algorithm>
#include <tuple>

#include "common/scene/camera.h"
#include "common/scene/intersect.h"

namespace {

bool is_before(Vec3 a, Vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

/// An edge of a triangle, and the triangle's normal.
struct Edge {
    Vec3 a, b, n;
};

/// The edges of triangles that show the shape, each once.
std::vector<Segment> telling_edges(std::vector<Edge> edges, Vec3 axis) {
    for (Edge& e : edges) {
        if (is_before(e.b, e.a)) std::swap(e.a, e.b);
    }
    auto order = [](const Edge& e, const Edge& f) {
        return is_before(e.a, f.a) || (e.a == f.a && is_before(e.b, f.b));
    };
    std::sort(edges.begin(), edges.end(), order);
    std::vector<Segment> lines;
    for (size_t i = 0, next = 0; i < edges.size(); i = next) {
        while (next < edges.size() && edges[next].a == edges[i].a && edges[next].b == edges[i].b) {
            next++;
        }
        if (next - i == 2) {
            Vec3 m = edges[i].n, n = edges[i + 1].n;
            bool turns_away = dot(m, axis) * dot(n, axis) < 0 && dot(m, n) > 0;
            if (std::abs(dot(m, n)) > 0.9f && !turns_away) continue;
        }
        lines.push_back({edges[i].a, edges[i].b});
    }
    return lines;
}

void add_circle(Vec3 c, Vec3 n, float r, std::vector<Segment>& lines) {
    constexpr int corners = 48;
    Frame frame(n);
    auto corner = [&](int i) {
        return c + frame.to_world(from_cylindrical(r, static_cast<float>(i) / corners, 0));
    };
    for (int i = 0; i < corners; i++) lines.push_back({corner(i), corner(i + 1)});
}

void add_outline(const Scene& scene, const Geometry& g, Vec3 axis, bool lamps,
                 std::vector<Segment>& lines) {
    auto wanted = [&](uint32_t shape) { return (scene.shapes[shape].light >= 0) == lamps; };
    std::vector<Edge> edges;
    for (size_t i = 0; i < g.triangles.size(); i++) {
        const Triangle& t = g.triangles[i];
        if (!wanted(t.shape)) continue;
        for (size_t k = 0; k < 3; k++) {
            edges.push_back(
                {g.positions[t.v[k]], g.positions[t.v[(k + 1) % 3]], g.facet_normals[i]});
        }
    }
    for (const Segment& line : telling_edges(std::move(edges), axis)) lines.push_back(line);
    for (const Sphere& s : g.spheres) {
        if (wanted(s.shape)) add_circle(s.c, axis, s.r, lines);
    }
    for (const Disk& d : g.disks) {
        if (wanted(d.shape)) add_circle(d.c, d.n, d.r, lines);
    }
}

std::vector<Segment> outline_of(const Scene& scene, Vec3 axis, bool lamps) {
    std::vector<Segment> lines;
    add_outline(scene, scene.geometry, axis, lamps, lines);
    for (const Mover& mover : scene.movers) {
        add_outline(scene, mover.geometry, axis, lamps, lines);
    }

    // Of a large mesh, every k-th line is enough.
    constexpr size_t most = 4000;
    size_t step = lines.size() / most + 1, kept = 0;
    for (size_t i = 0; i < lines.size(); i += step) lines[kept++] = lines[i];
    lines.resize(kept);
    return lines;
}

Rgb flat_color(const Hit& x) {
    switch (x.material->type) {
        case MaterialType::diffuse: return x.material->reflectance;
        case MaterialType::conductor: return {0.45f, 0.45f, 0.5f};
        case MaterialType::dielectric: return {0.5f, 0.7f, 0.75f};
    }
    return {};
}

}  // namespace

std::vector<Segment> outline(const Scene& scene, Vec3 axis) {
    return outline_of(scene, axis, false);
}
std::vector<Segment> lamp_outline(const Scene& scene, Vec3 axis) {
    return outline_of(scene, axis, true);
}

Image preview(const Scene& scene, int width, int height) {
    constexpr Rgb sky = {0.8f, 0.85f, 0.9f}, lamp = {1, 0.75f, 0.05f};
    Image image(width, height);
    CameraView view = camera_view(scene.camera, width, height);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            Ray ray =
                camera_ray(view, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
            std::optional<Hit> hit = intersect(scene, ray);
            Rgb& pixel = image.at(x, y);
            if (!hit) {
                pixel = sky;
            } else if (!is_black(emission(scene, *hit))) {
                pixel = lamp;
            } else {
                pixel = (0.25f - 0.75f * dot(ray.d, hit->n)) * flat_color(*hit);
            }
        }
    }
    return image;
}
