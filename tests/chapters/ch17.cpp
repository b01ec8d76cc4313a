// Chapter 17: light from an image of the sky.
#include <doctest/doctest.h>

#include "chapters/16_lens_and_shutter/estimator.h"
#include "chapters/17_sky_image/estimator.h"
#include "tests/support/estimators.h"

namespace {

Method by_sixteen(const Scene& scene) { return method_of<ch16::trace>(ch16::prepare(scene)); }
Method by_seventeen(const Scene& scene) { return method_of<ch17::trace>(ch17::prepare(scene)); }
/// The same with pixels drawn in proportion to all of their light.
Method without_compensation(const Scene& scene) {
    return method_of<ch17::trace>(ch17::prepare(scene, 64, false));
}

/// A scene under a picture of the sky of these pixels.
Scene under_sky(SkyImage::Map map, int width, int height, const std::function<Rgb(Vec3)>& L,
                const std::string& world) {
    Scene scene = world_of(world + " LightSource \"infinite\" \"rgb L\" [1 1 1]");
    scene.lights.clear();
    scene.sky = {}, scene.sky_light = -1;
    SkyImage sky;
    sky.map = map, sky.width = width, sky.height = height;
    sky.x = {1, 0, 0}, sky.y = {0, 0, -1}, sky.z = {0, 1, 0};  // its top is +y
    for (size_t i = 0; i < static_cast<size_t>(width) * static_cast<size_t>(height); i++) {
        sky.pixels.push_back(L(direction_of(sky, sky.middle_of(i))));
    }
    scene.sky_image = sky;
    return scene;
}
const std::string white_floor =
    "Material \"diffuse\" \"rgb reflectance\" [1 1 1] Scale 500 1 500 " + square(0, true);

}  // namespace

TEST_SUITE("ch17 sky image") {
    TEST_CASE("identity: where nothing is new, each picture is chapter 16's, bit for bit") {
        for (std::string name :
             {"cornell-spheres", "thousand-lights", "bokeh", "moving-ball", "leaning wall"}) {
            CAPTURE(name);
            Scene scene = name == "leaning wall" ? leaning_wall()
                                                 : scene_from("scenes/" + name + ".pbrt", 16, 8);
            for (SamplerType sampler :
                 {SamplerType::independent, SamplerType::stratified, SamplerType::sobol}) {
                Rendering before = film_of(scene, by_sixteen(scene), 4, 1, sampler);
                Rendering now = film_of(scene, by_seventeen(scene), 4, 1, sampler);
                CHECK(before.film.image().pixels == now.film.image().pixels);
                CHECK(before.stats.rays == now.stats.rays);
            }
        }
    }
}

TEST_SUITE("ch17 sky image") {
    TEST_CASE("identity: each map of the sky and its inverse") {
        Sampler random = random_numbers(1);
        for (SkyImage::Map map : {SkyImage::Map::square, SkyImage::Map::wide}) {
            SkyImage sky;
            sky.map = map, sky.width = 64, sky.height = map == SkyImage::Map::square ? 64 : 32;
            sky.x = {0, 0, -1}, sky.y = {-1, 0, 0}, sky.z = {0, 1, 0};
            for (int i = 0; i < 10000; i++) {
                Vec2 uv = random.u2();
                Vec3 w = direction_of(sky, uv);
                CHECK(std::abs(length(w) - 1) < 1e-6f);
                Vec2 back = point_of(sky, w);
                // Far from poles and seams the inverse is sharp.
                if (std::min({uv.x, uv.y, 1 - uv.x, 1 - uv.y}) > 0.01f)
                    CHECK(length(direction_of(sky, back) - w) < 3e-6f);
                // Solid angle of a small square by its sides.
                float h = 1e-3f;
                if (uv.x + h >= 1 || uv.y + h >= 1) continue;
                Vec3 a = direction_of(sky, {uv.x + h, uv.y}) - w,
                     b = direction_of(sky, {uv.x, uv.y + h}) - w;
                float area = length(cross(a, b)) / (h * h);
                bool folds =
                    map == SkyImage::Map::square &&
                    (std::abs(uv.x - 0.5f) < 0.02f || std::abs(uv.y - 0.5f) < 0.02f ||
                     std::abs(std::abs(uv.x - 0.5f) + std::abs(uv.y - 0.5f) - 0.5f) < 0.02f);
                Vec2 mid = {uv.x + h / 2, uv.y + h / 2};
                float expected = solid_angle_per_area(sky, mid);
                if (!folds) CHECK(std::abs(area - expected) < 0.05f * expected + 0.05f);
            }
        }
        // Where pbrt has them: the middle is +z, the right of it +x, below it +y, the corners -z.
        SkyImage square;
        square.width = square.height = 2;
        auto is = [&](Vec2 uv, Vec3 w) { CHECK(length(direction_of(square, uv) - w) < 1e-6f); };
        is({0.5f, 0.5f}, {0, 0, 1});
        is({1, 0.5f}, {1, 0, 0});
        is({0.5f, 1}, {0, 1, 0});
        is({0, 0.5f}, {-1, 0, 0});
        is({1, 1}, {0, 0, -1});
        square.map = SkyImage::Map::wide;
        is({0, 0.5f}, {1, 0, 0});
        is({0.25f, 0.5f}, {0, 1, 0});
        is({0.3f, 0}, {0, 0, 1});
        is({0.3f, 1}, {0, 0, -1});
    }

    TEST_CASE("truth: skies of one colour, with a sun, with stars, checked, half black" *
              doctest::skip()) {
        // 997 rows and columns: many points of pixels lie at the edge of the next, if rounded,
        // which may be black. Of the last sky all are but one, which is as bright as can be.
        struct {
            const char* name;
            double gain;                            // least, of variance, by compensation
            std::function<float(int, int, int)> L;  // of column, row, rows
        } skies[] = {
            {"one colour", 1e6, [](int, int, int) { return 0.3f; }},
            {"a sun of 1e-4 of the sphere", 1000,
             [](int i, int j, int n) {
                 return std::abs(i - n * 9 / 20) < n / 200 && std::abs(j - n * 2 / 5) < n / 200
                            ? 1e4f
                            : 1.0f;
             }},
            {"checks", 0.99, [](int i, int j, int) { return float((i + j) % 2); }},
            {"stars", 0.99,
             [](int i, int j, int) { return float(i * 7919 % 101 + j * 104729 % 103 < 9); }},
            {"a black half", 0.99, [](int i, int, int n) { return i % n < n / 2 ? 1e-6f : 0.0f; }},
            {"a range", 0.99,
             [](int i, int j, int) { return i % 2 ? std::pow(10.0f, float(j % 46 - 30)) : 0; }},
            {"one pixel", 0.99,
             [](int i, int j, int n) { return i == n / 4 && j == n / 3 ? 1e15f : 0; }}};
        for (const auto& sky : skies)
            for (SkyImage::Map map : {SkyImage::Map::square, SkyImage::Map::wide}) {
                int h = map == SkyImage::Map::square ? 997 : 499,
                    w = map == SkyImage::Map::square ? h : 2 * h;
                Scene scene = under_sky(
                    map, w, h, [](Vec3) { return Rgb{}; }, white_floor);
                SkyImage& image = *scene.sky_image;
                double E = 0, area = 1.0 / w / h;
                for (size_t p = 0; p < image.pixels.size(); p++) {
                    float L = sky.L(static_cast<int>(p) % w, static_cast<int>(p) / w, h);
                    image.pixels[p] = {L, L, L};
                    for (int k = 0; k < 4 && L > 0; k++) {
                        Vec2 uv = image.point_in(
                            p, {0.25f + 0.5f * float(k % 2), 0.25f + 0.5f * float(k / 2)});
                        float cosine = std::max(0.0f, direction_of(image, uv).y);
                        E +=
                            double{L} * double{cosine * solid_angle_per_area(image, uv)} * area / 4;
                    }
                }
                scene.max_depth = 1;
                RunningStats s = irradiance(scene, by_seventeen(scene), 200000);
                check_bounded(s, E, 0.01);
                RunningStats plain = irradiance(scene, without_compensation(scene), 200000);
                check_bounded(plain, E, 0.01);
                CHECK(s.variance() * sky.gain <= plain.variance());
            }
    }

    TEST_CASE("density: the image's density sums to 1, or is 0") {
        Sampler random = random_numbers(3);
        for (SkyImage::Map map : {SkyImage::Map::square, SkyImage::Map::wide})
            for (int h : {1, 2, 64})
                for (bool uniform : {false, true}) {
                    int w = map == SkyImage::Map::square ? h : 2 * h;
                    Scene scene = under_sky(
                        map, w, h,
                        [&](Vec3 d) {
                            return Rgb{d.y > 0.7f || uniform ? 0.1f : 1.0f, 0, 2};
                        },
                        white_floor);
                    const SkyImage& image = *scene.sky_image;
                    std::vector<double> cdf = ch17::image_cdf(image, true);
                    auto pdf = [&](Vec3 wi) {
                        Vec2 uv = point_of(image, wi);
                        return ch17::pdf_image(image, cdf, image.pixel_at(uv), uv);
                    };
                    bool even = std::all_of(image.pixels.begin(), image.pixels.end(),
                                            [&](Rgb L) { return L == image.pixels[0]; });
                    CHECK(cdf.back() == (even ? 0 : 1));
                    RunningStats sum;
                    for (int i = 0; i < 200000; i++) {
                        float density = pdf(uniform_direction(random.u2()));
                        sum.add(4 * pi_exact * double{density});
                        if (cdf.back() == 0) CHECK(density == 0);
                    }
                    if (cdf.back() == 1) check_bounded(sum, 1, 0.01);
                    for (float x : {-1.0f, 0.0f, 1.0f})
                        for (float y : {-1.0f, 0.0f, 1.0f})
                            for (float z : {-1.0f, 0.0f, 1.0f})
                                if (x != 0 || y != 0 || z != 0)
                                    CHECK(pdf(normalize(Vec3{x, y, z})) >= 0);
                }
    }

    TEST_CASE("identity: pixels are drawn for what they have above the mean") {
        // Four pixels of equal solid angle, of radiance 1, 2, 3 and 6: the mean is 3.
        SkyImage image;
        image.width = image.height = 2;
        for (float L : {1.0f, 2.0f, 3.0f, 6.0f}) image.pixels.push_back({L, L, L});
        CHECK(ch17::image_cdf(image, true) == std::vector<double>{0, 0, 0, 0, 1});
        image.pixels[1] = {5, 5, 5};  // the mean is 3.75
        std::vector<double> cdf = ch17::image_cdf(image, true);
        CHECK(cdf[2] == doctest::Approx(1.25 / 3.5).epsilon(1e-5).scale(0));
        CHECK(cdf[3] == cdf[2]);
        // Longitude and latitude: by solid angle, rows have the shares (1 - cos 45)/2 and sin 45/2
        // but for the rule of the middle. The mean lies between.
        image = {};
        image.map = SkyImage::Map::wide, image.width = 1, image.height = 4;
        for (float L : {0.0f, 0.0f, 1.0f, 1.0f}) image.pixels.push_back({L, L, L});
        cdf = ch17::image_cdf(image, true);
        double outer = std::sin(pi_exact / 8), inner = std::sin(3 * pi_exact / 8);
        CHECK(cdf[2] == 0);
        CHECK(cdf[3] == doctest::Approx(inner / (inner + outer)).epsilon(1e-6).scale(0));
        // Here the mean over pixels would be another one: 7/4.
        for (size_t i = 1; i < 4; i++)
            image.pixels[i] = Rgb{1, 1, 1} * std::exp2(static_cast<float>(i) - 1);
        cdf = ch17::image_cdf(image, true);
        double mean = (3 * inner + 4 * outer) / (2 * inner + 2 * outer);
        double third = (2 - mean) * inner, last = (4 - mean) * outer;
        CHECK(cdf[2] == 0);
        CHECK(cdf[3] == doctest::Approx(third / (third + last)).epsilon(1e-5).scale(0));
    }

    TEST_CASE("truth: skies of known irradiance" * doctest::skip()) {
        struct {
            std::function<float(float)> L;
            double E;
        } skies[] = {{[](float) { return 1.0f; }, pi_exact},
                     {[](float c) { return c; }, 2.094395102393},
                     {[](float c) { return 1 - c; }, 1.047197551197},
                     {[](float c) { return (1 + c) / 2; }, 2.617993877991},
                     {[](float c) { return (1 + 2 * c) / 3; }, 2.443460952792}};
        for (const auto& sky : skies)
            for (SkyImage::Map map : {SkyImage::Map::square, SkyImage::Map::wide}) {
                int w = 256, h = map == SkyImage::Map::square ? 256 : 128;
                Scene scene = under_sky(
                    map, w, h,
                    [&](Vec3 d) {
                        float L = d.y > 0 ? sky.L(d.y) : 0;
                        return Rgb{L, L, L};
                    },
                    white_floor);
                scene.max_depth = 1;
                RunningStats s = irradiance(scene, by_seventeen(scene), 200000);
                // The pixels' own error is below 1e-4.
                CHECK(std::abs(s.mean() - sky.E) < 5 * s.standard_error() + 1e-3 * sky.E);
                CHECK(s.standard_error() < 2e-3 * sky.E);
            }
    }

    TEST_CASE("variance: a small sun: a fiftieth of what chance would have, and less") {
        // 1 of 128 x 128 pixels has half of the light.
        Scene scene = under_sky(
            SkyImage::Map::square, 128, 128,
            [](Vec3) {
                return Rgb{1, 1, 1};
            },
            white_floor);
        scene.max_depth = 1;
        SkyImage& sky = *scene.sky_image;
        size_t sun = sky.pixel_at(point_of(sky, normalize(Vec3{0.3f, 0.8f, 0.2f})));
        sky.pixels[sun] = {128 * 128, 128 * 128, 128 * 128};
        RunningStats aimed = irradiance(scene, by_seventeen(scene), 100000);
        // By the cosine alone: E = pi L, one sample each.
        RunningStats chance;
        Sampler random = random_numbers(9);
        for (int i = 0; i < 4000000; i++) {
            Vec3 w = sample_cosine_hemisphere(random.u2());
            chance.add(pi_exact * double{sky.at(point_of(sky, {w.x, w.z, w.y})).r});
        }
        CHECK(z_between({aimed.mean(), aimed.standard_error()},
                        {chance.mean(), chance.standard_error()}) < 5);
        CHECK(aimed.variance() < chance.variance() / 50);
    }

    TEST_CASE("agreement: classes of paths under a sky, with the sky found by chance") {
        // Chance alone: the same trace without light sampling, by a sky that is not told.
        Scene scene = under_sky(
            SkyImage::Map::wide, 16, 8,
            [](Vec3 d) {
                float L = 1 + d.x + (d.y > 0.8f ? 5.0f : 0.0f);
                return Rgb{L, L, L};
            },
            "AttributeBegin " + white_floor +
                " AttributeEnd Translate 0 1 0 Material \"conductor\" "
                "\"float roughness\" 0.3 Shape \"sphere\"");
        scene.max_depth = 4;
        auto by_chance = [](const Scene& s, Ray ray, Sampler& sampler, Recorder& recorder) {
            Rgb beta = {1, 1, 1};
            for (int depth = 0;; depth++) {
                std::optional<Hit> x = intersect(s, ray);
                if (!x) {
                    Rgb Le = s.sky_image->at(point_of(*s.sky_image, ray.d));
                    recorder.emitted(Le);
                    return beta * Le;
                }
                recorder.vertex(*x);
                if (depth == s.max_depth) return Rgb{};
                Vec2 u = sampler.u2();
                BsdfSample b = glossy_bsdf::sample_bsdf(*x, -ray.d, sampler.u1(), u);
                if (b.pdf_w == 0) return Rgb{};
                beta *= b.f * (std::abs(dot(b.wi, x->n)) / b.pdf_w);
                recorder.scatter(b.wi, b.f, b.pdf_w, b.specular, beta);
                ray = spawn_ray(*x, b.wi);
            }
        };
        CHECK(check_classes(scene, Method(by_chance), scene, by_seventeen(scene), 100000) >= 6);
    }
}
