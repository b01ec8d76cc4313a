// Textures: their values, where they lie on each shape, and what the reader makes of them.
#include <doctest/doctest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/geometry/shapes.h"
#include "common/material/metal.h"
#include "common/picture/image.h"
#include "common/scene/intersect.h"
#include "tests/support/folder.h"
#include "tests/support/scenes.h"

namespace {

using Wrap = Texture::Wrap;

/// The green channel of the picture at (s, t), as its definition says: each texel, those beside the
/// picture too, weighs as much as a tent of two texels' width around its middle is high there.
double yardstick(const TexturePicture& picture, Wrap wrap, bool nearest, double s, double t) {
    double x = s * picture.width, y = (1 - t) * picture.height, sum = 0;
    auto weight = [&](double from_middle) {
        return nearest ? double(std::abs(from_middle) < 0.5)
                       : std::max(0.0, 1 - std::abs(from_middle));
    };
    auto inside = [&](long i, long n) {
        while (wrap == Wrap::repeat && i < 0) i += n;
        while (wrap == Wrap::repeat && i >= n) i -= n;
        return wrap == Wrap::clamp ? std::min(std::max(i, 0L), n - 1) : i;
    };
    for (long j = std::lround(y) - 2; j <= std::lround(y) + 2; j++) {
        for (long i = std::lround(x) - 2; i <= std::lround(x) + 2; i++) {
            long column = inside(i, picture.width), row = inside(j, picture.height);
            if (column < 0 || column >= picture.width || row < 0 || row >= picture.height) continue;
            size_t texel = static_cast<size_t>(row * picture.width + column);
            sum += weight(x - static_cast<double>(i) - 0.5) *
                   weight(y - static_cast<double>(j) - 0.5) * double{picture.texels[texel].g};
        }
    }
    return sum;
}

/// Four texels of four colours, seen as they lie in the file.
constexpr Rgb red = {1, 0, 0}, green = {0, 1, 0}, blue = {0, 0, 1}, white = {1, 1, 1};
Image four_corners() {
    Image image(2, 2);
    image.pixels = {red, green, blue, white};
    return image;
}

/// A scene in a folder of its own, with a picture beside it.
struct Gallery {
    TemporaryFolder folder;
    std::vector<std::string> notes;

    explicit Gallery(const Image& image = four_corners()) {
        write_image(folder / "a.pfm", image, "");
        write_image(folder / "a.png", image, "");
    }
    /// World directives behind the texture "t": the picture, with these parameters.
    Scene scene(const std::string& world,
                const std::string& texture = "\"string filter\" \"point\"",
                const std::string& file = "a.pfm") {
        Scene scene =
            parse_scene(folder / "scene.pbrt",
                        "Camera \"perspective\" WorldBegin LightSource \"infinite\"\n"
                        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" +
                            file + "\" " + texture +
                            "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" + world,
                        &notes);
        prepare(scene, 1);
        return scene;
    }
    std::string error(const std::string& world, const std::string& texture,
                      const std::string& file = "a.pfm") {
        try {
            scene(world, texture, file);
        } catch (const InputError& error) {
            std::string text = error.what(), path = folder / "";
            for (size_t at; (at = text.find(path)) != std::string::npos;) {
                text.erase(at, path.size());
            }
            return text;
        }
        return "no error";
    }
};

const std::string square_with_uv =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 0 1] "
    "\"point3 P\" [0 0 0  1 0 0  1 1 0  0 1 0] ";

/// A hit keeps reflectances to 2e-5.
bool near(double a, double b) { return std::abs(a - b) < 2e-5; }
bool near(Rgb a, Rgb b) {
    return near(double{a.r}, double{b.r}) && near(double{a.g}, double{b.g}) &&
           near(double{a.b}, double{b.b});
}

/// The reflectance where a ray from `from` towards `to` meets the scene.
Rgb seen(const Scene& scene, Vec3 from, Vec3 to) {
    std::optional<Hit> x = intersect(scene, {from, to - from});
    REQUIRE(x);
    return x->material->reflectance;
}

}  // namespace

TEST_SUITE("textures") {
    TEST_CASE("truth: textures as computed in double precision") {
        Sampler random = random_numbers(1);
        double worst = 0;
        for (int run = 0; run < 20000; run++) {
            Textures textures;
            TexturePicture picture;
            picture.width = 1 + static_cast<int>(random.u1() * 7);
            picture.height = 1 + static_cast<int>(random.u1() * 5);
            for (int i = 0; i < picture.width * picture.height; i++) {
                picture.texels.push_back({random.u1(), random.u1(), random.u1()});
            }
            Texture texture;
            texture.kind = Texture::Kind::picture;
            texture.wrap = Wrap{static_cast<uint8_t>(random.u1() * 3)};
            texture.nearest = random.u1() < 0.5f;
            texture.inverted = random.u1() < 0.5f;
            texture.value = {0.7f, 0.7f, 0.7f};
            Vec2 uv = {4 * random.u1() - 2, 4 * random.u1() - 2};
            texture.scale = {2 * random.u1() - 1, 2 * random.u1() - 1};
            texture.shift = {random.u1(), random.u1()};
            textures.all.push_back(texture);
            textures.pictures.push_back(picture);
            double s = double{texture.scale.x} * double{uv.x} + double{texture.shift.x};
            double t = double{texture.scale.y} * double{uv.y} + double{texture.shift.y};
            auto near_an_edge = [](double x) { return std::abs(x - std::round(x)) < 1e-4; };
            if (texture.nearest &&
                (near_an_edge(s * picture.width) || near_an_edge((1 - t) * picture.height))) {
                continue;
            }
            double truth = double{0.7f} * yardstick(picture, texture.wrap, texture.nearest, s, t);
            if (texture.inverted) truth = 1 - truth;
            worst = std::max(worst, std::abs(double{value_at(textures, 0, uv).g} - truth));
        }
        CHECK(worst > 0);
        CHECK(worst < 1e-5);
    }

    TEST_CASE("truth: a picture stands upright on a square, and v grows upwards") {
        Gallery gallery;
        auto check = [&](const Scene& scene, float x, float y, Rgb color) {
            CHECK(near(seen(scene, {x, y, -1}, {x, y, 0}), color));
        };
        Scene plain = gallery.scene(square_with_uv);
        check(plain, 0.25f, 0.75f, red), check(plain, 0.75f, 0.75f, green);
        check(plain, 0.25f, 0.25f, blue), check(plain, 0.75f, 0.25f, white);
        Scene moved = gallery.scene(square_with_uv,
                                    "\"string filter\" \"point\" \"float uscale\" 2 "
                                    "\"float udelta\" 0.5");
        check(moved, 0.1f, 0.75f, green), check(moved, 0.3f, 0.75f, red);
        Scene inverted = gallery.scene(square_with_uv,
                                       "\"string filter\" \"point\" \"bool invert\" true "
                                       "\"float scale\" 0.5");
        check(inverted, 0.25f, 0.75f, {0.5f, 1, 1});
        // The way of chapter 05.
        Ray ray = {{0.25f, 0.75f, -1}, {0, 0, 1}};
        Hit hit;
        make_hit(plain, ray, linear_scan(plain.geometry, ray), hit);
        CHECK(hit.material->reflectance == red);
        // A mirrored mesh, whose corners the reader exchanges, and one that turns while it moves.
        Scene mirrored = gallery.scene("Scale -1 1 1 ReverseOrientation " + square_with_uv);
        check(mirrored, -0.25f, 0.75f, red), check(mirrored, -0.75f, 0.25f, white);
        Scene moving = gallery.scene(
            "ActiveTransform EndTime Translate 2 0 0 ActiveTransform All " + square_with_uv);
        std::optional<Hit> x = intersect(moving, {{1.25f, 0.75f, -1}, {0, 0, 1}, infinity, 0.5f});
        REQUIRE(x);
        CHECK(x->material->reflectance == red);
    }

    TEST_CASE(
        "truth: the picture on a sphere goes around z, and from the lower pole to the upper") {
        Gallery gallery;
        auto check = [&](const std::string& turn, Vec3 x, Vec3 y, Vec3 z) {
            CAPTURE(turn);
            Scene scene =
                gallery.scene("Translate 1 2 3 " + turn + " Shape \"sphere\" \"float radius\" 2");
            auto at = [&](float a, float b, float c) {
                Vec3 d = a * x + b * y + c * z, centre = {1, 2, 3};
                return seen(scene, centre + 20 * d, centre);
            };
            CHECK(at(0.1f, 1, 0.5f) == red);
            CHECK(at(0.1f, -1, 0.5f) == green);
            CHECK(at(-0.1f, 1, -0.5f) == blue);
            CHECK(at(-0.1f, -1, -0.5f) == white);
        };
        check("", {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
        check("Rotate 90 0 1 0", {0, 0, -1}, {0, 1, 0}, {1, 0, 0});
        check("Scale 1 -1 1", {1, 0, 0}, {0, -1, 0}, {0, 0, 1});
        check("Scale 3 3 3", {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    }

    TEST_CASE("truth: the picture on a disk goes around its middle, and from the rim inwards") {
        Gallery gallery;
        auto check = [&](const std::string& turn, Vec3 x, Vec3 y) {
            CAPTURE(turn);
            Scene scene = gallery.scene(turn + " Shape \"disk\" \"float radius\" 2");
            auto at = [&](float a, float b) {
                Vec3 p = a * x + b * y, n = cross(x, y);
                return seen(scene, p + n, p);
            };
            CHECK(at(0.1f, 0.7f) == red);
            CHECK(at(0.1f, -0.7f) == green);
            CHECK(at(0.1f, 1.5f) == blue);
            CHECK(at(-0.1f, -1.5f) == white);
        };
        check("", {1, 0, 0}, {0, 1, 0});
        check("Rotate 90 0 0 1 ", {0, 1, 0}, {-1, 0, 0});
        check("ReverseOrientation Rotate 90 1 0 0 ", {1, 0, 0}, {0, 0, 1});
    }

    TEST_CASE("truth: codes of a .png are sRGB, linear, or a power, and a .pfm has none") {
        Image grey(1, 1);
        grey.pixels = {{0.5f, 0.5f, 0.5f}};
        Gallery gallery(grey);
        auto value = [&](const std::string& encoding, const std::string& file) {
            std::string texture = encoding.empty() ? "" : "\"string encoding\" \"" + encoding + '"';
            Scene scene = gallery.scene(square_with_uv, texture, file);
            return double{seen(scene, {0.5f, 0.5f, -1}, {0.5f, 0.5f, 0}).g};
        };
        double code = 188 / 255.0;
        CHECK(near(value("", "a.png"), std::pow((code + 0.055) / 1.055, 2.4)));
        CHECK(near(value("sRGB", "a.png"), std::pow((code + 0.055) / 1.055, 2.4)));
        CHECK(near(value("linear", "a.png"), code));
        CHECK(near(value("gamma 3", "a.png"), code * code * code));
        CHECK(near(value("gamma 3", "a.pfm"), 0.5));
    }

    TEST_CASE("truth: checkerboards, scaled and constant textures, and metal") {
        Gallery gallery;
        Scene scene = gallery.scene(
            "Texture \"half\" \"spectrum\" \"constant\" \"rgb value\" [.5 .5 0]\n"
            "Texture \"twice\" \"spectrum\" \"scale\" \"texture tex\" \"half\" \"float scale\" "
            "1.5\n"
            "Texture \"board\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"twice\"\n"
            "    \"rgb tex2\" [0 1 0] \"float uscale\" 4 \"float vscale\" 2\n"
            "Material \"diffuse\" \"texture reflectance\" \"board\" " +
            square_with_uv +
            "Translate 2 0 0 Material \"diffuse\" \"texture reflectance\" \"twice\" " +
            square_with_uv +
            "Translate 2 0 0 Material \"conductor\" \"texture reflectance\" \"board\" " +
            square_with_uv);
        auto at = [&](float x, float y) { return seen(scene, {x, y, -1}, {x, y, 0}); };
        const Rgb first = {0.75f, 0.75f, 0};
        CHECK(near(at(0.1f, 0.1f), first));
        CHECK(at(0.3f, 0.1f) == green);
        CHECK(near(at(0.3f, 0.6f), first));
        CHECK(at(0.9f, 0.1f) == green);
        CHECK(near(at(2.5f, 0.5f), first));
        CHECK(scene.materials[scene.shapes[1].material].texture == 0);  // one colour needs no uv
        std::optional<Hit> x = intersect(scene, {{4.1f, 0.1f, -1}, {0, 0, 1}});
        REQUIRE(x);
        Rgb F = fresnel_conductor(1, x->material->eta, x->material->k);
        CHECK(std::abs(F.r - 0.75f) < 1e-4f);
        CHECK(F.b == 0);
    }

    TEST_CASE("input: uv of a mesh in a PLY file, by all the names that they have") {
        Gallery gallery;
        for (auto [u, v] :
             {std::pair("u", "v"), std::pair("s", "t"), std::pair("texture_u", "texture_v"),
              std::pair("texture_s", "texture_t")}) {
            std::string header = "ply\nformat ascii 1.0\nelement vertex 3\n";
            for (const char* name : {"x", "y", "z", u, v}) {
                header += std::string("property float ") + name + '\n';
            }
            write_file_atomically(gallery.folder / "a.ply",
                                  header +
                                      "element face 1\nproperty list uchar int vertex_indices\n"
                                      "end_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
            Scene scene = gallery.scene("Shape \"plymesh\" \"string filename\" \"a.ply\"");
            CHECK(seen(scene, {0.2f, 0.7f, -1}, {0.2f, 0.7f, 0}) == red);
            CHECK(seen(scene, {0.7f, 0.2f, -1}, {0.7f, 0.2f, 0}) == white);
        }
    }

    TEST_CASE("input: a scene without textures keeps no uv; a picture is read once") {
        Scene none = parse_scene(
            "a.pbrt",
            "Camera \"perspective\" WorldBegin LightSource \"infinite\" " + square_with_uv,
            nullptr);
        CHECK(none.geometry.uvs.empty());
        Gallery gallery;
        Scene twice = gallery.scene(
            "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"./a.pfm\" " +
            square_with_uv);
        CHECK(twice.textures.all.size() == 2);
        CHECK(twice.textures.pictures.size() == 1);
        CHECK(twice.geometry.uvs.size() == 4);
    }

    TEST_CASE("input: pictures that cannot be used, and meshes without uv, are refused in a line") {
        Image image = four_corners();
        image.pixels[0].g = NAN;
        Gallery gallery(image);
        CHECK(gallery.error(square_with_uv, "", "b.png") ==
              "scene.pbrt:2:35: error: \"b.png\": cannot read: No such file or directory");
        CHECK(gallery.error(square_with_uv, "") ==
              "scene.pbrt:2:35: error: \"a.pfm\" has a pixel that is negative or not a number");
        CHECK(
            gallery.error("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]", "", "a.png") ==
            "scene.pbrt:4:1: error: Shape \"trianglemesh\" has no "
            "usable uv, which its texture needs; --stand-in renders it as the mean of the texture");
        Limits limits;
        limits.texels = 3;
        CHECK_THROWS_WITH(parse_scene(gallery.folder / "scene.pbrt",
                                      "Camera \"perspective\" WorldBegin Texture \"t\" "
                                      "\"spectrum\" \"imagemap\" \"string filename\" \"a.png\"",
                                      nullptr, {}, limits),
                          doctest::Contains("the textures have more than 3 pixels together"));
    }
}
