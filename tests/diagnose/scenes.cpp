#include "tests/diagnose/scenes.h"

#include <cmath>
#include <cstdio>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/scene_file/reader.h"

namespace {

std::string number(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", std::abs(x) < 1e-6 ? 0 : x);
    return text;
}
template <typename Triple>
std::string triple(const Triple& v, const char* between) {
    return number(double{v[0]}) + between + number(double{v[1]}) + between + number(double{v[2]});
}
std::string triple(Vec3 v, const char* between = " ") {
    return triple(std::array<float, 3>{v.x, v.y, v.z}, between);
}
std::string triple(Rgb c, const char* between = " ") {
    return triple(std::array<float, 3>{c.r, c.g, c.b}, between);
}
bool is_grey(Rgb c) { return c.r == c.g && c.g == c.b; }
std::string value(Rgb c) { return is_grey(c) ? number(double{c.r}) : "(" + triple(c, ", ") + ")"; }

/// A quad or a sphere of a scene that was read.
struct Object {
    std::vector<Vec3> corners;  // of a quad, counter-clockwise seen from the side of its normal
    Vec3 centre;
    float radius = 0;
    uint32_t shape = 0;
};
std::vector<Object> objects_of(const Scene& scene) {
    const Geometry& g = scene.geometry;
    std::vector<Object> objects;
    for (size_t i = 0; i + 1 < g.triangles.size(); i += 2) {
        const Triangle &one = g.triangles[i], &two = g.triangles[i + 1];
        auto is_of = [](const Triangle& t, uint32_t v) {
            return t.v[0] == v || t.v[1] == v || t.v[2] == v;
        };
        Object quad;
        quad.shape = one.shape;
        for (int k = 0; k < 3; k++)
            if (!is_of(two, one.v[(k + 1) % 3]))
                for (int n = 0; n < 3; n++) quad.corners.push_back(g.positions[one.v[(k + n) % 3]]);
        for (uint32_t v : two.v)
            if (!is_of(one, v)) quad.corners.push_back(g.positions[v]);
        objects.push_back(quad);
    }
    for (const Sphere& s : g.spheres) objects.push_back({{}, s.c, s.r, s.shape});
    return objects;
}

std::string material_in_pbrt(const Material& m) {
    if (m.type == MaterialType::dielectric) return "\"dielectric\" \"float eta\" 1.5";
    std::string kind = m.type == MaterialType::diffuse ? "diffuse" : "conductor";
    return "\"" + kind + "\" \"rgb reflectance\" [" + triple(m.reflectance) + "]";
}
std::string material_in_words(const Material& m) {
    if (m.type == MaterialType::dielectric) return "clear glass of index 1.5";
    if (m.type == MaterialType::conductor)
        return "a perfect mirror that reflects " + value(m.reflectance) + " of the light";
    if (max_component(m.reflectance) == 0) return "black (albedo 0)";
    return "diffuse, albedo " + value(m.reflectance);
}

/// Adds an object to both texts of the scene.
void add_object(const Scene& scene, const Object& o, SmallScene& to) {
    const Shape& shape = scene.shapes[o.shape];
    const Material& m = scene.materials[shape.material];
    const Light* light =
        shape.light < 0 ? nullptr : &scene.lights[static_cast<size_t>(shape.light)];
    std::string line = "AttributeBegin ", words;
    if (o.corners.empty()) {
        if (shape.reverse) line += "ReverseOrientation ";
        line += "Translate " + triple(o.centre) + " ";
        words = "- a sphere around (" + triple(o.centre, ", ") + ") of radius " +
                number(double{o.radius});
    } else {
        words = "- a quad with the corners ";
        for (size_t i = 0; i < 4; i++)
            words += (i == 0 ? "(" : i == 3 ? " and (" : ", (") + triple(o.corners[i], ", ") + ")";
        Vec3 n = normalize(cross(o.corners[1] - o.corners[0], o.corners[3] - o.corners[0]));
        words += ", which faces (" + triple(n, ", ") + ")";
    }
    words += ": " + material_in_words(m);
    if (light) {
        bool both = light->two_sided;
        line += "AreaLightSource \"diffuse\" \"rgb L\" [" + triple(light->L) + "]" +
                (both ? " \"bool twosided\" true " : " ");
        const char* side = both                ? "from both sides"
                           : o.corners.empty() ? (shape.reverse ? "inwards" : "outwards")
                                               : "from the side that it faces";
        words += "; it shines " + std::string(side) + " with radiance " + value(light->L);
    }
    line += "Material " + material_in_pbrt(m);
    if (o.corners.empty()) {
        line += " Shape \"sphere\" \"float radius\" " + number(double{o.radius});
    } else {
        line += " Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [";
        for (size_t i = 0; i < 4; i++) line += (i == 0 ? "" : "  ") + triple(o.corners[i]);
        line += "]";
    }
    to.pbrt += line + " AttributeEnd\n", to.words += words + "\n";
    to.coloured |= (light && !is_grey(light->L)) || !is_grey(m.reflectance);
}

/// A known scene in the plain form.
SmallScene plain(const KnownScene& known) {
    const std::string &name = known.name, &text = known.text;
    Scene s = parse_scene(name, text, nullptr);
    const Camera& c = s.camera;
    SmallScene small = {.name = name, .what = known.what, .width = s.width};
    char words[600];
    std::snprintf(words, sizeof words,
                  "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d "
                  "\"string filename\" \"%s.exr\"\nPixelFilter \"box\"\nSampler \"independent\" "
                  "\"integer pixelsamples\" 1024\nIntegrator \"path\" \"integer maxdepth\" %d\n",
                  s.width, s.height, name.c_str(), s.max_depth);
    size_t look_at = text.find("LookAt "), until = text.find("Camera", look_at);
    small.pbrt = "# " + known.what + "\n" + words + text.substr(look_at, until - look_at - 1) +
                 "\nCamera \"perspective\" \"float fov\" " + number(double{c.fov}) +
                 "\nWorldBegin\n";
    small.words = "- camera at (" + triple(c.o, ", ") + "), looking in the direction (" +
                  triple(c.forward, ", ") + "); up in the picture is (" + triple(c.up, ", ") +
                  "), right is (" + triple(c.right, ", ") + "); field of view " +
                  number(double{c.fov}) + " degrees\n";
    std::snprintf(words, sizeof words, "- %d x %d pixels; a path scatters at most %d time%s\n",
                  s.width, s.height, s.max_depth, s.max_depth == 1 ? "" : "s");
    small.words += words;
    std::vector<Object> objects = objects_of(s);
    auto add_where = [&](int light) {
        for (const Object& o : objects)
            if (s.shapes[o.shape].light == light) add_object(s, o, small);
    };
    for (size_t i = 0; i < s.lights.size(); i++) {
        if (s.lights[i].type == LightType::infinite) {
            small.pbrt += "LightSource \"infinite\" \"rgb L\" [" + triple(s.lights[i].L) + "]\n";
            small.words += "- a sky with radiance " + value(s.lights[i].L) + " from everywhere\n";
            small.has_sky = true;
        }
        add_where(static_cast<int>(i));
    }
    add_where(-1);
    small.lights = s.lights.size();
    return small;
}

std::vector<SmallScene> read_small_scenes() {
    std::vector<SmallScene> all;
    std::istringstream lines(read_file("tests/known/tiles.tsv"));
    for (std::string line; std::getline(lines, line);) {
        if (line[0] == '#') continue;
        std::istringstream cells(line);
        std::string name, numbers;
        std::getline(cells, name, '\t');
        std::getline(cells, numbers, '\t');
        double se = 0, mean = 0;
        cells >> se;
        SmallScene scene = plain(known_scene(name));
        std::istringstream tiles(numbers);
        while (tiles >> mean) scene.should.push_back({mean, se});
        all.push_back(scene);
    }
    return all;
}

}  // namespace

const std::vector<SmallScene>& small_scenes() {
    static const std::vector<SmallScene> all = read_small_scenes();
    return all;
}

std::string small_scenes_page() {
    std::string page =
        "# The small scenes\n\nBuild these scenes in your renderer, and let `build/diagnose` judge "
        "the "
        "pictures. `tests/diagnose/README.md`\nsays how. Points are (x, y, z). The corners of a "
        "quad go "
        "around it, counter-clockwise seen from the side that it faces.\n\n";
    for (const SmallScene& s : small_scenes())
        page += "## " + s.name + "\n\n" + static_cast<char>(std::toupper(s.what[0])) +
                s.what.substr(1) + ".\n\n" + s.words + "\n";
    return page;
}
