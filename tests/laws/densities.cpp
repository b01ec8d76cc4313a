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
#include "tests/support/directions.h"

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
            auto sample = [&](Sampler& random) {
                float u1 = random.u1();
                BsdfSample s = bsdf.sample(x, wo, u1, random.u2());
                if (s.pdf_w == 0) return Vec3{};
                REQUIRE(s.wi.z > 0);
                CHECK(s.pdf_w == nearly(double{bsdf.pdf(x, wo, s.wi)}, 1e-4));
                CHECK(s.f.g == nearly(double{bsdf.eval(x, wo, s.wi).g}, 1e-4));
                return s.wi;
            };
            auto density = [&](Vec3 wi) { return bsdf.pdf(x, wo, wi); };
            CHECK(chance_of_directions({}, sample, density) > 1e-6);
        });
    }

    TEST_CASE(
        "consistency: f and density are 0 below the surface, and f is the same both ways round") {
        Material matt, metal, mirror, glass;
        metal.type = mirror.type = MaterialType::conductor, glass.type = MaterialType::dielectric;
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
                        CHECK(bsdf.eval(x, wi, wo).g == nearly(bsdf.eval(x, wo, wi).g, 0.002));
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
                for (const Material* smooth : {&mirror, &glass}) {  // have samples alone
                    x.material = smooth;
                    CHECK(is_black(bsdf.eval(x, {-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f})));
                    CHECK(bsdf.pdf(x, {-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}) == 0);
                }
                CHECK(below > 50);
                CHECK(behind > 50);
                CHECK(gone > 50);
            }
    }
}
