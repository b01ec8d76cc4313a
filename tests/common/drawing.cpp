// What is drawn stands where it should: paths in their scene, outlines, plots and colours.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstring>

#include "common/explaining/path_drawing.h"
#include "common/explaining/preview.h"
#include "common/picture/comparison.h"
#include "common/picture/heat_map.h"
#include "common/picture/plot.h"
#include "common/picture/png.h"
#include "common/picture/sheet.h"
#include "tests/support/folder.h"
#include "tests/support/scenes.h"

namespace {

/// The numbers behind each `begin` of a drawing that ends with `end`, as `pattern` reads them.
std::vector<std::array<float, 4>> numbers_in(const std::string& svg, const std::string& begin,
                                             const char* pattern, const std::string& style = "") {
    std::vector<std::array<float, 4>> found;
    for (size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
        std::array<float, 4> x = {};
        std::sscanf(svg.c_str() + at, pattern, x.data(), &x[1], &x[2], &x[3]);
        bool fits = svg.substr(at, svg.find('\n', at) - at).find(style) != std::string::npos;
        if (fits) found.push_back(x);
    }
    return found;
}
std::vector<std::array<float, 4>> circles_in(const std::string& svg, const std::string& style) {
    return numbers_in(svg, "<circle", "<circle cx='%f' cy='%f' r='%f'", style);
}
std::vector<std::array<float, 4>> lines_in(const std::string& svg, const std::string& style) {
    return numbers_in(svg, "<line", "<line x1='%f' y1='%f' x2='%f' y2='%f'", style);
}
bool near(float a, float b, float by = 0.11f) { return std::abs(a - b) <= by; }

/// A drawing without its legend.
std::string drawn(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& path,
                  const std::vector<TracedRay>& rays = {}) {
    std::string svg = draw_path(scene, eye, path, rays);
    return svg.substr(0, svg.find(">from above<"));
}

/// A camera at (1, 3, -5) that looks about along +z and a little down, 40 x 20 pixels.
Scene room(const std::string& more = "") {
    Scene scene = scene_of(
        "LookAt 1 3 -5  0.5 1 0  0 1 0 Camera \"perspective\" \"float fov\" 50\nWorldBegin\n"
        "LightSource \"point\" \"point3 from\" [0.5 1.5 1]\n" +
        square(0, true) + more);
    scene.width = 40, scene.height = 20;
    return scene;
}

std::string decode_base64(const std::string& text) {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    uint32_t bits = 0;
    int have = 0;
    for (char c : text) {
        size_t value = letters.find(c);
        if (value == std::string::npos) break;
        bits = bits << 6 | static_cast<uint32_t>(value), have += 6;
        if (have < 8) continue;
        have -= 8;
        bytes += static_cast<char>(bits >> have & 255);
    }
    return bytes;
}

Image seen_by_camera(const Scene& scene, int side) {
    CameraView view = camera_view(scene.camera, side, side);
    return preview(scene, side, side, [&](Vec2 pixel) { return camera_ray(view, pixel); });
}

Image numbered(int width, int height) {
    Image image(width, height);
    for (size_t i = 0; i < image.pixels.size(); i++) image.pixels[i].r = static_cast<float>(i);
    return image;
}

}  // namespace

TEST_SUITE("drawing") {
    TEST_CASE("identity: each vertex is drawn where the camera's picture has it") {
        Scene scene = room("Scale 9 1 9 Translate 0 -1 0 " + square(0, true));
        CameraView view = camera_view(scene.camera, 40, 20);
        Vec3 eye = scene.camera.o;
        std::vector<PathVertex> path;
        std::vector<Vec2> film;
        for (Vec2 at : {Vec2{20, 10}, Vec2{5, 4}, Vec2{33.3f, 17.7f}}) {
            Ray ray = camera_ray(view, at);
            film.push_back(at);
            path.push_back({ray.o + (3 + at.x / 10) * ray.d, static_cast<int>(path.size()) - 1});
        }
        std::string svg = drawn(scene, eye, path);
        auto points = circles_in(svg, "fill='#c03'");
        REQUIRE(points.size() == 6);  // in both panels
        // 460 px for 40 pixels, from (20, 20) on.
        for (size_t i = 0; i < 3; i++) {
            CHECK(near(points[i][0], 20 + 11.5f * film[i].x));
            CHECK(near(points[i][1], 20 + 11.5f * film[i].y));
            CHECK(points[i][2] == 3.5f);
        }
        // The path's lines join them; in the camera's panel the one from the eye is a point.
        auto lines = lines_in(svg, "stroke='#c03' stroke-width='2'/>");
        REQUIRE(lines.size() == 2 + 3);
        for (size_t i = 0; i < 2; i++) {
            CHECK(near(lines[i][0], points[i][0]));
            CHECK(near(lines[i][1], points[i][1]));
            CHECK(near(lines[i][2], points[i + 1][0]));
            CHECK(near(lines[i][3], points[i + 1][1]));
        }
        // From above: right is right, far is up, in one scale; the eye is in it.
        auto eyes = circles_in(svg, "fill='#000'");
        REQUIRE(eyes.size() == 1);
        CHECK(near(lines[2][0], eyes[0][0]));
        CHECK(near(lines[2][1], eyes[0][1]));
        float scale = (points[4][0] - eyes[0][0]) / (path[1].p.x - eye.x);
        CHECK(scale > 0);
        for (size_t i = 0; i < 3; i++) {
            CHECK(near(points[3 + i][0] - eyes[0][0], scale * (path[i].p.x - eye.x), 0.2f));
            CHECK(near(points[3 + i][1] - eyes[0][1], -scale * (path[i].p.z - eye.z), 0.2f));
            CHECK(points[3 + i][0] > 500);  // right of the camera's panel
        }
        // Point lights are in both panels, by the same rules.
        auto lights = circles_in(svg, "fill='#fc2'");
        REQUIRE(lights.size() == 2);
        Vec3 light = {0.5f, 1.5f, 1};
        CHECK(near(lights[1][0] - eyes[0][0], scale * (light.x - eye.x), 0.2f));
        CHECK(near(lights[1][1] - eyes[0][1], -scale * (light.z - eye.z), 0.2f));
        PathVertex at_light = {light, -1};
        auto there = circles_in(drawn(scene, eye, {at_light}), "fill='#c03'");
        REQUIRE(there.size() == 2);
        CHECK(near(there[0][0], lights[0][0]));
        CHECK(near(there[0][1], lights[0][1]));
    }

    TEST_CASE(
        "truth: from above is along the axis that is up, with the camera's right on the right") {
        struct {
            const char* look;
            Vec3 right, away;
        } cases[] = {{"0 1 -9  0 0 0  0 1 0", {1, 0, 0}, {0, 0, 1}},
                     {"9 1 0  0 0 0  0 1 0", {0, 0, 1}, {-1, 0, 0}},
                     {"0 1 9  0 0 0  0 1 0", {-1, 0, 0}, {0, 0, -1}},
                     {"0 -9 1  0 0 0  0 0 1", {-1, 0, 0}, {0, 1, 0}},
                     {"-9 0 1  0 0 0  0 0 1", {0, 1, 0}, {1, 0, 0}},
                     {"0 6 -6  0 0 0  0 1 0", {1, 0, 0}, {0, 0, 1}}};
        for (const auto& c : cases) {
            CAPTURE(std::string(c.look));
            Scene scene = scene_of("LookAt " + std::string(c.look) +
                                   " Camera \"perspective\" WorldBegin\nLightSource \"point\"\n"
                                   "Shape \"sphere\"\n");
            scene.width = scene.height = 20;
            // The signs of LookAt make right the camera's: pbrt's is left-handed.
            std::vector<PathVertex> path = {{{}, -1}, {c.right, 0}, {c.away, 1}};
            auto points = circles_in(drawn(scene, scene.camera.o, path), "fill='#c03'");
            REQUIRE(points.size() >= 3);
            size_t n = points.size() - 3;
            CHECK(points[n + 1][0] > points[n][0] + 5);
            CHECK(near(points[n + 1][1], points[n][1]));
            CHECK(points[n + 2][1] < points[n][1] - 5);
            CHECK(near(points[n + 2][0], points[n][0]));
        }
    }

    TEST_CASE("truth: rays have the marks of what became of them") {
        Scene scene = room();
        CameraView view = camera_view(scene.camera, 40, 20);
        auto to = [&](float x, float y, float t) {
            Ray ray = camera_ray(view, {x, y});
            return ray.o + t * ray.d;
        };
        Vec3 a = to(4, 4, 3), b = to(20, 8, 4), floor = {0, 0, 0};
        auto at = [&](float x, float y) { return std::array{20 + 11.5f * x, 20 + 11.5f * y}; };
        auto ray = [&](Vec3 from, Vec3 dest, bool shadow, bool met, float t) {
            return TracedRay{{from, dest - from, 1}, shadow, met, t};
        };
        auto only = [&](const TracedRay& traced, const char* style) {
            auto lines = lines_in(drawn(scene, scene.camera.o, {}, {traced}), style);
            REQUIRE(lines.size() >= 1);
            return lines[0];
        };
        auto from = at(4, 4), dest = at(20, 8);
        for (const auto& line :
             {only(ray(a, b, true, false, NAN), "stroke='#080' stroke-width='1.5'"),
              only(ray(a, b, false, true, 1), "stroke='#e9a' stroke-width='1'")}) {
            CHECK(near(line[0], from[0]));
            CHECK(near(line[1], from[1]));
            CHECK(near(line[2], dest[0]));
            CHECK(near(line[3], dest[1]));
        }
        // What leaves goes on as far as twice the scene's radius.
        Vec3 up = a + Vec3{0, 9 * scene.radius, 0};
        TracedRay leaves = {{a, normalize(up - a)}, false, false, infinity};
        auto line = only(leaves, "stroke='#c03' stroke-width='1.5' stroke-dasharray='2 4'");
        CHECK(near(line[0], from[0]));
        CHECK(line[3] < line[1]);
        // What is blocked ends there, with a cross.
        Vec3 below = {0, -4, 0}, above = {0, 4, 0};
        std::string svg =
            drawn(scene, scene.camera.o, {{floor, -1}}, {ray(above, below, true, true, NAN)});
        auto blocked = lines_in(svg, "stroke='#555' stroke-width='1.5' stroke-dasharray='5 4'");
        auto crosses = lines_in(svg, "stroke='#555'/>");
        auto where = circles_in(svg, "fill='#c03'");
        REQUIRE(blocked.size() == 2);
        REQUIRE(crosses.size() == 4);
        for (size_t panel = 0; panel < 2; panel++) {
            float x = where[panel][0], y = where[panel][1];
            CHECK(near(blocked[panel][2], x));
            CHECK(near(blocked[panel][3], y));
            for (size_t k : {2 * panel, 2 * panel + 1}) {
                CHECK(near(crosses[k][0], x - 4));
                CHECK(near(crosses[k][2], x + 4));
                CHECK(near(crosses[k][1] + crosses[k][3], 2 * y, 0.3f));
                CHECK(near(std::abs(crosses[k][1] - crosses[k][3]), 8));
            }
            CHECK(crosses[2 * panel][1] < crosses[2 * panel][3]);
            CHECK(crosses[2 * panel + 1][1] > crosses[2 * panel + 1][3]);
        }
    }

    TEST_CASE("truth: a segment that begins behind the camera is drawn from its border on") {
        Scene scene = room();
        CameraView view = camera_view(scene.camera, 40, 20);
        Vec3 forward = camera_ray(view, {20, 10}).d, eye = scene.camera.o;
        Vec3 seen = camera_ray(view, {30, 10}).o + 4 * camera_ray(view, {30, 10}).d;
        Vec3 behind = eye - 8 * forward + (seen - eye);
        // Straight ahead of the camera all goes to the middle of the picture.
        auto lines = lines_in(drawn(scene, eye, {{behind, -1}, {seen, 0}, {behind, 1}}),
                              "stroke='#c03' stroke-width='2'/>");
        REQUIRE(lines.size() >= 2);
        float x = 20 + 11.5f * 30, y = 20 + 11.5f * 10;
        CHECK(near(lines[0][2], x, 0.3f));
        CHECK(near(lines[0][3], y, 0.3f));
        CHECK(near(lines[1][0], x, 0.3f));
        CHECK(near(lines[1][1], y, 0.3f));
        CHECK(near(lines[0][0], lines[1][2], 0.3f));
        CHECK(near(lines[0][1], y, 0.5f));
        CHECK(lines[0][0] > 480);  // it leaves the panel on the right
        // All of it behind: nothing.
        CHECK(circles_in(drawn(scene, eye, {{eye - forward, -1}}), "fill='#c03'").size() <= 1);
    }

    TEST_CASE("truth: paths from lights are orange, up to the last vertex that one leads to") {
        Scene scene = room();
        std::vector<PathVertex> path = {
            {{0, 1, 0}, -2}, {{0.2f, 0.5f, 0}, 0}, {{0.4f, 0, 0}, 1}, {{-0.5f, 0, 0}, -1}};
        std::string svg = drawn(scene, scene.camera.o, path);
        CHECK(circles_in(svg, "fill='#e70'").size() == 6);
        CHECK(circles_in(svg, "fill='#c03'").size() == 2);
        CHECK(lines_in(svg, "stroke='#e70' stroke-width='2'/>").size() == 4);
        CHECK(lines_in(svg, "stroke='#c03' stroke-width='2'/>").size() == 1);
        for (const char* name : {">1<", ">2<", ">3<", ">4<"})
            CHECK(svg.find(name) != std::string::npos);
    }

    TEST_CASE("identity: both pictures below the path show what is there") {
        // A lamp below a ceiling that is above the eye.
        Scene scene = room("AttributeBegin Scale 9 1 9 Translate 0 9 0 " + square(0, false) +
                           "AttributeEnd\n" +
                           "AreaLightSource \"diffuse\" Translate 0.3 1 -0.1 "
                           "Shape \"sphere\" \"float radius\" 0.3\n");
        Vec3 lamp = scene.geometry.spheres[0].c;
        std::string svg = draw_path(scene, scene.camera.o, {{lamp, -1}}, {});
        auto points = circles_in(svg, "fill='#c03'");
        REQUIRE(points.size() == 2);
        const std::string begin = "href='data:image/png;base64,";
        size_t at = 0;
        for (float left : {20.0f, 500.0f}) {
            at = svg.find(begin, at) + begin.size();
            Image image =
                decode_png("a.png", decode_base64(svg.substr(at, svg.find('\'', at) - at)));
            int x = static_cast<int>((points[left > 20][0] - left) / 2);
            int y = static_cast<int>((points[left > 20][1] - 20) / 2);
            CHECK(to_srgb8(image.at(x, y).b) == to_srgb8(0.05f));
            CHECK(to_srgb8(image.at(2, 2).b) != to_srgb8(0.05f));
        }
    }

    TEST_CASE("truth: a preview has the sky, lamps and materials, each lit from the camera") {
        // A ball seen from the front: its middle faces the camera, its rim looks away.
        auto middle = [](const std::string& world, float x = 50.5f) {
            Scene scene = world_of(world, 101);
            Image image = seen_by_camera(scene, 101);
            return image.at(static_cast<int>(x), 50);
        };
        const std::string point = "LightSource \"point\"\n",
                          red = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.25 0]\n";
        auto is_about = [](Rgb a, Rgb b) {
            return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) < 0.01f;
        };
        CHECK(middle(point + "Translate 50 0 0 Shape \"sphere\"") == Rgb{0.8f, 0.85f, 0.9f});
        CHECK(is_about(middle(point + red + "Shape \"sphere\""), {0.5f, 0.25f, 0}));
        CHECK(is_about(middle(point + "Material \"conductor\" Shape \"sphere\""),
                       {0.45f, 0.45f, 0.5f}));
        CHECK(is_about(middle(point + "Material \"dielectric\" Shape \"sphere\""),
                       {0.5f, 0.7f, 0.75f}));
        CHECK(middle("AreaLightSource \"diffuse\" Shape \"sphere\"") == Rgb{1, 0.75f, 0.05f});
        // A plane at 60 degrees is lit by 1/4 + 3/4 cos 60 = 5/8.
        std::string plane =
            point + red + "Rotate 60 0 1 0 Rotate 90 1 0 0 Scale 9 1 9 " + square(0, true);
        Rgb seen = middle(plane);
        CHECK(is_about(seen, {0.5f * 0.625f, 0.25f * 0.625f, 0}));
        // A small lamp where the camera, 4 away, has pixel (75, 40): of 101 pixels, 40 degrees.
        float pixel = 8 * std::tan(pi / 9) / 101;
        Image image = seen_by_camera(
            world_of("Translate " + std::to_string(25 * pixel) + " " + std::to_string(10 * pixel) +
                         " 0 AreaLightSource \"diffuse\" Shape \"sphere\" "
                         "\"float radius\" 0.036",
                     101),
            101);
        for (int y = 0; y < 101; y++) {
            for (int x = 0; x < 101; x++) {
                bool is_lamp = image.at(x, y) == Rgb{1, 0.75f, 0.05f};
                CHECK(is_lamp == (std::abs(x - 75) + std::abs(y - 40) <= 1));
            }
        }
    }

    TEST_CASE("truth: the colours of a heat map, and of an error, in order and at their places") {
        Image numbers(6, 1);
        for (int i = 0; i < 6; i++) numbers.at(i, 0).r = static_cast<float>(2 * i);
        Image map = heat_map(numbers, 8);
        const Rgb colours[] = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}, {1, 1, 1}};
        for (int i = 0; i < 6; i++) CHECK(map.at(i, 0) == colours[i]);
        numbers.at(0, 0).r = 1, numbers.at(1, 0).r = 3, numbers.at(2, 0).r = 5;
        numbers.at(3, 0).r = 7;
        map = heat_map(numbers, 8);
        const Rgb between[] = {{0, 0, 0.5f}, {0, 0.5f, 0.5f}, {0.5f, 0.5f, 0}, {1, 0.5f, 0.5f}};
        for (int i = 0; i < 4; i++) CHECK(map.at(i, 0) == between[i]);
        // The rays of pixels go through their middles, row by row.
        Scene scene = room();
        CameraView view = camera_view(scene.camera, 40, 20);
        auto is_ray = [&](const Ray& ray, float x, float y) {
            return length(ray.d - camera_ray(view, {x, y}).d) < 1e-6f;
        };
        CHECK(is_ray(pixel_ray(scene, view, 83), 3.5f, 2.5f));
        CHECK(pixel_rays(scene, 1).size() == 800);
        std::vector<Ray> rays = pixel_rays(scene, 7);
        CHECK(rays.size() == 115);
        CHECK(is_ray(rays[12], 4.5f, 2.5f));
        Image of_work = heat_map(
            scene, 1, [&](const Ray& ray) { return is_ray(ray, 3.5f, 2.5f) ? 1.0f : 0.0f; });
        CHECK(of_work.width == 40);
        for (int i = 0; i < 800; i++)
            CHECK(of_work.pixels[static_cast<size_t>(i)].g == (i == 83 ? 1 : 0));
        // Seven colours, each a sixth from the next.
        const Rgb stops[] = {{0, 0, 0},
                             {0.02f, 0.01f, 0.15f},
                             {0.2f, 0.01f, 0.25f},
                             {0.6f, 0.06f, 0.1f},
                             {0.95f, 0.3f, 0.01f},
                             {1, 0.75f, 0.1f},
                             {1, 1, 1}};
        for (int i = 0; i < 7; i++) {
            Rgb here = false_colour(i / 6.0);
            for (float d : {here.r - stops[i].r, here.g - stops[i].g, here.b - stops[i].b})
                CHECK(std::abs(d) < 1e-6f);
            if (i == 6) break;
            Rgb mean = 0.5f * (stops[i] + stops[i + 1]), half = false_colour((i + 0.5) / 6);
            CHECK(std::abs(half.r - mean.r) + std::abs(half.b - mean.b) < 1e-6f);
        }
        CHECK(false_colour(-1) == Rgb{0, 0, 0});
        CHECK(false_colour(9) == Rgb{1, 1, 1});
    }

    TEST_CASE("truth: points, lines, curves and fillings stand at their coordinates") {
        auto empty = [] { return Image(40, 30); };
        auto count = [](const Image& image) {
            return static_cast<int>(std::count_if(image.pixels.begin(), image.pixels.end(),
                                                  [](Rgb p) { return p.r > 0; }));
        };
        const Rgb white = {1, 1, 1};
        // A panel of 20 x 10 pixels at (5, 8); x from -1 to 3, y from 0 to 2: 5 pixels a unit.
        Image image = empty();
        Panel panel{image, 5, 8, 20, 10, {-1, 0}, {3, 2}};
        panel.fill([](Vec2 p) { return Rgb{p.x + 10, p.y + 10, 0}; });
        CHECK(count(image) == 200);
        CHECK(near(image.at(5, 8).r, 9.1f, 1e-5f));
        CHECK(near(image.at(5, 8).g, 11.9f, 1e-5f));
        CHECK(near(image.at(24, 17).r, 12.9f, 1e-5f));
        CHECK(near(image.at(24, 17).g, 10.1f, 1e-5f));
        // Discs: each pixel whose middle is within the radius.
        for (float radius : {0.5f, 2.0f, 3.3f}) {
            image = empty();
            panel.dot({1.02f, 1.04f}, radius, white);  // at (15.1, 12.8)
            for (int y = 0; y < 30; y++)
                for (int x = 0; x < 40; x++) {
                    float dx = static_cast<float>(x) + 0.5f - 15.1f;
                    float dy = static_cast<float>(y) + 0.5f - 12.8f;
                    CHECK((image.at(x, y).r > 0) == (dx * dx + dy * dy <= radius * radius));
                }
        }
        // Cut off at the rim, on all sides; far away: nothing.
        for (Vec2 corner : {Vec2{-1, 0}, Vec2{3, 0}, Vec2{-1, 2}, Vec2{3, 2}}) {
            image = empty();
            panel.dot(corner, 3, white);
            CHECK(count(image) == 8);  // a quarter of 32
        }
        image = empty();
        for (Vec2 away : {Vec2{1e9f, 1}, Vec2{1, -1e9f}, Vec2{NAN, 1}}) panel.dot(away, 3, white);
        CHECK(count(image) == 0);
        // A line has a pixel in each column or row that it crosses, none far from it.
        struct {
            Vec2 a, b;
        } lines[] = {{{-1, 0.1f}, {3, 1.9f}}, {{3, 1.9f}, {-1, 0.1f}}, {{0, 0}, {0.5f, 2}}};
        for (const auto& l : lines) {
            image = empty();
            panel.line(l.a, l.b, white);
            bool steep = std::abs(l.b.y - l.a.y) > std::abs(l.b.x - l.a.x);
            std::set<int> seen;
            for (int y = 0; y < 30; y++)
                for (int x = 0; x < 40; x++) {
                    if (image.at(x, y).r == 0) continue;
                    seen.insert(steep ? y : x);
                    Vec2 p = {(static_cast<float>(x) - 4.5f) / 5 - 1,
                              2 - (static_cast<float>(y) - 7.5f) / 5};
                    float t =
                        ((p.x - l.a.x) * (l.b.x - l.a.x) + (p.y - l.a.y) * (l.b.y - l.a.y)) /
                        ((l.b.x - l.a.x) * (l.b.x - l.a.x) + (l.b.y - l.a.y) * (l.b.y - l.a.y));
                    Vec2 d = {l.a.x + t * (l.b.x - l.a.x) - p.x, l.a.y + t * (l.b.y - l.a.y) - p.y};
                    CHECK(d.x * d.x + d.y * d.y < 0.15f * 0.15f);  // of 0.2 a pixel
                }
            CHECK(seen.size() == (steep ? 10 : 20));
        }
        // The graph of x^2, and no more than that.
        image = empty();
        panel.curve([](float x) { return x * x; }, white);
        for (int x = 5; x < 25; x++) {
            float at = (static_cast<float>(x) - 4.5f) / 5 - 1, y = at * at;
            if (y > 1.9f) continue;
            int row = 8 + static_cast<int>((2 - y) * 5);
            bool found = false;
            for (int d = -1; d <= 1; d++)
                found = found || image.at(x, std::clamp(row + d, 8, 17)).r > 0;
            CHECK(found);
        }
    }

    TEST_CASE("truth: a sheet has its tiles in a grid, in the order of reading, on grey") {
        std::vector<Tile> tiles;
        for (int i = 0; i < 5; i++) tiles.push_back({numbered(7 + i % 2, 5 - i % 2), {}});
        Image all = sheet(tiles, 3);
        const Rgb paper = {0.6f, 0.6f, 0.6f};
        REQUIRE(all.width == 10 + 3 * 18);
        REQUIRE(all.height == 10 + 2 * 15);
        Image expected(all.width, all.height);
        std::fill(expected.pixels.begin(), expected.pixels.end(), paper);
        for (int i = 0; i < 5; i++) {
            const Image& tile = tiles[static_cast<size_t>(i)].image;
            for (int y = 0; y < tile.height; y++)
                for (int x = 0; x < tile.width; x++)
                    expected.at(10 + 18 * (i % 3) + x, 10 + 15 * (i / 3) + y) = tile.at(x, y);
        }
        CHECK(all.pixels == expected.pixels);
        // Words make a tile as wide as they are, and each line 22 pixels higher.
        Image worded = sheet({{numbered(7, 5), {"some words", ""}}}, 1), nowhere;
        CHECK(worded.width == 20 + write_words(nowhere, 0, 0, "some words"));
        CHECK(worded.height == 20 + 5 + 2 * 22);
        // Ink begins 4 pixels below the tile, and at its left.
        int top = worded.height, left = worded.width;
        for (int y = 15; y < worded.height; y++)
            for (int x = 0; x < worded.width; x++)
                if (worded.at(x, y) == Rgb{0, 0, 0})
                    top = std::min(top, y), left = std::min(left, x);
        CHECK(top >= 19);
        CHECK(top <= 25);
        CHECK(left >= 10);
        CHECK(left <= 12);
    }
}
