#include <algorithm>
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/progress.h"
#include "common/recording/class_filter.h"
#include "common/recording/recorder.h"
#include "common/render/render.h"
#include "common/scene/intersect.h"
#include "common/scene/prepare.h"

namespace {

constexpr float panel_side = 460, margin = 20;  // px
constexpr const char *path_style = "fill='#c03' stroke='#c03' stroke-width='2'",
                     *open = "stroke='#080' stroke-width='1.5'",
                     *blocked = "stroke='#555' stroke-width='1.5' stroke-dasharray='5 4'";

/// Words with a contrasting outline, in the SVG format; `at`: left end of their base line.
std::string words(Vec2 at, const std::string& words) {
    return format("<text x='%.1f' y='%.1f' font-family='sans-serif' font-size='13' ", double{at.x},
                  double{at.y}) +
           "stroke='white' stroke-width='3' paint-order='stroke'>" + words + "</text>\n";
}

/// A panel of the drawing: a camera, of which a pixel is one of the panel.
struct Panel {
    bool is_camera;
    int width, height;
    CameraView view;

    float volume() const { return dot(view.corner, cross(view.dx, view.dy)); }
    /// z of  p - o = z (corner + x dx + y dy);  a point in front of the camera has z > 0.
    float depth(Vec3 p) const { return dot(p - view.o, cross(view.dx, view.dy)) / volume(); }
    /// The position of such a point.
    Vec2 project(Vec3 p) const {
        Vec3 a = 1 / (depth(p) * volume()) * (p - view.o);
        return {dot(a, cross(view.dy, view.corner)), dot(a, cross(view.corner, view.dx))};
    }
};

/// The view of a box from high above; the camera's right is on the right. Up is an axis of the
/// world, for a camera that looks about horizontally; in doubt y, as in most scenes.
Panel panel_from_above(const Scene& scene, Box box) {
    Vec3 a = abs(scene.camera.up), up, forward = scene.camera.forward;
    int axis = 2 * a.y >= a.x && 2 * a.y >= a.z ? 1 : a.x >= a.z ? 0 : 2;
    up[axis] = scene.camera.up[axis] < 0 ? -1.0f : 1.0f;
    Vec3 away = normalize(forward - dot(forward, up) * up), right = cross(up, away);
    if (dot(right, scene.camera.right) < 0) right = -right;
    float size = 1.2f * length(box.high - box.low);
    if (size == 0) size = scene.radius;
    Vec3 dx = size / panel_side * right, dy = -size / panel_side * away, down = -1000 * size * up;
    return {false,
            static_cast<int>(panel_side),
            static_cast<int>(panel_side),
            {0.5f * (box.low + box.high) - down, down - panel_side / 2 * (dx + dy), dx, dy}};
}

std::string base64(std::string bytes) {
    constexpr const char* letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    bytes.resize((bytes.size() + 2) / 3 * 3);  // zeros behind the end of a picture
    std::string text;
    uint32_t bits = 0;
    for (size_t i = 0; i < bytes.size(); i++) {
        bits = bits << 8 | static_cast<uint8_t>(bytes[i]);
        for (int shift = 18; i % 3 == 2 && shift >= 0; shift -= 6)
            text += letters[bits >> shift & 63];
    }
    return text;
}

/// The scene in flat colours, lit along the rays; lamps are yellow.
void draw_scene(std::string& svg, const Panel& panel, const Scene& scene) {
    Image image(panel.width / 2, panel.height / 2);  // a pixel is 2 x 2 of the panel
    for (int i = 0; i < image.width * image.height; i++) {
        int x = i % image.width, y = i / image.width;
        Vec2 middle = {2 * static_cast<float>(x) + 1, 2 * static_cast<float>(y) + 1};
        Ray ray = camera_ray(panel.view, middle);
        if (!panel.is_camera) {  // start at the eye's height
            Vec3 up = cross(panel.view.dx, panel.view.dy);
            ray.o = ray.o + dot(scene.camera.o - ray.o, up) / dot(ray.d, up) * ray.d;
        }
        std::optional<Hit> hit = intersect(scene, ray);
        Rgb& pixel = image.at(x, y);
        pixel = {0.8f, 0.85f, 0.9f};  // the sky
        if (!hit) continue;
        bool diffuse = hit->material->type == MaterialType::diffuse,
             shines = !is_black(emission(scene, *hit));
        Rgb colour = diffuse ? hit->material->reflectance : Rgb{0.5f, 0.6f, 0.65f};
        pixel = shines ? Rgb{1, 0.75f, 0.05f} : (0.25f - 0.75f * dot(ray.d, hit->n)) * colour;
    }
    svg += format("<image width='%d' height='%d' opacity='0.6' ", panel.width, panel.height);
    svg += "href='data:image/png;base64," + base64(encode_png(image, "")) + "'/>\n";
}

/// Draws the part of a segment in front of the camera.
void draw_line(std::string& svg, const Panel& panel, Vec3 a, Vec3 b, const char* style) {
    float za = panel.depth(a), zb = panel.depth(b), near = 0.01f * std::max(za, zb);
    if (!(near > 0)) return;
    if (za < near) a = a + (near - za) / (zb - za) * (b - a);
    if (zb < near) b = b + (near - zb) / (za - zb) * (a - b);
    Vec2 from = panel.project(a), to = panel.project(b);
    svg += format("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' %s/>\n", double{from.x},
                  double{from.y}, double{to.x}, double{to.y}, style);
}

void draw_point(std::string& svg, const Panel& panel, Vec3 p, const std::string& name) {
    if (!(panel.depth(p) > 0)) return;
    Vec2 at = panel.project(p);
    svg +=
        format("<circle cx='%.1f' cy='%.1f' r='4' %s/>\n", double{at.x}, double{at.y}, path_style);
    svg += words({at.x + 6, at.y - 6}, name);
}

/// An SVG with two panels: the scene seen by the camera, and from above, each with the path and its
/// shadow rays. eye: start of the path from the eye; rays: all rays that the path traced.
std::string draw_path(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& vertices,
                      const std::vector<TracedRay>& rays) {
    float scale = panel_side / static_cast<float>(std::max(scene.width, scene.height));
    int width = std::max(2, static_cast<int>(scale * static_cast<float>(scene.width))),
        height = std::max(2, static_cast<int>(scale * static_cast<float>(scene.height)));
    Panel by_camera = {true, width, height, camera_view(scene.camera, width, height)};
    Box box = {eye, eye};
    for (const PathVertex& x : vertices) box.add(x.p);
    std::string svg;
    svg += format("<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f'>\n",
                  double{2 * panel_side + 3 * margin}, double{panel_side + margin + 56});
    svg += "<rect width='100%' height='100%' fill='white'/>\n";
    float left = margin;
    for (const Panel& panel : {by_camera, panel_from_above(scene, box)}) {
        svg += format("<svg x='%.0f' y='%.0f' width='%d' height='%d' viewBox='0 0 %d %d'>\n",
                      double{left}, double{margin}, panel.width, panel.height, panel.width,
                      panel.height);
        draw_scene(svg, panel, scene);
        for (const auto& [ray, shadow, met, t] : rays) {
            if (met && !shadow) continue;  // leads to the next vertex
            const char* style = !shadow ? path_style : met ? blocked : open;
            float end = std::min(shadow ? ray.t_max : t, 2 * scene.radius);
            draw_line(svg, panel, ray.o, ray.o + end * ray.d, style);
        }
        if (!panel.is_camera) draw_point(svg, panel, eye, "E");
        for (size_t i = 0; i < vertices.size(); i++) {
            const auto& [p, from] = vertices[i];
            Vec3 before = from < 0 ? eye : vertices[static_cast<size_t>(from)].p;
            if (from >= -1) draw_line(svg, panel, before, p, path_style);
            draw_point(svg, panel, p, std::to_string(i + 1));
        }
        svg += "</svg>\n";
        svg += words({left, margin + static_cast<float>(panel.height) + 18},
                     panel.is_camera ? "as the camera sees it" : "from above");
        left += panel_side + margin;
    }
    svg += words({margin, margin + panel_side + 42},
                 "red: the path; green: a shadow ray that meets nothing; dashed: a blocked one");
    return svg + "</svg>\n";
}

/// All contributions of the sample, with their sum for each pixel: first its own pixel, then those
/// that a path from a light was connected to.
Table table_of(const Scene& scene, std::vector<Contribution> additions, size_t own) {
    std::vector<size_t> pixels = {own};
    for (Contribution& added : additions) {
        if (added.pixel == Contribution::own_pixel) added.pixel = own;
        if (std::find(pixels.begin(), pixels.end(), added.pixel) == pixels.end())
            pixels.push_back(added.pixel);
    }
    Table table{{"pixel", "vertex", "found by", "class", "mis", "R", "G", "B"}, {}};
    size_t width = static_cast<size_t>(scene.width);
    for (size_t pixel : pixels) {
        std::string place = std::to_string(pixel % width) + "," + std::to_string(pixel / width);
        auto add_row = [&](std::vector<std::string> words, Rgbd L) {
            words.insert(words.begin(), place);
            for (double x : {L.r, L.g, L.b}) words.push_back(digits(x, 7));
            table.rows.push_back(words);
        };
        Rgbd sum;
        for (const Contribution& added : additions) {
            if (added.pixel != pixel) continue;
            sum += added.L;
            add_row({std::to_string(added.vertex), added.way, added.path_class,
                     digits(double{added.mis}, 4)},
                    added.L);
        }
        add_row({"", "", "", "sum"}, sum);
    }
    return table;
}

}  // namespace

int explain(const Scene& scene, const RenderOptions& options, const Method& method) {
    bool halves = method.allocation.pilot > 0;
    auto [seed, y, x, s] = *options.explain;
    bool is_taken = options.time > 0 || halves || s < scene.spp;
    if (x >= scene.width || y >= scene.height || !is_taken)
        fail_value("explain", options.explain->text(),
                   format("a pixel of %dx%d and one of %d samples, which count from 0", scene.width,
                          scene.height, scene.spp));
    size_t pixel = static_cast<size_t>(y * scene.width + x);

    // Trace the sample just as render_film does, and record all of it.
    if (method.prepare)
        method.prepare(static_cast<uint32_t>(s), options.threads, [] { return false; });
    Sampler sampler(options.sampler, options.seed, static_cast<uint32_t>(scene.spp));
    uint32_t number = static_cast<uint32_t>(halves ? s / 2 : s);
    start_sample(sampler, pixel, halves ? s % 2 : 0, number);
    std::vector<TracedRay> rays;
    rays_kept = &rays;
    PathStory story{scene.max_depth, options.search == LightSearch::photons};
    Recorder recorder(true, &story);
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Vec2 film = film_point(x, y, sampler, scene.camera.pixel_centre);
    Ray ray = camera_ray(view, film);
    Splats splats;
    method.trace(scene, ray, splats, sampler, recorder);
    story.ends();
    rays_kept = nullptr;

    std::printf(
        "pixel %d,%d sample %d of %s: camera at (%.6g, %.6g, %.6g), film point +%.4f +%.4f\n", x, y,
        s, printable(scene.origin->file).c_str(), double{ray.o.x}, double{ray.o.y}, double{ray.o.z},
        double{film.x} - x, double{film.y} - y);
    std::printf("%s", story.text.c_str());
    std::vector<Contribution> counted = recorder.contributions();
    ClassFilter chosen(options.paths);
    std::erase_if(counted, [&](const auto& added) { return !chosen.matches(added.path_class); });
    std::printf("\n%s", aligned(table_of(scene, counted, pixel)).c_str());

    std::string file = drawing_path(options);
    write_file_atomically(file, draw_path(scene, ray.o, recorder.vertices(), rays));
    if (!options.quiet) std::printf("wrote %s\n", file.c_str());
    bool finite = std::all_of(counted.begin(), counted.end(),
                              [](const Contribution& added) { return is_finite(added.L); });
    return finite ? 0 : 1;
}
