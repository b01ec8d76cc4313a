#include "common/explaining/path_drawing.h"

#include <optional>

#include "common/explaining/preview.h"
#include "common/explaining/svg.h"

namespace {

constexpr float side = 460, margin = 20;  // px

/// The projection from the world to a panel: across = (p - o).rx / z, down = (p - o).ry / z,
/// z = (p - o).rz + w.
struct View {
    bool is_camera;
    Vec2 corner, size;  // of the panel
    Vec3 o, rx, ry, rz;
    float w;

    /// The part of a segment in front of the camera.
    std::optional<std::pair<Vec2, Vec2>> project(Vec3 a, Vec3 b) const {
        float za = dot(a - o, rz) + w, zb = dot(b - o, rz) + w, near = 0.01f * std::max(za, zb);
        if (!(near > 0)) return {};
        if (za < near) a = a + (near - za) / (zb - za) * (b - a);
        if (zb < near) b = b + (near - zb) / (za - zb) * (a - b);
        return std::pair(divide(a), divide(b));
    }
    /// The position of a point in the panel; nothing if it is outside.
    std::optional<Vec2> project(Vec3 p) const {
        if (!(dot(p - o, rz) + w > 0)) return {};
        Vec2 at = divide(p);
        bool inside = at.x >= corner.x && at.x <= corner.x + size.x && at.y >= corner.y &&
                      at.y <= corner.y + size.y;
        return inside ? std::optional(at) : std::nullopt;
    }

private:
    Vec2 divide(Vec3 p) const {
        float z = dot(p - o, rz) + w;
        return {corner.x + dot(p - o, rx) / z, corner.y + dot(p - o, ry) / z};
    }
};

/// The view of the picture.      film point = (x, y) with  corner + x dx + y dy  along p - o
View camera_panel(const Scene& scene) {
    float scale = side / static_cast<float>(std::max(scene.width, scene.height));
    Vec2 size = {scale * static_cast<float>(scene.width), scale * static_cast<float>(scene.height)};
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Vec3 n = cross(view.dx, view.dy), rz = n / dot(n, view.corner);
    Vec3 to_x = scale / dot(n, n) * cross(view.dy, n), to_y = scale / dot(n, n) * cross(n, view.dx);
    return {true,
            {margin, margin},
            size,
            view.o,
            to_x - dot(view.corner, to_x) * rz,
            to_y - dot(view.corner, to_y) * rz,
            rz,
            0};
}

int longest_axis(Vec3 v) {
    Vec3 a = abs(v);
    return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}
/// The axis of the world that points up: close to the camera's up direction if the camera looks
/// about horizontally, and perpendicular to its right. In doubt y, as in most scenes.
int upward_axis(const Camera& camera) {
    Vec3 up = abs(camera.up), right = abs(camera.right);
    return longest_axis({up.x * (1 - right.x), 3 * up.y * (1 - right.y), up.z * (1 - right.z)});
}
Vec3 signed_axis(int axis, Vec3 like) {
    Vec3 unit;
    unit[axis] = like[axis] < 0 ? -1.0f : 1.0f;
    return unit;
}

/// The view from above, along an axis of the world; the camera's right is on the right.
View panel_from_above(const Scene& scene, Box box, float left) {
    int up = upward_axis(scene.camera);
    Vec3 level = scene.camera.right;
    level[up] = 0;
    int across = longest_axis(level);
    Vec3 right = signed_axis(across, level),
         away = signed_axis(3 - up - across, scene.camera.forward);
    Vec3 middle = 0.5f * (box.low + box.high), size = box.high - box.low;
    float scale = side / (1.1f * std::max({size[across], size[3 - up - across], 1e-20f}));
    Vec3 o = middle - side / 2 / scale * (right - away);
    return {false, {left, margin}, {side, side}, o, scale * right, -scale * away, {}, 1};
}

/// The ray down from a pixel of that view, from the height of the eye on.
Ray ray_from_above(const View& view, const Camera& camera, Vec2 pixel) {
    Vec3 down = -signed_axis(upward_axis(camera), camera.up);
    Vec3 o = view.o + pixel.x / dot(view.rx, view.rx) * view.rx +
             pixel.y / dot(view.ry, view.ry) * view.ry;
    return {o + dot(camera.o - o, down) * down, down};
}

/// A box around the path and the scene, without parts of the scene far away from the visible part.
Box box_around(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& path) {
    Box box, all = bounds_of(scene.geometry);
    for (const PathVertex& x : path) box = {min(box.low, x.p), max(box.high, x.p)};
    if (path.empty()) return {min(all.low, eye), max(all.high, eye)};
    Vec3 to_eye = abs(eye - 0.5f * (box.low + box.high));
    float reach = std::max(max_component(to_eye), max_component(box.high - box.low));
    Vec3 grow = {reach, reach, reach};
    return {max(min(box.low, all.low), box.low - grow),
            min(max(box.high, all.high), box.high + grow)};
}

std::string base64(const std::string& bytes) {
    constexpr const char* letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; k++)
            text += i + k > bytes.size() ? '=' : letters[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

void draw_line(Svg& svg, const View& view, Vec3 a, Vec3 b, const char* style) {
    if (auto ends = view.project(a, b)) svg.line(ends->first, ends->second, style);
}

void draw_scene(Svg& svg, const View& view, const Scene& scene) {
    int width = std::max(1, static_cast<int>(view.size.x / 2));  // 2 x 2 of the panel each
    int height = std::max(1, static_cast<int>(view.size.y / 2));
    CameraView camera = camera_view(scene.camera, width, height);
    auto ray_of = [&](Vec2 pixel) {
        return view.is_camera ? camera_ray(camera, pixel)
                              : ray_from_above(view, scene.camera, {2 * pixel.x, 2 * pixel.y});
    };
    float reach = view.is_camera ? infinity : scene.radius;  // what is lower is darker
    Image image = preview(scene, width, height, ray_of, reach);
    svg.picture(view.corner, view.size, base64(encode_png(image, "")));
    for (const Light& light : scene.lights) {
        if (light.type != LightType::point) continue;
        if (auto at = view.project(light.p)) svg.circle(*at, 6, "fill='#fc2' stroke='#e0a800'");
    }
}

void draw_rays(Svg& svg, const View& view, const Scene& scene, const std::vector<TracedRay>& rays) {
    for (const TracedRay& traced : rays) {
        const Ray& ray = traced.ray;
        auto to = [&](float t) { return ray.o + std::min(t, 2 * scene.radius) * ray.d; };
        if (!traced.shadow) {
            draw_line(svg, view, ray.o, to(traced.t),
                      traced.met ? "stroke='#e9a' stroke-width='1'"
                                 : "stroke='#c03' stroke-width='1.5' stroke-dasharray='2 4'");
        } else if (!traced.met) {
            draw_line(svg, view, ray.o, to(ray.t_max), "stroke='#080' stroke-width='1.5'");
        } else {
            std::optional<Hit> x = intersect(scene, ray);
            Vec3 end = to(x ? x->t : ray.t_max);
            draw_line(svg, view, ray.o, end,
                      "stroke='#555' stroke-width='1.5' stroke-dasharray='5 4'");
            if (auto at = view.project(end)) {
                svg.line({at->x - 4, at->y - 4}, {at->x + 4, at->y + 4}, "stroke='#555'");
                svg.line({at->x - 4, at->y + 4}, {at->x + 4, at->y - 4}, "stroke='#555'");
            }
        }
    }
}

void draw_vertices(Svg& svg, const View& view, Vec3 eye, const std::vector<PathVertex>& path) {
    constexpr const char *red = "stroke='#c03' stroke-width='2'",
                         *orange = "stroke='#e70' stroke-width='2'";
    std::vector<bool> from_light;
    for (const PathVertex& x : path) {
        bool begins = x.from == -2, first = x.from == -1;
        from_light.push_back(begins || (!first && from_light[static_cast<size_t>(x.from)]));
        if (begins || (first && view.is_camera)) continue;  // seen end-on: a point
        Vec3 from = first ? eye : path[static_cast<size_t>(x.from)].p;
        draw_line(svg, view, from, x.p, from_light.back() ? orange : red);
    }
    auto mark = [&](Vec3 p, const std::string& name, const char* style) {
        std::optional<Vec2> at = view.project(p);
        if (!at) return;
        svg.circle(*at, 3.5f, style);
        svg.text({at->x + 6, at->y - 6}, name);
    };
    if (!view.is_camera) mark(eye, "E", "fill='#000'");
    for (size_t i = 0; i < path.size(); i++) {
        mark(path[i].p, std::to_string(i + 1), from_light[i] ? "fill='#e70'" : "fill='#c03'");
    }
}

void draw_legend(Svg& svg, float top) {
    struct {
        const char *style, *words;
    } entries[] = {{"stroke='#c03' stroke-width='2'", "path from the eye E"},
                   {"stroke='#e70' stroke-width='2'", "path from a light"},
                   {"stroke='#080' stroke-width='1.5'", "shadow ray, open"},
                   {"stroke='#555' stroke-width='1.5' stroke-dasharray='5 4'", "blocked"},
                   {"stroke='#c03' stroke-width='1.5' stroke-dasharray='2 4'", "leaves the scene"},
                   {"stroke='#e0a800' stroke-width='5'", "lamp"}};
    for (size_t i = 0; i < std::size(entries); i++) {
        Vec2 at = {margin + 210 * static_cast<float>(i % 3), top + 22 * static_cast<float>(i / 3)};
        Vec2 begin = {at.x, at.y - 4};
        svg.line(begin, {at.x + 26, begin.y}, entries[i].style);
        svg.text({at.x + 32, at.y}, entries[i].words);
    }
}

}  // namespace

std::string draw_path(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& path,
                      const std::vector<TracedRay>& rays) {
    Svg svg;
    View camera = camera_panel(scene);
    float right = camera.size.x + 2 * margin;
    View above = panel_from_above(scene, box_around(scene, eye, path), right);
    for (const View& view : {camera, above}) {
        svg.begin_clip(view.corner, view.size);
        draw_scene(svg, view, scene);
        draw_rays(svg, view, scene, rays);
        draw_vertices(svg, view, eye, path);
        svg.end_clip();
        svg.rectangle(view.corner, view.size, "fill='none' stroke='#999'");
        svg.text({view.corner.x, view.corner.y + view.size.y + 18},
                 view.is_camera ? "as the camera sees it" : "from above");
    }
    draw_legend(svg, margin + side + 42);
    return svg.finish({right + side + margin, side + margin + 78});
}
