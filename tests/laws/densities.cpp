// Law: every sample_bsdf draws from its pdf_bsdf, and tells the same f as its eval_bsdf.
#include <doctest/doctest.h>

#include "chapters/07_path_tracing/estimator.h"
#include "chapters/08_russian_roulette/estimator.h"
#include "chapters/09_light_sampling/estimator.h"
#include "chapters/10_cosine_sampling/estimator.h"
#include "chapters/11_light_importance/estimator.h"
#include "chapters/13_glossy/estimator.h"
#include "chapters/14_mis/estimator.h"
// After the chapters, whose names must not be found in it.
#include "tests/support/gates.h"
#include "tests/support/scenes.h"

namespace {

/// One chapter's functions of a surface.
struct Bsdf {
    std::string name;
    Rgb (*eval)(const Hit&, Vec3, Vec3);
    float (*pdf)(const Hit&, Vec3, Vec3);
    std::function<BsdfSample(const Hit&, Vec3, float, Vec2)> sample;
};
const Bsdf every_bsdf[] = {
    {"07", ch07::eval_bsdf, ch07::pdf_bsdf,
     [](const Hit& x, Vec3 wo, float u1, Vec2 u2) {
         auto [wi, f, pdf_w, specular] = ch07::sample_bsdf(x, wo, u1, u2);
         return BsdfSample{wi, f, pdf_w, specular};
     }},
    {"08", ch08::eval_bsdf, ch08::pdf_bsdf, ch08::sample_bsdf},
    {"09", ch09::eval_bsdf, ch09::pdf_bsdf, ch09::sample_bsdf},
    {"10", ch10::eval_bsdf, ch10::pdf_bsdf, ch10::sample_bsdf},
    {"11 and 12", basic_bsdf::eval_bsdf, basic_bsdf::pdf_bsdf, basic_bsdf::sample_bsdf},
    {"13", ch13::eval_bsdf, ch13::pdf_bsdf, ch13::sample_bsdf},
    {"14 and 15", glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf}};

/// Calls test(bsdf, x, wo) for each chapter's functions, paint and rough metal, straight and bent
/// normals.
template <class Test>
void for_each_bsdf(const Test& test) {
    Material matt, metal;
    metal.type = MaterialType::conductor;
    metal.eta = {0.2f, 0.2f, 0.2f}, metal.k = {3.9f, 3.9f, 3.9f}, metal.alpha = 0.5f;
    for (const Bsdf& bsdf : every_bsdf)
        for (const Material* material : {&matt, &metal})
            for (float lean : {0.0f, 0.5f}) {
                if (material == &metal && bsdf.name < "13") continue;
                CAPTURE(bsdf.name);
                CAPTURE(lean);
                Hit x{};
                x.material = material;
                x.ng = {0, 0, 1}, x.n = normalize({lean, 0.1f * lean, 1});
                for (Vec3 wo : {Vec3{0, 0, 1}, normalize({-0.8f, 0.3f, 0.5f})}) test(bsdf, x, wo);
            }
}

}  // namespace

TEST_SUITE("law: densities") {
    TEST_CASE("density: directions of every chapter's sample_bsdf, and f and pdf_w with them") {
        for_each_bsdf([](const Bsdf& bsdf, const Hit& x, Vec3 wo) {
            constexpr int rows = 10, columns = 8, fine = 24, n = 20000;
            auto direction = [](double u, double v) {
                float z = static_cast<float>(v), phi = static_cast<float>(2 * std::numbers::pi * u);
                float r = std::sqrt(std::max(0.0f, 1 - z * z));
                return Vec3{r * std::cos(phi), r * std::sin(phi), z};
            };
            // The last cell: no sample.
            std::vector<double> count(rows * columns + 1), expected(rows * columns + 1);
            for (size_t c = 0; c < rows * columns; c++)
                for (int k = 0; k < fine * fine; k++) {
                    double u =
                        (static_cast<double>(c % columns) + (k % fine + 0.5) / fine) / columns;
                    double v = (static_cast<double>(c / columns) + (k / fine + 0.5) / fine) / rows;
                    expected[c] += double{bsdf.pdf(x, wo, direction(u, v))} * 2 * std::numbers::pi /
                                   (rows * columns * fine * fine);
                }
            double missing = 1;
            for (double share : expected) missing -= share;
            expected.back() = std::max(0.0, missing);
            CHECK(missing > -1e-3);
            Sampler random = random_numbers(1);
            for (int i = 0; i < n; i++) {
                float u1 = random.u1();
                BsdfSample s = bsdf.sample(x, wo, u1, random.u2());
                double u = std::atan2(double{s.wi.y}, double{s.wi.x}) / (2 * std::numbers::pi) + 1;
                int column = static_cast<int>((u - std::floor(u)) * columns);
                int row = static_cast<int>(double{s.wi.z} * rows);
                if (s.pdf_w == 0) {
                    count.back()++;
                    continue;
                }
                REQUIRE(s.wi.z > 0);
                count[static_cast<size_t>(std::min(row, rows - 1) * columns +
                                          std::min(column, columns - 1))]++;
                CHECK(s.pdf_w == doctest::Approx(bsdf.pdf(x, wo, s.wi)).epsilon(1e-4).scale(0));
                CHECK(s.f.g == doctest::Approx(bsdf.eval(x, wo, s.wi).g).epsilon(1e-4).scale(0));
            }
            // Cells that few samples reach count together; those at the edge of what is possible
            // are not known well enough by so few points of the density.
            double chi2 = 0, rest = 0, rest_expected = 0;
            int cells = 0;
            for (size_t c = 0; c < count.size(); c++) {
                double e = n * expected[c];
                if (e < 20) {
                    rest += count[c], rest_expected += e;
                    continue;
                }
                chi2 += (count[c] - e) * (count[c] - e) / e, cells++;
            }
            CHECK(std::abs(rest - rest_expected) < 5 * std::sqrt(rest_expected) + 10);
            CHECK(chi_square_tail(chi2, cells - 1) > 1e-6);
            CHECK(cells > 10);
        });
    }

    TEST_CASE(
        "consistency: f and density are 0 below the surface, and f is the same both ways round") {
        Material matt, metal;
        metal.type = MaterialType::conductor;
        metal.eta = {0.2f, 0.2f, 0.2f}, metal.k = {3.9f, 3.9f, 3.9f}, metal.alpha = 0.5f;
        Sampler random = random_numbers(1);
        for (const Bsdf& bsdf : every_bsdf)
            for (const Material* material : {&matt, &metal}) {
                if (material == &metal && bsdf.name < "13") continue;
                CAPTURE(bsdf.name);
                int below = 0, behind = 0, gone = 0;
                for (int i = 0; i < 3000; i++) {
                    Hit x{};
                    x.material = material;
                    x.ng = uniform_direction(random.u2());
                    x.n = normalize(x.ng + 0.9f * uniform_direction(random.u2()));
                    Vec3 wo = uniform_direction(random.u2()), wi = uniform_direction(random.u2());
                    if (dot(wo, x.n) < 0.01f || dot(wo, x.ng) < 0.01f) continue;
                    bool above = dot(wi, x.ng) > 0, facing = dot(wi, x.n) > 0;
                    below += !above && facing, behind += above && !facing;
                    CHECK(is_black(bsdf.eval(x, wo, wi)) == !(above && facing));
                    CHECK((bsdf.pdf(x, wo, wi) == 0) == !(above && facing));
                    if (above && facing)
                        CHECK(bsdf.eval(x, wi, wo).g ==
                              doctest::Approx(bsdf.eval(x, wo, wi).g).epsilon(0.002).scale(0));
                    float u1 = random.u1();
                    BsdfSample s = bsdf.sample(x, wo, u1, random.u2());
                    gone += s.pdf_w == 0;
                    if (s.pdf_w == 0) continue;
                    CHECK((dot(s.wi, x.n) > 0 && dot(s.wi, x.ng) > 0));
                    float most = bsdf.name < "10" ? 2 : 1;  // 07 to 09: uniform
                    CHECK(s.f.g * dot(s.wi, x.n) <= most * s.pdf_w * 1.0001f);
                }
                // As when two ends of a path meet on the same plane: 0, and not NaN.
                Hit x{};
                x.material = material, x.n = x.ng = {0, 0, 1};
                for (Vec3 wo : {Vec3{1, 0, 0}, Vec3{1, 0, -0.0f}, Vec3{0.6f, 0, -0.8f}}) {
                    if (material == &matt) continue;
                    CHECK(is_black(bsdf.eval(x, wo, {0, 0, 1})));
                    CHECK(bsdf.pdf(x, wo, {0, 0, 1}) == 0);
                    CHECK(bsdf.sample(x, wo, 0.5f, {0.3f, 0.7f}).pdf_w == 0);
                }
                CHECK(below > 50);
                CHECK(behind > 50);
                CHECK(gone > 50);
            }
    }
}
