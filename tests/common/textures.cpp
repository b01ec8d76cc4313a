// Textures: their values, where they lie on each shape, and what the reader makes of them.
#include <doctest/doctest.h>

#include <sstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/geometry/shapes.h"
#include "common/material/hit.h"
#include "common/picture/image.h"
#include "common/scene/intersect.h"
#include "common/scene/sky_image.h"
#include "common/scene/texture.h"
#include "tests/support/described.h"
#include "tests/support/folder.h"
#include "tests/support/scenes.h"

namespace {

/// The green channel of the picture at (s, t), as its definition says: each texel, those beside the
/// picture too, weighs as much as a tent of two texels' width around its middle is high there.
double yardstick(const TexturePicture& picture, bool nearest, double s, double t) {
    double x = s * picture.width, y = (1 - t) * picture.height, sum = 0;
    auto weight = [&](double from_middle) {
        return nearest ? double(std::abs(from_middle) < 0.5)
                       : std::max(0.0, 1 - std::abs(from_middle));
    };
    auto inside = [](long i, long n) {
        while (i < 0) i += n;
        return i % n;
    };
    for (long j = std::lround(y) - 2; j <= std::lround(y) + 2; j++) {
        for (long i = std::lround(x) - 2; i <= std::lround(x) + 2; i++) {
            long column = inside(i, picture.width), row = inside(j, picture.height);
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

const std::string start = "Camera 'perspective' WorldBegin LightSource 'infinite'\n";

/// A scene in a folder of its own, with a picture beside it.
struct Gallery {
    TemporaryFolder folder;

    explicit Gallery(const Image& image = four_corners()) {
        write_image(folder / "a.pfm", image, "");
        write_image(folder / "a.png", image, "");
    }
    /// World directives behind the texture "t": the picture, with these parameters.
    Scene scene(const std::string& world, const std::string& texture = "'string filter' 'point'",
                const std::string& file = "a.pfm", const Limits& limits = {}) const {
        std::string text = start + "Texture 't' 'spectrum' 'imagemap' 'string filename' '" + file +
                           "' " + texture + "\nMaterial 'diffuse' 'texture reflectance' 't'\n" +
                           world;
        Scene scene = parse_scene(folder / "scene.pbrt", unquoted(text), nullptr, {}, limits);
        prepare(scene, 1);
        return scene;
    }
};

const std::string square_with_uv =
    "Shape 'trianglemesh' 'integer indices' [1 2 0 2 3 0] 'point2 uv' [0 0 1 0 1 1 0 1] "
    "'point3 P' [0 0 0  1 0 0  1 1 0  0 1 0] ";

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
            texture.nearest = random.u1() < 0.5f;
            texture.inverted = random.u1() < 0.5f;
            texture.value = {0.7f, 0.7f, 0.7f};
            Vec2 uv = {4 * random.u1() - 2, 4 * random.u1() - 2};
            texture.scale = {2 * random.u1() - 1, 2 * random.u1() - 1};
            texture.shift = {random.u1(), random.u1()};
            texture.picture = 1;
            textures.all.push_back(texture);
            textures.pictures = {{1, 1, {{9, 9, 9}}}, picture};
            double s = double{texture.scale.x} * double{uv.x} + double{texture.shift.x};
            double t = double{texture.scale.y} * double{uv.y} + double{texture.shift.y};
            auto near_an_edge = [](double x) { return std::abs(x - std::round(x)) < 1e-4; };
            if (texture.nearest &&
                (near_an_edge(s * picture.width) || near_an_edge((1 - t) * picture.height))) {
                continue;
            }
            double truth = double{0.7f} * yardstick(picture, texture.nearest, s, t);
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
                                    "'string filter' 'point' 'float uscale' 2 'float udelta' 0.5");
        check(moved, 0.1f, 0.75f, green), check(moved, 0.3f, 0.75f, red);
        Scene inverted = gallery.scene(
            square_with_uv, "'string filter' 'point' 'bool invert' true 'float scale' 0.5");
        check(inverted, 0.25f, 0.75f, {0.5f, 1, 1});
        CHECK(inverted.materials[inverted.shapes[0].material].reflectance == white);  // at most
        // The way of chapter 05.
        Ray ray = {{0.25f, 0.75f, -1}, {0, 0, 1}};
        Hit hit;
        make_hit(plain, ray, linear_scan(plain.geometry, ray), hit);
        CHECK(hit.material->reflectance == red);
        Scene patch = gallery.scene("Shape 'bilinearmesh' 'point3 P' [0 0 0 1 0 0 0 1 0 1 1 0]");
        check(patch, 0.25f, 0.75f, red), check(patch, 0.75f, 0.25f, white);
        check(patch, 0.25f, 0.25f, blue), check(patch, 0.75f, 0.75f, green);
        // A mirrored mesh, whose corners the reader exchanges, and one that turns while it moves.
        Scene mirrored = gallery.scene("Scale -1 1 1 ReverseOrientation " + square_with_uv);
        check(mirrored, -0.25f, 0.75f, red), check(mirrored, -0.75f, 0.25f, white);
        Scene moving = gallery.scene(
            "ActiveTransform EndTime Translate 2 0 0 ActiveTransform All " + square_with_uv);
        std::optional<Hit> x = intersect(moving, {{1.25f, 0.75f, -1}, {0, 0, 1}, infinity, 0.5f});
        REQUIRE(x);
        CHECK(x->material->reflectance == red);
    }

    TEST_CASE("truth: the picture on a sphere goes around z, on a disk around its middle") {
        // On a sphere from the lower pole to the upper, on a disk from the rim inwards.
        Gallery gallery;
        const Rgb colors[] = {red, green, blue, white};
        const Vec3 on_sphere[] = {
            {0.1f, 1, 0.5f}, {0.1f, -1, 0.5f}, {-0.1f, 1, -0.5f}, {-0.1f, -1, -0.5f}};
        const Vec3 on_disk[] = {
            {0.1f, 0.7f, 0}, {0.1f, -0.7f, 0}, {0.1f, 1.5f, 0}, {-0.1f, -1.5f, 0}};
        struct {
            const char *turn, *shape;
            Vec3 x, y, z;
        } cases[] = {
            {"", "sphere", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
            {"Rotate 90 0 1 0", "sphere", {0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
            {"Scale 1 -1 1", "sphere", {1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
            {"Scale 3 3 3", "sphere", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
            {"", "disk", {1, 0, 0}, {0, 1, 0}, {}},
            {"Rotate 90 0 0 1", "disk", {0, 1, 0}, {-1, 0, 0}, {}},
            {"ReverseOrientation Rotate 90 1 0 0", "disk", {1, 0, 0}, {0, 0, 1}, {}},
        };
        for (const auto& c : cases) {
            CAPTURE(c.turn);
            Scene scene = gallery.scene("Translate 1 2 3 " + std::string(c.turn) + " Shape '" +
                                        c.shape + "' 'float radius' 2");
            bool sphere = c.z != Vec3{};
            for (size_t i = 0; i < 4; i++) {
                Vec3 at = sphere ? on_sphere[i] : on_disk[i], centre = {1, 2, 3};
                Vec3 d = at.x * c.x + at.y * c.y + at.z * c.z;
                Vec3 from = sphere ? 20 * d : d + cross(c.x, c.y);
                CHECK(seen(scene, centre + from, sphere ? centre : centre + d) == colors[i]);
            }
        }
        // Rows of a picture: by the angle from the pole, or by the distance from the middle.
        Image rows(1, 8);
        for (int i = 0; i < 8; i++) rows.at(0, i).g = static_cast<float>(i) / 8;
        Gallery striped(rows);
        Scene ball = striped.scene("Shape 'sphere'"), disk = striped.scene("Shape 'disk'");
        for (int i = 0; i < 8; i++) {
            float part = (static_cast<float>(i) + 0.5f) / 8, sine = std::sin(part * pi);
            Vec3 d = {0.6f * sine, 0.8f * sine, std::cos(part * pi)};
            Vec3 on_it = {0.6f * part, 0.8f * part, 0};
            CHECK(near(seen(ball, 3 * d, {}), rows.at(0, i)));
            CHECK(near(seen(disk, on_it + Vec3{0, 0, 1}, on_it), rows.at(0, i)));
        }
    }

    TEST_CASE("input: pictures of the sky: their maps, axes and scale, and what they may not be") {
        TemporaryFolder folder;
        auto read = [&](int width, int height, Rgb L, const std::string& before) {
            Image image(width, height);
            for (Rgb& p : image.pixels) p = L;
            write_image(folder / "a.pfm", image, "");
            std::string text = "Camera 'perspective' 'float shutterclose' .5 WorldBegin " + before +
                               " LightSource 'infinite' 'string filename' 'a.pfm' 'float scale' 4 "
                               "Identity Shape 'sphere'";
            return *parse_scene(folder / "s.pbrt", unquoted(text), nullptr).sky_image;
        };
        const std::string shear = "ConcatTransform [1 0 0 0  0 1 0 0  ";
        for (int width : {2, 4}) {
            SkyImage sky = read(width, 2, {1, 2, 3}, "Rotate 90 0 0 1 Scale 2 3 -1");
            CHECK(sky.map == (width == 2 ? SkyImage::Map::square : SkyImage::Map::wide));
            CHECK(sky.width == width);
            CHECK(sky.height == 2);
            CHECK(sky.pixels == std::vector<Rgb>(static_cast<size_t>(2 * width), Rgb{2, 4, 6}));
            CHECK(length(sky.x - Vec3{0, 1, 0}) < 1e-6f);
            CHECK(length(sky.y - Vec3{-1, 0, 0}) < 1e-6f);
            CHECK(sky.z == Vec3{0, 0, -1});
        }
        const Rgb some = {1, 1, 1};
        struct {
            int width, height;
            Rgb L;
            std::string before;
            bool is_read;
        } cases[] = {
            {2, 2, {2e14f, 0, 0}, "", true},
            {2, 2, {6e14f, 0, 0}, "", false},
            {2, 2, {1, -1, 1}, "", false},
            {3, 2, some, "", false},
            {2, 4, some, "", false},
            {2, 2, some, shear + "9e-5 0 1 0  0 0 0 1]", true},
            {2, 2, some, shear + "11e-5 0 1 0  0 0 0 1]", false},
        };
        for (const auto& c : cases) {
            std::string said = error_of([&] { read(c.width, c.height, c.L, c.before); });
            CHECK(said.empty() == c.is_read);
        }
    }

    TEST_CASE("truth: codes of a .png are sRGB or linear, and a .pfm has none") {
        Image grey(1, 1);
        grey.pixels = {{0.5f, 0.5f, 0.5f}};
        Gallery gallery(grey);
        auto value = [&](const std::string& encoding, const std::string& file) {
            std::string texture = encoding.empty() ? "" : "'string encoding' '" + encoding + "'";
            Scene scene = gallery.scene(square_with_uv, texture, file);
            return double{seen(scene, {0.5f, 0.5f, -1}, {0.5f, 0.5f, 0}).g};
        };
        double code = 188 / 255.0;
        CHECK(near(value("", "a.png"), std::pow((code + 0.055) / 1.055, 2.4)));
        CHECK(near(value("linear", "a.png"), code));
        CHECK(near(value("linear", "a.pfm"), 0.5));
        CHECK(near(value("", "a.pfm"), 0.5));
        CHECK_THROWS_AS(value("srgb", "a.png"), InputError);
    }

    TEST_CASE("truth: checkerboards, constant textures, and metal") {
        Scene scene = Gallery().scene(
            "Texture 'twice' 'spectrum' 'constant' 'rgb value' [.75 .75 0]\n"
            "Texture 'board' 'spectrum' 'checkerboard' 'texture tex1' 'twice' "
            "'rgb tex2' [0 1 0] 'float uscale' 4 'float vscale' 2\n"
            "Material 'diffuse' 'texture reflectance' 'board' " +
            square_with_uv + "Translate 2 0 0 Material 'diffuse' 'texture reflectance' 'twice' " +
            square_with_uv + "Translate 2 0 0 Material 'conductor' 'texture reflectance' 'board' " +
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
}
