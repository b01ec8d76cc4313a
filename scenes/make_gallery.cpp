// Writes the six scenes of the gallery and their meshes into a folder.
// usage: make_gallery FOLDER
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <sstream>

#include "common/path/sampler.h"
#include "common/picture/image.h"
#include "scenes/grid_ply.h"

namespace {

struct Random {
    Sampler sampler{SamplerType::independent, 1, 1};
    explicit Random(uint32_t stream) { sampler.start(0, stream); }
    double operator()(double low, double high) { return low + (high - low) * double{sampler.u1()}; }
};

/// Each ' in it becomes a ".
template <typename... Args>
std::string format(const char* pattern, Args... args) {
    char text[2000] = "";
    if constexpr (sizeof...(args) == 0)
        std::snprintf(text, sizeof text, "%s", pattern);
    else
        std::snprintf(text, sizeof text, pattern, args...);
    std::replace(text, text + sizeof text, '\'', '"');
    return text;
}

/// The text of one scene. Numbers stand for parts of it in the order that add() says.
class Scene {
public:
    Scene(const std::string& folder, const std::string& name, int depth, const char* eye_and_point,
          const char* fov)
        : file_(folder + '/' + name + ".pbrt") {
        text_ = format(
            "# Written by make_gallery.cpp.\nFilm 'rgb' 'integer xresolution' [1280] 'integer "
            "yresolution' [720]\nPixelFilter 'box'\nSampler 'independent' 'integer pixelsamples' "
            "[64]\nIntegrator 'path' 'integer maxdepth' [%d]\nLookAt %s  0 1 0\nCamera "
            "'perspective' "
            "'float fov' %s\nWorldBegin\n",
            depth, eye_and_point, fov);
    }
    ~Scene() { write_file_atomically(file_, text_); }

    /// Adds parts, such as "lamp R G B; box X0 Y0 Z0 X1 Y1 Z1 DEGREES; off". What stands between
    /// lamp and off shines. A patch is a corner and two edges a, b, with its front on the side of a
    /// x b.
    template <typename... Args>
    void operator()(const char* pattern, Args... args) {
        std::istringstream all(format(pattern, args...));
        for (std::string part; std::getline(all, part, ';');) add(part);
    }

private:
    void add(const std::string& part) {
        static const std::map<std::string, const char*> patterns = {
            {"diffuse", "Material 'diffuse' 'rgb reflectance' [%g %g %g]"},
            {"metal", "Material 'conductor' 'rgb reflectance' [%g %g %g] 'float roughness' [%g]"},
            {"glass", "Material 'dielectric' 'float eta' [%g]"},
            {"checkered",
             "Texture 't@' 'spectrum' 'checkerboard' 'float uscale' [%g] 'float vscale' [%g] 'rgb "
             "tex1' [%g %g %g] 'rgb tex2' [%g %g %g]\nMaterial 'diffuse' 'texture reflectance' "
             "'t@'"},
            {"ball",
             "AttributeBegin Translate %g %g %g Shape 'sphere' 'float radius' [%g] AttributeEnd"},
            {"lamp",
             "AttributeBegin AreaLightSource 'diffuse' 'rgb L' [%g %g %g] Material 'diffuse' 'rgb "
             "reflectance' [0 0 0]"},
            {"off", "AttributeEnd"}};
        std::istringstream words(part);
        std::string what, name, line = part;
        words >> what;
        if (what == "mesh") words >> name;
        std::array<double, 9> a = {};
        for (double& x : a) words >> x;
        if (auto found = patterns.find(what); found != patterns.end()) {
            line = format(found->second, a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]);
            for (size_t at; (at = line.find('@')) != line.npos;)
                line.replace(at, 1, std::to_string(text_.size()));
        } else if (what == "box") {
            line = format(
                "AttributeBegin Translate %g %g %g Rotate %g 0 1 0 Scale %g %g %g Shape "
                "'trianglemesh' 'point3 P' [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1  -1 1 -1  1 1 -1  1 "
                "1 1  -1 1 1] 'integer indices' [4 7 6 4 6 5  0 4 5 0 5 1  1 5 6 1 6 2  2 6 7 2 7 "
                "3  3 7 4 3 4 0  0 1 2 0 2 3] AttributeEnd",
                (a[0] + a[3]) / 2, (a[1] + a[4]) / 2, (a[2] + a[5]) / 2, a[6], (a[3] - a[0]) / 2,
                (a[4] - a[1]) / 2, (a[5] - a[2]) / 2);
        } else if (what == "patch") {
            line = format(
                "Shape 'trianglemesh' 'integer indices' [0 1 2 0 2 3] 'point2 uv' [0 0 1 0 1 1 0 "
                "1] 'point3 P' [%g %g %g  %g %g %g  %g %g %g  %g %g %g]",
                a[0], a[1], a[2], a[0] + a[3], a[1] + a[4], a[2] + a[5], a[0] + a[3] + a[6],
                a[1] + a[4] + a[7], a[2] + a[5] + a[8], a[0] + a[6], a[1] + a[7], a[2] + a[8]);
        } else if (what == "mesh") {
            line = format(
                "AttributeBegin Translate %g %g %g Rotate %g 0 1 0 Rotate %g 0 0 1 Scale %g %g %g "
                "Shape 'plymesh' 'string filename' '%s.ply' AttributeEnd",
                a[0], a[1], a[2], a[4], a[5], a[3], a[3], a[3], name.c_str());
        }
        text_ += line + '\n';
    }

    std::string file_, text_;
};

using Profile = std::vector<std::array<double, 2>>;  // radius and height, from below
/// The point of a smooth curve through the profile (Catmull and Rom's), and its direction.
std::array<double, 4> on_curve(const Profile& p, double t) {
    size_t i = std::min(static_cast<size_t>(t), p.size() - 2);
    double s = t - static_cast<double>(i);
    std::array<double, 4> result = {};
    for (size_t k = 0; k < 2; k++) {
        double a = p[i > 0 ? i - 1 : 0][k], b = p[i][k], c = p[i + 1][k];
        double d = p[std::min(i + 2, p.size() - 1)][k];
        double m0 = (c - a) / 2, m1 = (d - b) / 2;
        result[k] = b + s * (m0 + s * (3 * (c - b) - 2 * m0 - m1 + s * (2 * (b - c) + m0 + m1)));
        result[k + 2] =
            m0 + s * (2 * (3 * (c - b) - 2 * m0 - m1) + 3 * s * (2 * (b - c) + m0 + m1));
    }
    return result;
}

/// Turns a profile around the y axis; its outside is on the right of the way along it.
void lathe(const std::string& folder, const std::string& name, const std::string& text) {
    std::istringstream numbers(text);
    Profile profile;
    for (std::array<double, 2> p; numbers >> p[0] >> p[1]; numbers.ignore(1)) profile.push_back(p);
    constexpr int around = 128, per_segment = 12;
    int rows = per_segment * (static_cast<int>(profile.size()) - 1) + 1;
    auto point_at = [&](int i, int j) {
        auto [r, y, dr, dy] = on_curve(profile, double{1} * i / per_segment);
        double phi = 2 * std::numbers::pi * (j % around) / around, c = std::cos(phi);
        Vec3d p = {std::max(r, 1e-5) * c, y, std::max(r, 1e-5) * std::sin(phi)};
        Vec3d n = {dy * c, -dr, dy * std::sin(phi)};
        if (dr == 0 && dy == 0) n = {0, r < 1e-3 && i > 0 ? 1.0 : -1.0, 0};
        return GridPoint{to_vec3(p), to_vec3(normalize(n))};
    };
    write_file_atomically(folder + '/' + name + ".ply",
                          grid_ply(rows, around + 1, false, point_at));
}

/// A field of hills: the heights over a rectangle of the ground.
template <class Height>
void field(const std::string& folder, const std::string& name, double x0, double z0, double x1,
           double z1, int cells, const Height& height) {
    auto point_at = [&](int i, int j) {
        double x = x0 + (x1 - x0) * i / cells, z = z0 + (z1 - z0) * j / cells, e = 1e-3;
        double dx = (height(x + e, z) - height(x - e, z)) / (2 * e);
        double dz = (height(x, z + e) - height(x, z - e)) / (2 * e);
        return GridPoint{to_vec3(Vec3d{x, height(x, z), z}),
                         to_vec3(normalize(Vec3d{-dx, 1, -dz}))};
    };
    write_file_atomically(folder + '/' + name + ".ply",
                          grid_ply(cells + 1, cells + 1, false, point_at));
}

void room(const std::string& folder) {
    Scene s(folder, "room", 12, "1.5 1.45 -2.8  -0.5 0.95 1.2", "58");
    Random random(1);
    s("checkered 1 24 .55 .37 .22 .47 .3 .17; patch -3 0 -3  0 0 5.5  6 0 0; diffuse .85 .83 .8");
    s("patch -3 2.7 -3  6 0 0  0 0 5.5; patch -3 0 2.5  0 2.7 0  6 0 0");
    s("patch 3 0 -3  0 0 5.5  0 2.7 0; patch -3 0 -3  6 0 0  0 2.7 0");
    s("box -3.2 0 -3 -3 .7 2.5; box -3.2 2.35 -3 -3 2.7 2.5; box -3.2 .7 -3 -3 2.35 -.6");
    s("box -3.2 .7 1.6 -3 2.35 2.5; diffuse .3 .3 .3");
    for (double z : {-0.6, 0.13, 0.86, 1.56}) s("box -3.15 .7 %g -3.05 2.35 %g", z, z + 0.05);
    for (double y : {0.68, 1.5, 2.3}) s("box -3.15 %g -.6 -3.05 %g 1.6", y, y + 0.05);
    // The sun and the sky; the lower panes are frosted.
    s("lamp 28000 22000 15000; ball -20 12.5 -4 .5; off; lamp 3.2 4 5");
    s("patch -3.1 .7 -.6  0 .8 0  0 0 2.2; off; LightSource 'infinite' 'rgb L' [1.2 1.6 2.2]");
    // A table with a vase and fruit, and two chairs.
    auto legs = [&](double x0, double z0, double x1, double z1, double height, double width) {
        for (double x : {x0, x1 - width})
            for (double z : {z0, z1 - width})
                s("box %g 0 %g %g %g %g", x, z, x + width, height, z + width);
    };
    s("diffuse .5 .3 .16; box -1.5 .7 .2 .3 .75 1.2");
    legs(-1.45, 0.25, 0.25, 1.15, 0.7, 0.06);
    s("diffuse .16 .25 .3");
    for (double x : {-1.3, -0.3}) {
        s("box %g .42 -.35 %g .47 .07; box %g .47 -.35 %g .92 -.31", x, x + 0.42, x, x + 0.42);
        legs(x, -0.35, x + 0.42, 0.07, 0.42, 0.04);
    }
    s("metal .75 .45 .3 0; mesh vase -1 .75 .8 .32");
    for (int i = 0; i < 5; i++) {
        s("diffuse .75 %g .08; ball %g .795 %g .045", random(0.25, 0.5), -0.3 + 0.1 * (i % 3),
          0.5 + 0.09 * (i / 3) + 0.05 * (i % 3));
    }
    // A shelf of books, a picture, a rug and a bench.
    s("diffuse .62 .5 .36; box .68 0 2.15 .71 2.08 2.5; box 2.7 0 2.15 2.73 2.08 2.5");
    for (double y = 0.35; y < 2.1; y += 0.42) s("box .7 %g 2.15 2.7 %g 2.5", y, y + 0.03);
    for (double y = 0.38; y < 1.8; y += 0.42) {
        for (double x = 0.74, width = 0; x < 2.6; x += width + 0.003) {
            double tint = random(0, 1), grey = random(0.1, 0.5);
            width = random(0.02, 0.06);
            s("diffuse %g %g %g; box %g %g 2.2 %g %g 2.45", grey + 0.3 * tint, grey,
              grey + 0.25 * (1 - tint), x, y, x + width, y + random(0.2, 0.34));
        }
    }
    s("diffuse .1 .08 .06; box -1.4 1.25 2.46 -.2 2.05 2.5; checkered 6 4 .8 .6 .25 .2 .4 .5");
    s("patch -1.35 1.3 2.455  0 .7 0  1.1 0 0; diffuse .6 .3 .22; box -2.2 0 -1.2 1.2 .012 1.9");
    s("diffuse .55 .52 .45; box -2.7 0 1.9 -.3 .42 2.45; box -2.7 .42 2.3 -.3 .8 2.45");
}

void pool(const std::string& folder) {
    field(folder, "water", -3, -3, 3, 3, 160, [](double x, double z) {
        return .022 * std::sin(3.1 * x + 2.3 * z) + .016 * std::sin(4.9 * z - 2.2 * x + 1.7) +
               .010 * std::sin(6.7 * x - 3.9 * z + 4.1) + .006 * std::sin(8.1 * x + 7.3 * z + 2.2) +
               .004 * std::sin(9.7 * z - 11 * x + .6);
    });
    Scene s(folder, "pool", 8, "-0.4 3.3 -5.3  0.1 -0.7 0", "40");
    Random random(2);
    s("checkered 15 15 .85 .9 .9 .4 .68 .78; patch -3 -1.5 -3  0 0 6  6 0 0");
    s("checkered 15 4.25 .8 .85 .85 .3 .55 .7; patch -3 -1.5 3  0 1.7 0  6 0 0");
    s("checkered 4.25 15 .8 .85 .85 .3 .55 .7; patch 3 -1.5 -3  0 1.7 0  0 0 6");
    s("patch -3 -1.5 -3  0 1.7 0  0 0 6; diffuse .5 .42 .33; box -9 0 3 9 .2 12");
    s("box -9 0 -9 -3 .2 3; box 3 0 -9 9 .2 3; box -3 0 -9 3 .2 -3");
    s("diffuse .66 .34 .2; mesh vase -.9 -1.27 .9 1.15 35 83");
    for (int i = 0; i < 60; i++) {
        double grey = random(0.2, 0.75), r = random(0.04, 0.13);
        double x = random(-2.6, 2.6), z = random(-2, 2.7);
        s("diffuse %g %g %g; ball %g %g %g %g", grey, 0.9 * grey, 0.8 * grey, x, r - 1.5, z, r);
    }
    s("diffuse .8 .2 .15; ball 1.35 .22 .9 .42; diffuse .9 .75 .2; ball .1 -1.1 -.6 .4");
    s("glass 1.33; mesh water 0 0 0 1; lamp 13000 11700 9700; patch -2.05 6 2.15 .1 0 0  0 0 .1");
    s("off; lamp .8 1 1.3; patch -4 6.5 -4  8 0 0  0 0 8; off");
}

/// A sunset: longitude over latitude, the zenith on top.
Image evening() {
    Image sky(512, 256);
    const Vec3d sun = normalize(Vec3d{-0.55, 0.16, 1});
    for (int j = 0; j < sky.height; j++) {
        for (int i = 0; i < sky.width; i++) {
            double theta = double{pi} * (j + 0.5) / 256, phi = double{pi} * (i + 0.5) / 256;
            double up = std::cos(theta), x = std::sin(theta) * std::cos(phi);
            double z = -std::sin(theta) * std::sin(phi), h = std::max(0.0, up);
            double near = std::pow(std::max(0.0, dot({x, up, z}, sun)), 8);
            double clouds = 0, d = h + 0.12;
            for (double k = 3; k < 60; k *= 1.9)
                clouds += std::sin(k * x / d + 2 * k) * std::sin(k * z / d + k * k) / std::sqrt(k);
            float c = static_cast<float>(std::clamp(0.5 * clouds, 0.0, 1.0) * std::min(1.0, 6 * h));
            float glow = static_cast<float>(near), low = static_cast<float>(std::exp(-5 * h));
            Rgb L = (1 - low) * Rgb{0.12f, 0.2f, 0.45f} + low * Rgb{0.9f, 0.5f, 0.35f} +
                    glow * Rgb{1.6f, 0.8f, 0.3f};
            L = 0.75f * ((1 - 0.7f * c) * L + 0.7f * c * (0.5f + glow) * Rgb{1.1f, 0.7f, 0.6f});
            if (near > std::pow(std::cos(0.025), 8)) L = {1500, 950, 500};
            sky.at(i, j) = up < 0 ? Rgb{0.1f, 0.08f, 0.07f} : L;
        }
    }
    return sky;
}

void hills(const std::string& folder) {
    field(folder, "hills", -130, -10, 130, 140, 500, [](double x, double z) {
        double far = std::clamp((z - 4) / 40, 0.0, 1.0);
        return far * (3.2 * std::sin(0.11 * x + 0.4) * std::sin(0.13 * z) +
                      1.3 * std::sin(0.31 * x + 0.23 * z) + 0.3 * std::sin(1.1 * x - 0.7 * z)) +
               0.03 * std::sin(1.9 * x + 0.6) * std::sin(2.3 * z) - 0.03;
    });
    write_image(folder + "/evening.pfm", evening(), "");
    for (std::string name : {"hills", "hills-plain"}) {
        Scene s(folder, name, 8, "-1.2 1.5 -6.2  0.35 1.45 0", "38");
        Random random(3);
        s(name == "hills" ? "AttributeBegin Rotate -90 1 0 0 LightSource 'infinite' 'string "
                            "filename' 'evening.pfm' AttributeEnd"
                          : "LightSource 'infinite' 'rgb L' [0.45 0.38 0.38]");
        s("diffuse .28 .3 .14; mesh hills 0 0 0 1; diffuse .5 .47 .42; metal .95 .65 .35 .02");
        s("mesh knot 0 1.62 0 .5 65 90; diffuse .5 .47 .42; box -.75 0 -.75 .75 .16 .75 20");
        s("box -.6 .16 -.6 .6 .75 .6 20; diffuse .6 .3 .2; mesh vase 1.55 0 -.6 .75");
        for (int i = 0; i < 90; i++) {
            double grey = random(0.15, 0.6), r = random(0.03, 0.16);
            double x = random(-5, 6), z = random(-3, 9);
            s("diffuse %g %g %g; ball %g %g %g %g", grey, grey, 0.9 * grey, x, 0.6 * r, z, r);
        }
    }
}

void harbor(const std::string& folder) {
    auto height = [](double x, double z) {
        double up = std::clamp((z - 12) / 30, 0.0, 1.0);
        return up * up * (9 + 4 * std::sin(0.11 * x + 1) + 2 * std::sin(0.23 * x + 0.2 * z)) +
               std::clamp((z - 10.5) / 1.5, -1.0, 1.0) * 0.4;
    };
    field(folder, "shore", -60, 6, 60, 70, 240, height);
    Scene s(folder, "harbor", 6, "0 3.2 -9  0 3.4 20", "38");
    Random random(4);
    s("LightSource 'infinite' 'rgb L' [.006 .009 .022]; metal .5 .55 .6 .0012");
    s("patch -80 0 -30  0 0 60  160 0 0; diffuse .16 .17 .13; mesh shore 0 0 0 1");
    for (int i = 0; i < 330; i++) {
        double z = 12 + 27 * std::pow(random(0, 1), 0.8);
        double x = random(-0.75, 0.75) * (z + 9), y = height(x, z);
        double w = random(0.5, 0.9), h = random(0.9, 1.9);
        double grey = random(0.3, 0.7);
        s("diffuse %g %g %g; box %g %g %g %g %g %g", grey, 0.9 * grey, 0.75 * grey, x - w, y - 2,
          z - w, x + w, y + h, z + w);
        s("diffuse .4 .18 .12; box %g %g %g %g %g %g", x - w - 0.1, y + h, z - w - 0.1, x + w + 0.1,
          y + h + 0.14, z + w + 0.1);
        for (int window = 0; window < 4; window++) {
            if (random(0, 1) < 0.45) continue;
            double blue = random(0.05, 0.8), L = random(0.7, 4);
            s("lamp %g %g %g; patch %g %g %g  0 %g 0  %g 0 0; off", L, L * (0.5 + 0.35 * blue),
              L * blue * 0.7, x - w * 0.75 + 0.8 * w * (window % 2),
              y + h * (0.15 + 0.45 * (window / 2)), z - w - 0.01, 0.27 * h, 0.6 * w);
        }
    }
    // A quay with its lamps, and boats.
    s("diffuse .4 .38 .36; box -60 -1 10.2 60 .45 11.2");
    for (double x = -15; x <= 15; x += 2.5) {
        s("diffuse .1 .1 .1; box %g .4 10.4 %g 2 10.46; lamp 90 62 30; ball %g 2.08 10.43 .09; off",
          x - 0.03, x + 0.03, x);
    }
    for (int i = 0; i < 9; i++) {
        double x = -11 + 2.8 * i + random(-0.8, 0.8), z = random(5, 9.5);
        double turn = random(-40, 40), tint = random(0.1, 0.6);
        s("diffuse %g .3 %g; box %g -.1 %g %g .22 %g %g; diffuse .7 .7 .68", tint, 0.6 - tint,
          x - 0.8, z - 0.25, x + 0.8, z + 0.25, turn);
        s("box %g .22 %g %g .5 %g %g; box %g .2 %g %g 2.2 %g", x - 0.3, z - 0.18, x + 0.2, z + 0.18,
          turn, x - 0.02, z - 0.02, x + 0.02, z + 0.02);
        s("lamp 60 %d %d; ball %g 2.25 %g .05; off", i % 3 == 0 ? 10 : 50, i % 3 == 1 ? 10 : 30, x,
          z);
    }
}

void chess(const std::string& folder) {
    const std::string foot = "0 0, .3 0, .33 .04, .32 .1, .24 .16, .26 .2, ";
    lathe(folder, "pawn", foot + ".15 .32, .1 .5, .18 .56, .12 .6, .19 .72, .13 .85, 0 .9");
    lathe(folder, "rook", foot + ".19 .35, .17 .7, .25 .78, .25 1, .18 1, .17 .92, 0 .92");
    lathe(folder, "bishop",
          foot + ".15 .4, .1 .8, .19 .86, .12 .9, .17 1.05, .1 1.22, .04 1.3, 0 1.36");
    lathe(folder, "queen",
          foot + ".16 .45, .11 1, .2 1.07, .13 1.12, .22 1.4, .16 1.42, .05 1.5, 0 1.6");
    for (std::string name : {"chess", "chess-pinhole"}) {
        const char* lens =
            name == "chess" ? "30 'float lensradius' .11 'float focaldistance' 6.8" : "30";
        Scene s(folder, name, 10, "-3.3 2.2 -6.6  0.1 0.45 -0.6", lens);
        Random random(5);
        s("diffuse .2 .1 .05; box -4.5 -.3 -4.5 4.5 -.005 4.5; checkered 8 8 .62 .5 .36 .12 .07 "
          ".05");
        s("patch -4 0 -4  0 0 8  8 0 0; diffuse .05 .05 .06; patch -60 -1 -20  0 0 90  120 0 0");
        for (bool black : {false, true}) {
            s(black ? "diffuse .1 .035 .025" : "metal .9 .75 .5 .015");
            for (int i = 0; i < 8; i++) {
                const char* pieces[] = {"rook", "bishop", "bishop", "queen"};
                int steps = i == (black ? 4 : 3) ? 2 : i == (black ? 2 : 5) ? 1 : 0;
                double row = black ? 2.5 - steps : steps - 2.5;
                s("mesh %s %g 0 %g 1.15; mesh pawn %g 0 %g 1.15", pieces[std::min(i, 7 - i)],
                  i - 3.5, black ? 3.5 : -3.5, i - 3.5, row);
            }
        }
        s("lamp 30 27 22; Translate -5 7 -4 Rotate -42 1 0 -1.2; patch -1.5 0 -1.5  3 0 0  0 0 3");
        s("off; lamp 1.5 2 3; patch -9 -1 0  0 5 0  0 0 9; off");
        for (int i = 0; i < 110; i++) {
            double hue = random(0, 1), L = random(2, 8);
            double x = random(-1, 29), y = random(-0.6, 6);
            double z = random(16, 30), r = random(0.15, 0.3);
            s("lamp %g %g %g; ball %g %g %g %g; off", L, L * (0.35 + 0.5 * hue), L * hue * hue, x,
              y, z, r);
        }
    }
}

void still_life(const std::string& folder) {
    lathe(folder, "wineglass",
          "0 0, .36 0, .37 .02, .2 .05, .05 .12, .04 .3, .04 .6, .08 .72, .3 .9, .4 1.2, .34 1.7, "
          ".32 1.72, .3 1.7, .365 1.2, .27 .94, .1 .82, 0 .8");
    lathe(folder, "bottle",
          "0 .05, .3 0, .4 .04, .42 .2, .42 1, .4 1.35, .2 1.7, .14 1.9, .14 2.3, .13 2.35, .11 "
          "2.3, .11 1.9, .17 1.68, .36 1.33, .38 1, .38 .2, .34 .1, 0 .12");
    Scene s(folder, "glass", 14, "0.2 2 -6.1  0.1 1 0", "30");
    Random random(6);
    s("checkered 1 9 .5 .34 .2 .42 .27 .15; patch -6 0 -4  0 0 8  12 0 0; diffuse .45 .47 .5");
    s("patch -8 -1 3  0 8 0  16 0 0; glass 1.5; mesh bottle -.95 .001 .6 1");
    s("mesh wineglass .35 .001 -.2 1; mesh wineglass 1.35 .001 .7 1; ball -.45 .331 -.9 .33");
    s("metal .95 .93 .88 0; mesh vase 2.1 0 1.2 .75; diffuse .8 .38 .06; ball -1.7 .3 -.5 .3");
    s("diffuse .8 .32 .06; ball -2.15 .29 .2 .29; diffuse .8 .43 .06; ball 1.35 .27 -.75 .27");
    for (int i = 0; i < 22; i++) {
        double x = random(0.75, 1.25), z = random(-1.3, -0.9);
        s("diffuse .25 .05 .2; ball %g %g %g .09", x, 0.09 + 0.14 * (i % 2), z);
    }
    s("lamp 240 210 165; Translate -4 5 -1.5 Rotate 40 0 0 1; patch -.3 0 -.3  .6 0 0  0 0 .6");
    s("off; lamp 1.2 1.4 1.8; patch 5 0 -5  0 0 6  0 5 0; off");
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        std::string folder;
        parse_options(argc, argv, "FOLDER", "Writes the scenes of the gallery.", {},
                      [&](const std::string& word) { folder = word; });
        if (folder.empty()) throw UsageError("error: a folder is needed");
        std::filesystem::create_directories(folder);
        lathe(folder, "vase",
              "0 0, .25 0, .28 .05, .45 .4, .42 .75, .2 1, .17 1.15, .25 1.25, .23 1.26, .14 1.15, "
              ".17 1, .38 .75, .4 .4, .2 .06, 0 .05");
        for (auto* write : {room, pool, hills, harbor, chess, still_life}) write(folder);
        return 0;
    });
}
