#include "common/program/path_drawing.h"

#include <cstdio>

namespace {

constexpr double panel = 460, margin = 20;  // px

/// One of two parallel projections of the scene: along an axis of the world.
struct Projection {
    const char* title;
    int across, up;  // axes of the world
    double left;     // px
    double scale, x0, y0;

    double x(Vec3 p) const { return left + margin + (static_cast<double>(p[across]) - x0) * scale; }
    double y(Vec3 p) const { return margin + panel - (static_cast<double>(p[up]) - y0) * scale; }
};

struct Bounds {
    Vec3 low = {infinity, infinity, infinity}, high = {-infinity, -infinity, -infinity};
    void add(Vec3 p) { low = min(low, p), high = max(high, p); }
};

Bounds bounds_of(const Scene& scene, const std::vector<PathVertex>& path) {
    Bounds b;
    for (Vec3 p : scene.geometry.positions) b.add(p);
    for (const Sphere& s : scene.geometry.spheres) {
        b.add(s.c - Vec3{s.r, s.r, s.r}), b.add(s.c + Vec3{s.r, s.r, s.r});
    }
    for (const PathVertex& x : path) b.add(x.p);
    return b;
}

Projection fit(const char* title, int across, int up, double left, const Bounds& b) {
    double width = static_cast<double>(b.high[across]) - static_cast<double>(b.low[across]);
    double height = static_cast<double>(b.high[up]) - static_cast<double>(b.low[up]);
    return {title,
            across,
            up,
            left,
            panel / std::max({width, height, 1e-30}),
            static_cast<double>(b.low[across]),
            static_cast<double>(b.low[up])};
}

class Svg {
public:
    void line(const Projection& view, Vec3 a, Vec3 b, const char* style) {
        add("<line x1='%.2f' y1='%.2f' x2='%.2f' y2='%.2f' %s/>\n", view.x(a), view.y(a), view.x(b),
            view.y(b), style);
    }
    void circle(const Projection& view, Vec3 c, double r, const char* style) {
        add("<circle cx='%.2f' cy='%.2f' r='%.2f' %s/>\n", view.x(c), view.y(c), r, style);
    }
    void text(double x, double y, const std::string& words) {
        add("<text x='%.2f' y='%.2f' font-family='sans-serif' font-size='13'>%s</text>\n", x, y,
            words.c_str());
    }
    std::string finish(double width, double height) const {
        char head[200];
        std::snprintf(head, sizeof head,
                      "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f'>\n"
                      "<rect width='100%%' height='100%%' fill='white'/>\n",
                      width, height);
        return head + body_ + "</svg>\n";
    }

private:
    template <typename... Args>
    void add(const char* pattern, Args... args) {
        char text[400];
        std::snprintf(text, sizeof text, pattern, args...);
        body_ += text;
    }
    std::string body_;
};

void draw_scene(Svg& svg, const Projection& view, const Geometry& g) {
    const char* grey = "stroke='#bbb' stroke-width='1' fill='none'";
    constexpr size_t most = 4000;  // of a large mesh every k-th triangle says enough
    size_t step = g.triangles.size() / most + 1;
    for (size_t i = 0; i < g.triangles.size(); i += step) {
        const auto& v = g.triangles[i].v;
        for (size_t k = 0; k < 3; k++) {
            svg.line(view, g.positions[v[k]], g.positions[v[(k + 1) % 3]], grey);
        }
    }
    for (const Sphere& s : g.spheres) {
        svg.circle(view, s.c, static_cast<double>(s.r) * view.scale, grey);
    }
    for (const Disk& d : g.disks) {
        svg.circle(view, d.c, static_cast<double>(d.r) * view.scale, grey);
    }
}

}  // namespace

std::string draw_path(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& path) {
    Bounds b = bounds_of(scene, path);
    b.add(eye);
    Svg svg;
    for (const Projection& view : {fit("front: x to the right, y up", 0, 1, 0, b),
                                   fit("top: x to the right, z up", 0, 2, panel + 2 * margin, b)}) {
        draw_scene(svg, view, scene.geometry);
        for (const PathVertex& x : path) {
            if (x.from == -2) continue;  // begins here
            Vec3 from = x.from < 0 ? eye : path[static_cast<size_t>(x.from)].p;
            svg.line(view, from, x.p, "stroke='#c03' stroke-width='2'");
        }
        for (size_t i = 0; i <= path.size(); i++) {
            Vec3 p = i == 0 ? eye : path[i - 1].p;
            svg.circle(view, p, 3, "fill='#c03'");
            svg.text(view.x(p) + 5, view.y(p) - 5, i == 0 ? "E" : std::to_string(i));
        }
        svg.text(view.left + margin, panel + 2 * margin + 12, view.title);
    }
    return svg.finish(2 * panel + 4 * margin, panel + 3 * margin + 10);
}
