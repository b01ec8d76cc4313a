#include <algorithm>
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/progress.h"
#include "common/recording/class_filter.h"
#include "common/recording/recorder.h"
#include "common/render/render.h"
#include "common/render/table.h"
#include "common/scene/intersect.h"
#include "common/scene/prepare.h"

namespace {

constexpr float side = 460, margin = 20;  // px
constexpr const char* styles[][2] = {
    {"fill='#c03' stroke='#c03' stroke-width='2'", "path from the eye E"},
    {"fill='#e70' stroke='#e70' stroke-width='2'", "path from a light"},
    {"stroke='#080' stroke-width='1.5'", "shadow ray, open"},
    {"stroke='#555' stroke-width='1.5' stroke-dasharray='5 4'", "blocked"},
    {"stroke='#c03' stroke-width='1.5' stroke-dasharray='2 4'", "leaves"}};
constexpr const char *by_eye = styles[0][0], *by_light = styles[1][0], *open = styles[2][0],
                     *blocked = styles[3][0], *leaves = styles[4][0];

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
    /// Words with a contrasting outline; `at`: left end of their base line.
    void words(Vec2 at, const std::string& words) {
        add("<text x='%.1f' y='%.1f' font-family='sans-serif' font-size='13' stroke='white' "
            "stroke-width='3' paint-order='stroke'>%s</text>\n",
            double{at.x}, double{at.y}, words.c_str());
    }
};

/// A panel of the drawing: a camera, of which a pixel is one of the panel.
struct Panel {
    bool is_camera;
    float left;
    int width, height;
    CameraView view;

    float volume() const { return dot(view.corner, cross(view.dx, view.dy)); }
    /// z of  p - o = z (corner + x dx + y dy);  a point in front of the camera has z > 0.
    float depth(Vec3 p) const { return dot(p - view.o, cross(view.dx, view.dy)) / volume(); }
    /// The position of such a point.
    Vec2 project(Vec3 p) const {
        Vec3 a = 1 / (depth(p) * volume()) * (p - view.o);
        return {left + dot(a, cross(view.dy, view.corner)),
                margin + dot(a, cross(view.corner, view.dx))};
    }
};

Panel camera_panel(const Scene& scene) {
    float scale = side / static_cast<float>(std::max(scene.width, scene.height));
    int width = std::max(2, static_cast<int>(scale * static_cast<float>(scene.width))),
        height = std::max(2, static_cast<int>(scale * static_cast<float>(scene.height)));
    return {true, margin, width, height, camera_view(scene.camera, width, height)};
}

/// The axis of the world that points up, for a camera that looks about horizontally. In doubt y, as
/// in most scenes.
Vec3 upward(const Camera& camera) {
    Vec3 a = abs(camera.up), up;
    int axis = 2 * a.y >= a.x && 2 * a.y >= a.z ? 1 : a.x >= a.z ? 0 : 2;
    up[axis] = camera.up[axis] < 0 ? -1.0f : 1.0f;
    return up;
}

/// The view of a box from high above; the camera's right is on the right.
Panel panel_from_above(const Scene& scene, Box box, float left) {
    Vec3 up = upward(scene.camera), forward = scene.camera.forward;
    Vec3 away = normalize(forward - dot(forward, up) * up), right = cross(up, away);
    if (dot(right, scene.camera.right) < 0) right = -right;
    float size = 1.2f * length(box.high - box.low);
    if (size == 0) size = scene.radius;
    Vec3 dx = size / side * right, dy = -size / side * away, down = -1000 * size * up;
    return {false,
            left,
            static_cast<int>(side),
            static_cast<int>(side),
            {0.5f * (box.low + box.high) - down, down - side / 2 * (dx + dy), dx, dy}};
}

/// The ray that meets what a point of a panel shows; from above it starts at the eye's height.
Ray ray_of(const Scene& scene, const Panel& panel, Vec2 p) {
    Ray ray = camera_ray(panel.view, p);
    if (panel.is_camera) return ray;
    Vec3 up = upward(scene.camera);
    float t = dot(scene.camera.o - ray.o, up) / dot(ray.d, up);
    return {ray.o + t * ray.d, ray.d};
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

/// The scene in flat colours, lit along the rays; lamps are yellow.
void draw_scene(Svg& svg, const Panel& panel, const Scene& scene) {
    Image image(panel.width / 2, panel.height / 2);  // a pixel is 2 x 2 of the panel
    for (int i = 0; i < image.width * image.height; i++) {
        int x = i % image.width, y = i / image.width;
        Vec2 middle = {2 * static_cast<float>(x) + 1, 2 * static_cast<float>(y) + 1};
        Ray ray = ray_of(scene, panel, middle);
        std::optional<Hit> hit = intersect(scene, ray);
        Rgb& pixel = image.at(x, y);
        pixel = {0.8f, 0.85f, 0.9f};  // the sky
        if (!hit) continue;
        bool diffuse = hit->material->type == MaterialType::diffuse,
             shines = !is_black(emission(scene, *hit));
        Rgb colour = diffuse ? hit->material->reflectance : Rgb{0.5f, 0.6f, 0.65f};
        pixel = shines ? Rgb{1, 0.75f, 0.05f} : (0.25f - 0.75f * dot(ray.d, hit->n)) * colour;
    }
    svg.add("<image x='%.0f' y='%.0f' width='%d' height='%d' opacity='0.6' ", double{panel.left},
            double{margin}, panel.width, panel.height);
    svg.text += "href='data:image/png;base64," + base64(encode_png(image, "")) + "'/>\n";
}

/// Draws the part of a segment in front of the camera.
void draw_line(Svg& svg, const Panel& panel, Vec3 a, Vec3 b, const char* style) {
    float za = panel.depth(a), zb = panel.depth(b), near = 0.01f * std::max(za, zb);
    if (!(near > 0)) return;
    if (za < near) a = a + (near - za) / (zb - za) * (b - a);
    if (zb < near) b = b + (near - zb) / (za - zb) * (a - b);
    svg.line(panel.project(a), panel.project(b), style);
}

void draw_rays(Svg& svg, const Panel& panel, const Scene& scene,
               const std::vector<TracedRay>& rays) {
    for (const auto& [ray, shadow, met, t] : rays) {
        if (met && !shadow) continue;  // part of the path
        const char* style = !shadow ? leaves : met ? blocked : open;
        float end = std::min(shadow ? ray.t_max : t, 2 * scene.radius);
        draw_line(svg, panel, ray.o, ray.o + end * ray.d, style);
    }
}

void draw_vertices(Svg& svg, const Panel& panel, Vec3 eye, const std::vector<PathVertex>& path) {
    auto mark = [&](Vec3 p, const std::string& name, const char* style) {
        if (!(panel.depth(p) > 0)) return;
        Vec2 at = panel.project(p);
        svg.add("<circle cx='%.1f' cy='%.1f' r='4' %s/>\n", double{at.x}, double{at.y}, style);
        svg.words({at.x + 6, at.y - 6}, name);
    };
    std::vector<const char*> looks;
    for (const PathVertex& x : path) {
        bool begins = x.from == -2, first = x.from == -1;
        looks.push_back(begins ? by_light : first ? by_eye : looks[static_cast<size_t>(x.from)]);
        if (begins || (first && panel.is_camera)) continue;  // seen end-on: a point
        draw_line(svg, panel, first ? eye : path[static_cast<size_t>(x.from)].p, x.p, looks.back());
    }
    if (!panel.is_camera) mark(eye, "E", by_eye);
    for (size_t i = 0; i < path.size(); i++) mark(path[i].p, std::to_string(i + 1), looks[i]);
}

void draw_legend(Svg& svg, float top) {
    Vec2 at = {margin, top};
    for (auto [style, words] : styles) {
        svg.line({at.x, at.y - 4}, {at.x + 26, at.y - 4}, style);
        svg.words({at.x + 32, at.y}, words);
        at.x += 155;
    }
}

/// An SVG with two panels: the scene seen by the camera, and from above, each with the path and its
/// shadow rays; of a very long path only the beginning. eye: start of the path from the eye; rays:
/// all rays that the path traced.
std::string draw_path(const Scene& scene, Vec3 eye, std::vector<PathVertex> path,
                      std::vector<TracedRay> rays) {
    constexpr size_t most = 1000;
    path.resize(std::min(path.size(), most));
    rays.resize(std::min(rays.size(), most));
    Box box = {eye, eye};
    for (const PathVertex& x : path) box = {min(box.low, x.p), max(box.high, x.p)};
    Panel camera = camera_panel(scene);
    float right = static_cast<float>(camera.width) + 2 * margin;
    Svg svg;
    svg.add(
        "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f'>\n"
        "<rect width='100%%' height='100%%' fill='white'/>\n",
        double{std::max(right + side, 950.0f) + margin}, double{side + margin + 56});
    for (const Panel& panel : {camera, panel_from_above(scene, box, right)}) {
        svg.add("<svg x='%.0f' y='%.0f' width='%d' height='%d' viewBox='%.0f %.0f %d %d'>\n",
                double{panel.left}, double{margin}, panel.width, panel.height, double{panel.left},
                double{margin}, panel.width, panel.height);
        draw_scene(svg, panel, scene);
        draw_rays(svg, panel, scene, rays);
        draw_vertices(svg, panel, eye, path);
        svg.text += "</svg>\n";
        svg.words({panel.left, margin + static_cast<float>(panel.height) + 18},
                  panel.is_camera ? "as the camera sees it" : "from above");
    }
    draw_legend(svg, margin + side + 42);
    return svg.text + "</svg>\n";
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
    std::string given = std::to_string(x) + "," + std::to_string(y);
    if (x >= scene.width || y >= scene.height)
        fail_value("explain", given,
                   "a pixel of the picture of " + std::to_string(scene.width) + "x" +
                       std::to_string(scene.height));
    if (options.time == 0 && s >= scene.spp && !halves)
        fail_value("explain", given + "," + std::to_string(s),
                   "a sample below " + std::to_string(scene.spp) + ", as they count from 0");
    size_t pixel = static_cast<size_t>(y * scene.width + x);

    Limit limit;
    TracingLimit tracing([&] { return limit.overdue(); });
    if (method.prepare && !prepare_pass(method, static_cast<uint32_t>(s), options.threads, limit)) {
        tell("stopped before there was a path to explain\n");
        return 3;
    }

    // Trace the sample just as render_film does, and record all of it.
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
    std::optional<Rgb> L;  // none: the path took too long
    try {
        L = method.trace(scene, ray, splats, sampler, recorder);
    } catch (const TracingEnds&) {
        story.step("    given up here: the path goes on, but the program was stopped\n");
    }
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

    double told = 0, returned = L ? sum_of(*L) : 0;
    for (const Contribution& added : recorder.contributions()) told += sum_of(added.L);
    for (const Splat& splat : splats) returned += sum_of(splat.L);
    if (L && std::abs(told - returned) > 1e-4 * std::abs(returned))
        std::printf(
            "warning: the sample is %.6g of all colours, and this is %.6g: the chapter has not "
            "reported a part\n",
            returned, told);

    std::string file = drawing_path(options);
    write_file_atomically(file, draw_path(scene, ray.o, recorder.vertices(), rays));
    if (!options.quiet) std::printf("wrote %s\n", file.c_str());
    if (!L) return 3;
    bool finite = std::all_of(counted.begin(), counted.end(),
                              [](const Contribution& added) { return is_finite(added.L); });
    return finite ? 0 : 1;
}
