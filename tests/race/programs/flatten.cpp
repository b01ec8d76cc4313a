// flatten SCENE: prints a scene as JSON, in world space, for scripts that build it in another
// renderer.
#include <cstdio>

#include "common/base/error.h"
#include "common/render/options.h"
#include "common/scene/mover.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"

namespace {

std::string text(const char* pattern, auto... values) {
    char out[1000];
    std::snprintf(out, sizeof out, pattern, values...);
    return out;
}
std::string text(Vec3 v) { return text("[%.9g,%.9g,%.9g]", double{v.x}, double{v.y}, double{v.z}); }
std::string text(Rgb c) { return text(Vec3{c.r, c.g, c.b}); }
const char* text(bool yes) { return yes ? "true" : "false"; }

/// Prints a list, one thing in a line.
template <typename T, typename Text>
void print(const char* name, const std::vector<T>& all, const Text& text_of) {
    std::printf(",\n\"%s\": [", name);
    for (size_t i = 0; i < all.size(); i++)
        std::printf("%s\n%s", i > 0 ? "," : "", text_of(all[i]).c_str());
    std::printf("]");
}

/// Throws InputError for the first thing that no script translates.
void refuse_more_than_is_told(const Scene& scene) {
    auto refuse = [&](bool found, const char* what) {
        if (found) throw InputError(scene.origin->file + ": not translated: " + what);
    };
    refuse(scene.textures != nullptr, "a texture");
    refuse(scene.sky_image != nullptr, "the image of a sky");
    refuse(!scene.movers.empty(), "a shape that moves");
    refuse(scene.camera.frame_aspect || scene.camera.screen_window, "a frame of the camera");
    refuse(!scene.geometry.disks.empty(), "a disk");
    for (const Light& light : scene.lights)
        refuse(light.type != LightType::area && light.type != LightType::infinite,
               "a light without a size");
    for (const Material& m : scene.materials) refuse(m.glass != nullptr, "glass that disperses");
}

void print(const Scene& scene) {
    const Camera& c = scene.camera;
    const Geometry& g = scene.geometry;
    double unit = std::sqrt(double{dot(c.right, c.right)});
    std::printf(
        "{\"camera\": {\"o\": %s, \"right\": %s, \"up\": %s, \"forward\": %s, \"fov\": %.9g, "
        "\"lens\": %.9g, \"focus\": %.9g}",
        text(c.o).c_str(), text(c.right).c_str(), text(c.up).c_str(), text(c.forward).c_str(),
        double{c.fov}, unit * double{c.lens_radius}, unit * double{c.focal_distance});
    print("materials", scene.materials, [](const Material& m) {
        const char* types[] = {"diffuse", "conductor", "dielectric"};
        return text(
            R"({"type": "%s", "reflectance": %s, "eta": %s, "k": %s, "alpha": %.9g, "ior": %.9g})",
            types[static_cast<int>(m.type)], text(m.reflectance).c_str(), text(m.eta).c_str(),
            text(m.k).c_str(), double{m.alpha}, double{m.ior});
    });
    print("lights", scene.lights, [](const Light& light) {
        return text(R"({"type": "%s", "L": %s, "two_sided": %s})",
                    light.type == LightType::area ? "area" : "infinite", text(light.L).c_str(),
                    text(light.two_sided));
    });
    print("shapes", scene.shapes, [](const Shape& s) {
        return text(R"({"material": %u, "light": %d, "inward": %s})", s.material, s.light,
                    text(s.reverse));
    });
    print("positions", g.positions, [](Vec3 p) { return text(p); });
    print("normals", g.normals, [](Vec3 n) { return text(n); });
    print("triangles", g.triangles,
          [](const Triangle& t) { return text("[%u,%u,%u,%u]", t.v[0], t.v[1], t.v[2], t.shape); });
    print("spheres", g.spheres, [](const Sphere& s) {
        return text(R"({"c": %s, "r": %.9g, "shape": %u})", text(s.c).c_str(), double{s.r},
                    s.shape);
    });
    std::printf("}\n");
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        std::string path;
        parse_options(
            argc, argv, "SCENE",
            "Prints a scene as JSON, in world space, for scripts that build it in another "
            "renderer.",
            {}, [&](const std::string& word) { path = word; });
        if (path.empty()) throw UsageError("error: a scene is needed");
        Scene scene = load_scene(path, nullptr);
        refuse_more_than_is_told(scene);
        print(scene);
        flush_stdout();
        return 0;
    });
}
