#include <cmath>
#include <sstream>

#include "common/base/files.h"
#include "common/base/text.h"
#include "common/scene_file/reader.h"
#include "tests/diagnose/judge.h"

namespace {

std::string number(double x) { return format("%.6g", std::abs(x) < 1e-6 ? 0 : x); }
std::string triple(Vec3 v) {
    return number(double{v.x}) + " " + number(double{v.y}) + " " + number(double{v.z});
}
std::string triple(Rgb c) { return triple(Vec3{c.r, c.g, c.b}); }
bool is_grey(Rgb c) { return c.r == c.g && c.g == c.b; }

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
        bool forward = two.v[1] == one.v[2];  // 0 1 2 0 2 3, else 0 2 1 0 3 2
        Object quad{{}, {}, 0, one.shape};
        for (uint32_t v : {one.v[forward ? 0 : 1], one.v[forward ? 1 : 2], one.v[forward ? 2 : 0],
                           two.v[forward ? 2 : 1]})
            quad.corners.push_back(g.positions[v]);
        objects.push_back(quad);
    }
    for (const Sphere& s : g.spheres) objects.push_back({{}, s.c, s.r, s.shape});
    return objects;
}

std::string text_of(const Material& m) {
    if (m.type == MaterialType::dielectric) return "\"dielectric\" \"float eta\" 1.5";
    std::string kind = m.type == MaterialType::diffuse ? "diffuse" : "conductor";
    return "\"" + kind + "\" \"rgb reflectance\" [" + triple(m.reflectance) + "]";
}

/// Adds a line with an object to the scene.
void add_object(const Scene& scene, const Object& o, SmallScene& to) {
    const Shape& shape = scene.shapes[o.shape];
    const Material& m = scene.materials[shape.material];
    to.pbrt += "AttributeBegin ";
    if (o.corners.empty())
        to.pbrt += (shape.reverse ? "ReverseOrientation Translate " : "Translate ") +
                   triple(o.centre) + " ";
    if (shape.light >= 0) {
        const Light& light = scene.lights[static_cast<size_t>(shape.light)];
        to.pbrt += "AreaLightSource \"diffuse\" \"rgb L\" [" + triple(light.L) + "]" +
                   (light.two_sided ? " \"bool twosided\" true " : " ");
        to.coloured |= !is_grey(light.L);
    }
    to.coloured |= !is_grey(m.reflectance);
    to.pbrt += "Material " + text_of(m);
    if (o.corners.empty()) {
        to.pbrt += " Shape \"sphere\" \"float radius\" " + number(double{o.radius});
    } else {
        to.pbrt += " Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [";
        for (size_t i = 0; i < 4; i++) to.pbrt += (i == 0 ? "" : "  ") + triple(o.corners[i]);
        to.pbrt += "]";
    }
    to.pbrt += " AttributeEnd\n";
}

/// A known scene in the plain form.
SmallScene plain(const KnownScene& known) {
    const std::string &name = known.name, &text = known.text;
    Scene s = parse_scene(name, text, nullptr);
    SmallScene small = {.name = name, .width = s.width};
    std::string film = format(
        "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d "
        "\"string filename\" \"%s.exr\"\nPixelFilter \"box\"\nSampler \"independent\" "
        "\"integer pixelsamples\" 1024\nIntegrator \"path\" \"integer maxdepth\" %d\n",
        s.width, s.height, name.c_str(), s.max_depth);
    size_t look_at = text.find("LookAt "), until = text.find("Camera", look_at);
    small.pbrt = "# " + known.what + "\n" + film + text.substr(look_at, until - look_at - 1) +
                 "\nCamera \"perspective\" \"float fov\" " + number(double{s.camera.fov}) +
                 "\nWorldBegin\n";
    std::vector<Object> objects = objects_of(s);
    auto add_objects_of = [&](int light) {
        for (const Object& o : objects)
            if (s.shapes[o.shape].light == light) add_object(s, o, small);
    };
    for (size_t i = 0; i < s.lights.size(); i++) {
        if (s.lights[i].type == LightType::infinite) {
            small.pbrt += "LightSource \"infinite\" \"rgb L\" [" + triple(s.lights[i].L) + "]\n";
        }
        add_objects_of(static_cast<int>(i));
    }
    add_objects_of(-1);
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
