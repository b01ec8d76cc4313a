#include "tests/diagnose/scenes.h"

#include <cmath>
#include <cstdio>

#include "common/scene_file/reader.h"
#include "tests/check/probes.h"

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

/// The scene of a pbrt text, in the plain form.
SmallScene plain(const std::string& name, const std::string& what, const std::string& text) {
    Scene s = parse_scene(name, text, nullptr);
    const Camera& c = s.camera;
    SmallScene small = {.name = name, .what = what, .pbrt = "", .words = ""};
    small.depth = s.max_depth;
    char words[600];
    std::snprintf(words, sizeof words,
                  "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d "
                  "\"string filename\" \"%s.exr\"\nPixelFilter \"box\"\nSampler \"independent\" "
                  "\"integer pixelsamples\" 1024\nIntegrator \"path\" \"integer maxdepth\" %d\n",
                  s.width, s.height, name.c_str(), s.max_depth);
    size_t look_at = text.find("LookAt "), until = text.find("Camera", look_at);
    small.pbrt = "# " + what + "\n" + words + text.substr(look_at, until - look_at - 1) +
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
            small.has.insert("a sky");
        }
        add_where(static_cast<int>(i));
    }
    add_where(-1);
    if (s.lights.size() > 1) small.has.insert("more than one light");
    return small;
}

std::string view(const std::string& look_at, double fov, int depth = 1, int width = 16) {
    return "Film \"rgb\" \"integer xresolution\" " + number(width) +
           " \"integer yresolution\" 16 Integrator \"path\" \"integer maxdepth\" " + number(depth) +
           " LookAt " + look_at + " Camera \"perspective\" \"float fov\" " + number(fov) +
           " WorldBegin\n";
}
std::string object(const std::string& material, const std::string& shape) {
    return "AttributeBegin Material " + material + " " + shape + " AttributeEnd\n";
}
std::string shining(const std::string& L) {
    return "\"diffuse\" \"rgb reflectance\" [0 0 0] AreaLightSource \"diffuse\" \"rgb L\" [" + L +
           "]";
}
std::string quad(const std::string& corners) {
    return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" + corners +
           "]";
}
/// Lamps that fill the middle of some of the 4 x 4 tiles of a picture of a field of view of 90.
std::string pattern(int width) {
    struct Lamp {
        int x, y;
        double L;
    };
    std::string text;
    for (Lamp lamp : {Lamp{0, 0, 3}, {1, 0, 1}, {0, 2, 0.5}, {3, 3, 2}, {2, 1, 0.25}}) {
        double w = 2 * width / 16.0, x = w * (lamp.x - 2) + w / 4, y = 2.0 * (2 - lamp.y) - 0.5;
        std::string x0 = number(x) + " ", x1 = number(x + w / 2) + " ", z = " 4 ";
        std::string top = number(y) + z, low = number(y - 1) + z, L = number(lamp.L) + " ";
        text += object(shining(L + L + L), quad(x0 + low + x0 + top + x1 + top + x1 + low));
    }
    return text;
}

}  // namespace

std::vector<SmallScene> small_scenes() {
    static const std::vector<std::string> chosen = {
        "floor",    "slant",       "turned",        "far",       "large",     "near", "three",
        "unequal",  "sizes",       "front",         "behind",    "half",      "gap",  "horizon",
        "sky",      "wall beside", "mirror beside", "sky, lamp", "lamp, sky", "room", "sphere",
        "corridor", "pane",        "bulb",          "mirror"};
    std::vector<SmallScene> all;
    auto add = [&](const std::string& title, const std::string& what, const std::string& text) {
        std::string name;
        for (char c : title)
            if (c != ',') name += c == ' ' ? '-' : c;
        all.push_back(plain(name, what, text));
    };
    std::string above = view("0 1.2 0  0 0 0  0 0 1", 40);
    std::string ground = quad("-20 0 -20  -20 0 20  20 0 20  20 0 -20");
    std::string floor_here = object("\"diffuse\" \"rgb reflectance\" [.5 .5 .5]", ground);
    std::string ahead = "0 0 0  0 0 1  0 1 0", sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
    std::string sphere = "Shape \"sphere\" \"float radius\" ";
    add("frame", "lamps that the camera sees", view(ahead, 90) + pattern(16));
    add("wide", "the same in a wide picture", view(ahead, 90, 1, 32) + pattern(32));
    add("paint", "a coloured floor under a coloured lamp",
        above + object("\"diffuse\" \"rgb reflectance\" [.8 .4 .2]", ground) +
            object(shining("1 2 6"), quad("-.5 2 -.5  .5 2 -.5  .5 2 .5  -.5 2 .5")));
    add("ball", "a floor under a shining ball",
        above + floor_here + object(shining("1 1 1"), "Translate 0 2 0 " + sphere + ".5"));
    add("reflection", "a lamp behind the camera, in a mirror",
        view(ahead, 20) + object(shining("1 1 1"), quad("-9 -9 -3  9 -9 -3  9 9 -3  -9 9 -3")) +
            object("\"conductor\" \"rgb reflectance\" [.9 .9 .9]",
                   quad("-1 -1 2  -1 1 2  1 1 2  1 -1 2")));
    std::string wall;
    for (int i = 0; i < 4; i++) {
        std::string L = number(2.0 / (1 << i)) + " ", z = " 3  ";
        std::string x0 = i % 2 ? "0 " : "-20 ", x1 = i % 2 ? "20 " : "0 ";
        std::string y0 = i < 2 ? "0" : "-20", y1 = i < 2 ? "20" : "0";
        wall +=
            object(shining(L + L + L), quad(x0 + y0 + z + x0 + y1 + z + x1 + y1 + z + x1 + y0 + z));
    }
    add("lens", "a wall of four lamps, seen through a ball of glass",
        view("0 0 -4  .1 .1 0  0 1 0", 24, 8) + object("\"dielectric\"", sphere + "1") + wall);
    add("tilted", "a square that faces away from the camera, seen from above at an angle",
        view("0 3 -3  0 0 0  0 1 0", 40) +
            object("\"diffuse\" \"rgb reflectance\" [.5 .5 .5]",
                   quad("-1.2 0 -.6  1.2 0 -.6  1.2 0 .9  -1.2 0 .9")) +
            object(shining("1 1 1"), quad("-2 4 -2  2 4 -2  2 4 2  -2 4 2")));
    add("pearl", "a grey ball in a ball of glass, under a sky",
        view("0 0 -4  0 0 0  0 1 0", 16, 20) + sky + object("\"dielectric\"", sphere + "1") +
            object("\"diffuse\" \"rgb reflectance\" [.5 .5 .5]",
                   "Translate .1 0 -.4 " + sphere + ".5"));
    for (const Probe& probe : all_probes()) {
        if (std::find(chosen.begin(), chosen.end(), probe.name) == chosen.end()) continue;
        add(probe.name, probe.what, probe.text);
        size_t at = probe.text.find("maxdepth\" ") + 10;
        bool is_room = probe.name == "room";
        if (!is_room && probe.name != "sphere") continue;
        for (int depth : {1, 2})
            if (is_room || depth == 2)
                add(probe.name + "-" + number(depth), probe.what + ", with shorter paths",
                    std::string(probe.text).replace(at, 1, number(depth)));
    }
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
