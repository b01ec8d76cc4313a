#include "common/render/path_drawing.h"

#include <cstdio>
#include <optional>

#include "common/picture/image.h"
#include "common/scene/camera.h"

namespace {

constexpr float side = 460, margin = 20;  // px
constexpr const char *by_eye = "fill='#c03' stroke='#c03' stroke-width='2'",
                     *by_light = "fill='#e70' stroke='#e70' stroke-width='2'",
                     *lamp = "fill='#fc2' stroke='#e0a800' stroke-width='5'",
                     *open = "stroke='#080' stroke-width='1.5'",
                     *blocked = "stroke='#555' stroke-width='1.5' stroke-dasharray='5 4'",
                     *leaves = "stroke='#c03' stroke-width='1.5' stroke-dasharray='2 4'",
                     *continues = "stroke='#e9a' stroke-width='1'";

/// A drawing in the SVG format, element by element.
struct Svg {
    std::string text = {};

    template <typename... Args>
    void add(const char* pattern, Args... args) {
        char element[400];
        std::snprintf(element, sizeof element, pattern, args...);
        text += element;
    }
    void line(Vec2 a, Vec2 b, const char* style) {
        add("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' %s/>\n", double{a.x}, double{a.y},
            double{b.x}, double{b.y}, style);
    }
    void circle(Vec2 c, const char* style) {
        add("<circle cx='%.1f' cy='%.1f' r='4' %s/>\n", double{c.x}, double{c.y}, style);
    }
    /// Words with a contrasting outline; `at`: left end of their base line.
    void words(Vec2 at, const std::string& words) {
        add("<text x='%.1f' y='%.1f' font-family='sans-serif' font-size='13' stroke='white' "
            "stroke-width='3' paint-order='stroke'>%s</text>\n",
            double{at.x}, double{at.y}, words.c_str());
    }
};

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
    /// The position of a point that is in front of the camera.
    std::optional<Vec2> project(Vec3 p) const {
        return dot(p - o, rz) + w > 0 ? std::optional(divide(p)) : std::nullopt;
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
/// The axis of the world that points up, for a camera that looks about horizontally. In doubt y, as
/// in most scenes.
int upward_axis(const Camera& camera) {
    Vec3 up = camera.up;
    return longest_axis({up.x, 2 * up.y, up.z});
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
    float extent = max_component(size) > 0 ? max_component(size) : scene.radius;
    float scale = side / (1.5f * extent);
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

/// A box around the path.
Box box_around(Vec3 eye, const std::vector<PathVertex>& path) {
    Box box = {eye, eye};
    for (const PathVertex& x : path) box = {min(box.low, x.p), max(box.high, x.p)};
    return box;
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
    svg.add("<image x='%.1f' y='%.1f' width='%.1f' height='%.1f' opacity='0.6' ",
            double{view.corner.x}, double{view.corner.y}, double{view.size.x}, double{view.size.y});
    svg.text += "href='data:image/png;base64," + base64(encode_png(image, "")) + "'/>\n";
    for (const Light& light : scene.lights) {
        if (light.type != LightType::point) continue;
        if (auto at = view.project(light.p)) svg.circle(*at, lamp);
    }
}

void draw_rays(Svg& svg, const View& view, const Scene& scene, const std::vector<TracedRay>& rays) {
    for (const TracedRay& traced : rays) {
        const Ray& ray = traced.ray;
        float t = std::min(traced.t, 2 * scene.radius);
        const char* style = traced.met ? continues : leaves;
        if (traced.shadow) {
            std::optional<Hit> x;
            if (traced.met) x = intersect(scene, ray);
            t = std::min(x ? x->t : ray.t_max, 2 * scene.radius);
            style = traced.met ? blocked : open;
        }
        draw_line(svg, view, ray.o, ray.o + t * ray.d, style);
    }
}

void draw_vertices(Svg& svg, const View& view, Vec3 eye, const std::vector<PathVertex>& path) {
    std::vector<bool> from_light;
    for (const PathVertex& x : path) {
        bool begins = x.from == -2, first = x.from == -1;
        from_light.push_back(begins || (!first && from_light[static_cast<size_t>(x.from)]));
        if (begins || (first && view.is_camera)) continue;  // seen end-on: a point
        Vec3 from = first ? eye : path[static_cast<size_t>(x.from)].p;
        draw_line(svg, view, from, x.p, from_light.back() ? by_light : by_eye);
    }
    auto mark = [&](Vec3 p, const std::string& name, const char* style) {
        std::optional<Vec2> at = view.project(p);
        if (!at) return;
        svg.circle(*at, style);
        svg.words({at->x + 6, at->y - 6}, name);
    };
    if (!view.is_camera) mark(eye, "E", by_eye);
    for (size_t i = 0; i < path.size(); i++)
        mark(path[i].p, std::to_string(i + 1), from_light[i] ? by_light : by_eye);
}

void draw_legend(Svg& svg, float top) {
    const std::pair<const char*, const char*> entries[] = {{by_eye, "path from the eye E"},
                                                           {by_light, "path from a light"},
                                                           {lamp, "lamp"},
                                                           {open, "shadow ray, open"},
                                                           {blocked, "blocked"},
                                                           {leaves, "leaves"}};
    Vec2 at = {margin, top};
    for (auto [style, words] : entries) {
        svg.line({at.x, at.y - 4}, {at.x + 26, at.y - 4}, style);
        svg.words({at.x + 32, at.y}, words);
        at.x += 155;
    }
}

Rgb flat_colour(const Hit& x) {
    switch (x.material->type) {
        case MaterialType::diffuse: return x.material->reflectance;
        case MaterialType::conductor: return {0.45f, 0.45f, 0.5f};
        case MaterialType::dielectric: return {0.5f, 0.7f, 0.75f};
    }
    return {};
}

}  // namespace

Image preview(const Scene& scene, int width, int height, const std::function<Ray(Vec2)>& ray_of,
              float reach) {
    Image image(width, height);
    for (int i = 0; i < width * height; i++) {
        int x = i % width, y = i / width;
        Ray ray = ray_of(Vec2{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
        std::optional<Hit> hit = intersect(scene, ray);
        Rgb& pixel = image.at(x, y);
        pixel = {0.8f, 0.85f, 0.9f};  // the sky
        if (!hit) continue;
        float lit = (0.25f - 0.75f * dot(ray.d, hit->n)) / (1 + hit->t / reach);
        bool shines = !is_black(emission(scene, *hit));
        pixel = shines ? Rgb{1, 0.75f, 0.05f} : lit * flat_colour(*hit);
    }
    return image;
}

std::string draw_path(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& path,
                      const std::vector<TracedRay>& rays) {
    View camera = camera_panel(scene);
    float right = camera.size.x + 2 * margin;
    View above = panel_from_above(scene, box_around(eye, path), right);
    Svg svg;
    svg.add(
        "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f'>\n"
        "<rect width='100%%' height='100%%' fill='white'/>\n",
        double{std::max(right + side, 950.0f) + margin}, double{side + margin + 56});
    for (const View& view : {camera, above}) {
        svg.add(
            "<svg x='%.1f' y='%.1f' width='%.1f' height='%.1f' viewBox='%.1f %.1f %.1f %.1f'>\n",
            double{view.corner.x}, double{view.corner.y}, double{view.size.x}, double{view.size.y},
            double{view.corner.x}, double{view.corner.y}, double{view.size.x}, double{view.size.y});
        draw_scene(svg, view, scene);
        draw_rays(svg, view, scene, rays);
        draw_vertices(svg, view, eye, path);
        svg.text += "</svg>\n";
        svg.words({view.corner.x, view.corner.y + view.size.y + 18},
                  view.is_camera ? "as the camera sees it" : "from above");
    }
    draw_legend(svg, margin + side + 42);
    return svg.text + "</svg>\n";
}
