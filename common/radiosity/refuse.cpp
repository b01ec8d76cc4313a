#include "common/radiosity/refuse.h"

#include "common/base/position.h"

void refuse(const Scene& scene) {
    for (const Light& light : scene.lights) {
        if (light.type == LightType::area) continue;
        const char* name = light.type == LightType::point     ? "a point light"
                           : light.type == LightType::distant ? "a distant light"
                                                              : "a sky";
        fail(scene.place(light.at), std::string("radiosity knows lamps with a surface alone: ") +
                                        name + " has no patches; chapters from 09 on render it");
    }
    auto refuse_material = [&](uint32_t shape) {
        const Material& m = scene.materials[scene.shapes[shape].material];
        if (m.texture != 0) {
            fail(
                scene.place(m.at),
                "radiosity gives a patch one reflectance, and a texture has many; chapters from 05 "
                "to 25 render it");
        }
        if (m.type == MaterialType::diffuse) return;
        fail(scene.place(m.at), std::string("radiosity knows diffuse surfaces alone (LD*E): ") +
                                    (m.type == MaterialType::dielectric ? "glass"
                                     : m.alpha > 0                      ? "rough metal"
                                                                        : "a mirror") +
                                    " sends light on by direction");
    };
    const Geometry& g = scene.geometry;
    for (const Triangle& t : g.triangles) refuse_material(t.shape);
    for (const Sphere& s : g.spheres) refuse_material(s.shape);
    for (const Disk& d : g.disks) refuse_material(d.shape);
}
