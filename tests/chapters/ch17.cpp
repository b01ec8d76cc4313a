// Chapter 17: light from an image of the sky.
#include <doctest/doctest.h>

#include "chapters/17_sky_image/estimator.h"
#include "tests/support/estimators.h"

namespace {

Method by_seventeen(const Scene& scene) { return method_of<ch17::trace>(ch17::prepare(scene)); }
/// The same with pixels drawn in proportion to all of their light.
Method without_compensation(const Scene& scene) {
    return method_of<ch17::trace>(ch17::prepare(scene, 64, false));
}

const SkyImage::Map maps[] = {SkyImage::Map::square, SkyImage::Map::wide};

/// A grey picture of the sky: L(direction, column, row, rows).
using Radiance = std::function<float(Vec3, int, int, int)>;
SkyImage sky_of(SkyImage::Map map, int rows, const Radiance& L) {
    SkyImage sky;
    sky.map = map, sky.height = rows, sky.width = map == SkyImage::Map::square ? rows : 2 * rows;
    sky.x = {1, 0, 0}, sky.y = {0, 0, -1}, sky.z = {0, 1, 0};  // its top is +y
    for (int j = 0; j < sky.height; j++)
        for (int i = 0; i < sky.width; i++) {
            Vec3 d = direction_of(sky, sky.middle_of(sky.pixels.size()));
            sky.pixels.push_back(L(d, i, j, rows) * Rgb{1, 1, 1});
        }
    return sky;
}

/// The irradiance of an upward floor, by four points of each pixel.
double irradiance_of(const SkyImage& sky) {
    double E = 0, area = 1 / static_cast<double>(sky.pixels.size());
    for (size_t p = 0; p < sky.pixels.size(); p++)
        for (Vec2 u : {Vec2{0.25f, 0.25f}, {0.75f, 0.25f}, {0.25f, 0.75f}, {0.75f, 0.75f}}) {
            Vec2 uv = sky.point_in(p, u);
            float cosine = std::max(0.0f, direction_of(sky, uv).y);
            E +=
                double{sky.pixels[p].g} * double{cosine * solid_angle_per_area(sky, uv)} * area / 4;
        }
    return E;
}

}  // namespace

TEST_SUITE("ch17 sky image") {
    TEST_CASE("identity: each map of the sky and its inverse") {
        Sampler random = random_numbers(1);
        for (SkyImage::Map map : maps) {
            SkyImage sky = sky_of(map, 32, [](Vec3, int, int, int) { return 0; });
            sky.x = {0, 0, -1}, sky.y = {-1, 0, 0};
            for (int i = 0; i < 10000; i++) {
                Vec2 uv = random.u2();
                Vec3 w = direction_of(sky, uv);
                CHECK(std::abs(length(w) - 1) < 1e-6f);
                // Far from poles and seams the inverse is sharp.
                if (std::min({uv.x, uv.y, 1 - uv.x, 1 - uv.y}) > 0.01f)
                    CHECK(length(direction_of(sky, point_of(sky, w)) - w) < 3e-6f);
            }
        }
        // Where pbrt has them: the middle is +z, the right of it +x, below it +y, the corners -z.
        struct {
            SkyImage::Map map;
            Vec2 uv;
            Vec3 w;
        } cases[] = {{SkyImage::Map::square, {0.5f, 0.5f}, {0, 0, 1}},
                     {SkyImage::Map::square, {1, 0.5f}, {1, 0, 0}},
                     {SkyImage::Map::square, {0.5f, 1}, {0, 1, 0}},
                     {SkyImage::Map::square, {0, 0.5f}, {-1, 0, 0}},
                     {SkyImage::Map::square, {1, 1}, {0, 0, -1}},
                     {SkyImage::Map::wide, {0, 0.5f}, {1, 0, 0}},
                     {SkyImage::Map::wide, {0.25f, 0.5f}, {0, 1, 0}},
                     {SkyImage::Map::wide, {0.3f, 0}, {0, 0, 1}},
                     {SkyImage::Map::wide, {0.3f, 1}, {0, 0, -1}}};
        for (const auto& c : cases) {
            SkyImage sky;
            sky.map = c.map, sky.width = sky.height = 2;
            CHECK(length(direction_of(sky, c.uv) - c.w) < 1e-6f);
        }
    }

    TEST_CASE("truth: skies of known irradiance" * doctest::skip()) {
        // 997 rows and columns: many points of pixels lie at the edge of the next, if rounded,
        // which may be black. Of the last sky all are but one, which is as bright as can be.
        struct {
            std::string name;
            double gain;  // least, of variance, by compensation; 0: none
            double E;     // by a formula; 0: by a sum over pixels alone
            Radiance L;
        } skies[] = {
            {"one colour", 1e6, pi_exact, [](Vec3, int, int, int) { return 1.0f; }},
            {"above", 0, 2 * pi_exact / 3,
             [](Vec3 d, int, int, int) { return std::max(0.0f, d.y); }},
            {"aside", 0, pi_exact / 3,
             [](Vec3 d, int, int, int) { return 1 - std::max(0.0f, d.y); }},
            {"a sun of 1e-4 of the sphere", 1000, 0,
             [](Vec3, int i, int j, int n) {
                 return std::abs(i - n * 9 / 20) < n / 200 && std::abs(j - n * 2 / 5) < n / 200
                            ? 1e4f
                            : 1.0f;
             }},
            {"checks", 0.99, 0, [](Vec3, int i, int j, int) { return float((i + j) % 2); }},
            {"a black half", 0.99, 0,
             [](Vec3, int i, int, int n) { return i % n < n / 2 ? 1e-6f : 0.0f; }},
            {"a range", 0.99, 0,
             [](Vec3, int i, int j, int) {
                 return i % 2 ? std::pow(10.0f, float(j % 46 - 30)) : 0;
             }},
            {"one pixel", 0.99, 0,
             [](Vec3, int i, int j, int n) { return i == n / 4 && j == n / 3 ? 1e15f : 0; }}};
        Scene scene = floor_under("LightSource \"infinite\"");
        scene.lights.clear(), scene.sky = {}, scene.sky_light = -1;
        for (const auto& sky : skies)
            for (SkyImage::Map map : maps) {
                CAPTURE(sky.name);
                scene.sky_image = std::make_shared<SkyImage>(
                    sky_of(map, map == SkyImage::Map::square ? 997 : 499, sky.L));
                double E = irradiance_of(*scene.sky_image);
                if (sky.E > 0) CHECK(E == doctest::Approx(sky.E).epsilon(1e-4).scale(0));
                RunningStats s = irradiance(scene, by_seventeen(scene), 130000);
                check_bounded(s, E, sky.E > 0 ? 2e-3 : 0.01);
                RunningStats plain = irradiance(scene, without_compensation(scene), 100000);
                check_bounded(plain, E, 0.01);
                CHECK(s.variance() * sky.gain <= plain.variance());
            }
    }

    TEST_CASE("density: the image's density sums to 1, or is 0") {
        Sampler random = random_numbers(3);
        for (SkyImage::Map map : maps)
            for (int rows : {1, 2, 64})
                for (bool uniform : {false, true}) {
                    const SkyImage image = sky_of(map, rows, [&](Vec3 d, int, int, int) {
                        return d.y > 0.7f || uniform ? 0.1f : 1.0f;
                    });
                    std::vector<double> cdf = ch17::image_cdf(image, true);
                    auto pdf = [&](Vec3 wi) {
                        Vec2 uv = point_of(image, wi);
                        return ch17::pdf_image(image, cdf, image.pixel_at(uv), uv);
                    };
                    bool even = std::all_of(image.pixels.begin(), image.pixels.end(),
                                            [&](Rgb L) { return L == image.pixels[0]; });
                    CHECK((even ? cdf.back() == 0 : std::abs(cdf.back() - 1) < 1e-9));
                    RunningStats sum;
                    for (int i = 0; i < 200000; i++)
                        sum.add(4 * pi_exact * double{pdf(uniform_direction(random.u2()))});
                    if (even) CHECK(sum.mean() == 0);
                    if (!even) check_bounded(sum, 1, 0.01);
                    for (int i = 0; i < 27; i++) {  // poles, seams and edges
                        Vec3 d = {float(i % 3 - 1), float(i / 3 % 3 - 1), float(i / 9 - 1)};
                        if (i != 13) CHECK(pdf(normalize(d)) >= 0);
                    }
                }
    }

    TEST_CASE("identity: pixels are drawn for what they have above the mean") {
        // Four pixels of equal solid angle, of radiance 1, 5, 3 and 6: the mean is 3.75.
        const float L[] = {1, 5, 3, 6};
        auto four = [&](Vec3, int i, int j, int) { return L[2 * j + i]; };
        std::vector<double> cdf = ch17::image_cdf(sky_of(SkyImage::Map::square, 2, four), true);
        CHECK(cdf[1] == 0);
        CHECK(cdf[2] == doctest::Approx(1.25 / 3.5).epsilon(1e-5).scale(0));
        CHECK(cdf[3] == cdf[2]);
        CHECK(cdf[4] == doctest::Approx(1).epsilon(1e-9).scale(0));
        // Longitude and latitude: by solid angle, rows have the shares (1 - cos 45)/2 and sin 45/2
        // but for the rule of the middle. The mean over pixels would be another one: 7/4.
        SkyImage image = sky_of(SkyImage::Map::wide, 4, [](Vec3, int, int j, int) {
            return j == 0 ? 0 : std::exp2(static_cast<float>(j) - 1);
        });
        cdf = ch17::image_cdf(image, true);
        double outer = std::sin(pi_exact / 8), inner = std::sin(3 * pi_exact / 8);
        double mean = (3 * inner + 4 * outer) / (2 * inner + 2 * outer);
        double third = (2 - mean) * inner, last = (4 - mean) * outer;
        CHECK(cdf[16] == 0);
        CHECK(cdf[24] == doctest::Approx(third / (third + last)).epsilon(1e-5).scale(0));
    }
}
