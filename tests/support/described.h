// Helpers of the tests of the scene reader: scenes in short, and in words what was read from them.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "common/render/options.h"
#include "common/scene_file/reader.h"

/// Text with ' for each ", as rows of tables are written.
inline std::string unquoted(std::string text) {
    std::replace(text.begin(), text.end(), '\'', '"');
    return text;
}

/// Reads a scene with ' for ", of which only the world matters: its sky and disk come first.
inline Scene read_world(const std::string& text, std::vector<std::string>* notes = nullptr,
                        const Limits& limits = {}) {
    const std::string start =
        "Camera 'perspective' WorldBegin LightSource 'infinite' Shape 'disk'\n";
    return parse_scene("scene.pbrt", unquoted(start + text), notes, {}, limits);
}

/// The numbers to five digits, and 0 for less than 0.00001.
inline std::string in_words(std::initializer_list<double> numbers) {
    std::string text;
    for (double x : numbers) text += " " + digits(std::abs(x) < 1e-5 ? 0 : x);
    return text.substr(1);
}
inline std::string in_words(Vec3 v) { return in_words({v.x, v.y, v.z}); }
inline std::string in_words(Rgb c) { return in_words({c.r, c.g, c.b}); }

/// The normal of a triangle, by the order of its corners; as long as twice its area.
inline Vec3 normal_of(const Geometry& g, const Triangle& t) {
    Vec3 p = g.positions[t.v[0]];
    return cross(g.positions[t.v[1]] - p, g.positions[t.v[2]] - p);
}

inline std::string in_words(const Scene& scene, uint32_t shape) {
    const Shape& s = scene.shapes[shape];
    const Material& m = scene.materials[s.material];
    std::string text =
        m.type == MaterialType::diffuse ? " " + in_words(m.reflectance)
        : m.type == MaterialType::conductor
            ? " metal " + in_words(m.eta) + ", " + in_words(m.k) + ", " + in_words({m.alpha})
            : " glass " + in_words({m.ior});
    return text + (s.reverse ? " reversed" : "") +
           (s.light < 0 ? "" : " light " + std::to_string(s.light)) + '\n';
}

/// A line for each triangle, sphere, disk and light: where it is, and how it looks.
inline std::string in_words(const Scene& scene) {
    const Geometry& g = scene.geometry;
    std::string text;
    for (const Triangle& t : g.triangles) {
        text += "triangle";
        for (uint32_t v : t.v) {
            text += " " + in_words(g.positions[v]);
            if (!g.normals.empty()) text += " (" + in_words(g.normals[v]) + ")";
        }
        text += in_words(scene, t.shape);
    }
    for (const Sphere& s : g.spheres)
        text += "sphere " + in_words(s.c) + ", " + in_words({s.r}) + in_words(scene, s.shape);
    for (const Disk& d : g.disks)
        text += "disk " + in_words(d.c) + ", " + in_words(d.n) + ", " + in_words({d.r}) +
                in_words(scene, d.shape);
    for (const Light& l : scene.lights) {
        constexpr const char* types[] = {"area", "point", "distant", "infinite"};
        text += std::string(types[static_cast<size_t>(l.type)]) + " " + in_words(l.L);
        if (l.type == LightType::point || l.type == LightType::distant)
            text += ", " + in_words(l.p);
        if (l.type == LightType::area)
            text += (l.two_sided ? ", both sides of " : ", ") + std::to_string(l.prims) + " from " +
                    std::to_string(l.first_prim);
        text += '\n';
    }
    return text;
}

/// The size, samples, depth, field of view, place and axes; lens, frame and window where they are.
inline std::string settings_of(const Scene& s) {
    const Camera& c = s.camera;
    std::string text = std::to_string(s.width) + 'x' + std::to_string(s.height) + ' ' +
                       in_words({double(s.spp), double(s.max_depth), double{c.fov}}) + " at " +
                       in_words(c.o) + ", " + in_words(c.right) + ", " + in_words(c.up) + ", " +
                       in_words(c.forward);
    if (c.lens_radius > 0) text += ", lens " + in_words({c.lens_radius, c.focal_distance});
    if (c.frame_aspect) text += ", frame " + in_words({*c.frame_aspect});
    if (c.screen_window) {
        auto [x0, x1, y0, y1] = *c.screen_window;
        text += ", window " + in_words({x0, x1, y0, y1});
    }
    return text;
}

struct MalformedCase {
    std::string input, message;
    bool in_world = false;  // a scene: stands behind the first line of a world
};

/// Reads a table: lines up to one that starts with => are the input, the rest of that line is the
/// message, and so are the lines after it that start with => too. Lines that start with ## are for
/// the reader; [world] stands before inputs for a world.
inline std::vector<MalformedCase> read_malformed_cases(const std::string& path) {
    std::vector<MalformedCase> cases;
    std::string text = read_file(path);
    MalformedCase next;
    bool more = false;  // of the last message
    for (size_t start = 0; start < text.size();) {
        size_t end = text.find('\n', start);
        std::string line = text.substr(start, end - start);
        start = end + 1;
        if (line.starts_with("##") || line.empty()) continue;
        if (line.starts_with("=> ") && more) {
            cases.back().message += '\n' + line.substr(3);
            continue;
        }
        more = line.starts_with("=> ");
        if (line == "[world]") {
            next.in_world = true;
        } else if (line.starts_with("=> ")) {
            next.message = line.substr(3);
            cases.push_back(next);
            next.input.clear();
        } else {
            next.input += line + '\n';
        }
    }
    return cases;
}
